/*  What the Prolog process loads: the modules of this folder, and the server that Python talks to.

    Python holds the other end of its standard input, and writes nothing: when that end closes, Python is gone.
*/

:- ( current_prolog_flag(version, Version), Version >= 90004
   ->  true
   ;   format(user_error, "version 9.0.4 or newer is needed~n", []),
       halt(1)
   ).
:- set_prolog_flag(verbose_load, silent).
% What libraries need is loaded now, not by the first thread that meets it: two at once get in each other's way.
:- set_prolog_flag(autoload, false).
:- style_check(-singleton).
:- use_module(library(mqi)).
:- style_check(+singleton).
:- use_module(runs).
:- use_module(answers).
:- use_module(rules).
:- set_prolog_flag(autoload, true).

%!  serve is det.
%
%   Answer Python on a socket, and end when Python does.

serve :-
    thread_create(end_with_python, _, [detached(true)]),
    mqi_start.

end_with_python :-
    catch(peek_char(user_input, _), error(_, _), true),
    halt(1).
