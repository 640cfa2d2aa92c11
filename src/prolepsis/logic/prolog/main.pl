/*  What the Prolog process loads: the modules of this folder, and the server that Python talks to. */

:- set_prolog_flag(verbose_load, silent).
:- style_check(-singleton).
:- use_module(library(mqi)).
:- style_check(+singleton).
:- use_module(runs).
:- use_module(answers).
