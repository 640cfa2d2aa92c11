/*  The module in which goals run: it has what they may use, and nothing of its own. */

:- module(query, []).
:- use_module(library(lists)).
:- use_module(library(apply)).
:- use_module(library(aggregate)).
:- use_module(library(pairs)).
:- use_module(library(ordsets)).
:- use_module(library(solution_sequences)).
:- use_module(library(yall)).
:- use_module(asking).
:- use_module(timeline, [in/2]).
:- use_module(allen).
