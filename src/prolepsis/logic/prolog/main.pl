/*  What the Prolog process loads: the modules of this folder, and the server that Python talks to. */

:- set_prolog_flag(verbose_load, silent).
% What libraries need is loaded now, not by the first thread that meets it: two at once get in each other's way.
:- set_prolog_flag(autoload, false).
:- style_check(-singleton).
:- use_module(library(mqi)).
:- style_check(+singleton).
:- use_module(runs).
:- use_module(answers).
:- set_prolog_flag(autoload, true).
