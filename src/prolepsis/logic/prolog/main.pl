/*  What the Prolog process loads: the modules of this folder, and the server that Python talks to. */

:- use_module(library(mqi)).
:- use_module(runs).
:- use_module(answers).
