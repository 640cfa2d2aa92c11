"""Terms are printed as SWI-Prolog's own writeq prints them, and answers come back as they were sent."""

from __future__ import annotations

import re

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from prolepsis.log.timeline import make_timeline
from prolepsis.logic.session import Session
from prolepsis.terms.reader import parse_term
from prolepsis.terms.terms import Term, Value, format_value

EMPTY = make_timeline([], dt=0.001, duration=1.0)
SESSION = Session()

TRICKY = r"""
a | 'A' | 'hello world' | 'don\'t' | '' | [] | '[]' | {} | '{}'(x) | {a,b} | ! | ; | (;) | ',' | '|'
'\\' | '\n' | '\r\t' | '\x7F\' | é | 'É' | ß | 日本 | 'a²' | 'Ⅷ' | 'a b'(c) | f(A,_B,A) | - | (-)
-(1) | - 1 | -1 | -(-(1)) | - a | -(-(a)) | 1 - -1 | 1-(-1) | a- -b | a-(-1) | -(2)^2 | (-2)^2
-a^2 | (-a)^2 | 2^3^4 | (2^3)^4 | 2**3 | 1-2-3 | 1-(2-3) | (1-2)-3 | a=b | (a=b)=c | a:b:c | (a:b):c
(a,b) | (a,b,c) | ((a,b),c) | f((a,b)) | f((a:-b)) | [(a:-b)] | [a|b] | [a,b|T] | [(a,b)] | [a=b,c]
[-] | [-|-] | f(-) | f(-,+) | f(:-) | f(;) | - - a | \+a | \+ (a,b) | \+ (\+a) | \+[a] | \+ (-) | \a
\ \a | (a:-b,c;d->e) | (a->b;c) | (a-->b) | :-a | ?-a | (dynamic a) | f((dynamic a)) | 1 rdiv 2
a mod b | mod(a) | (mod) | mod | f(mod) | [a] mod [b] | 'A' mod 'B' | f(a) mod f(b) | -1 mod -1
+ mod a | is | X is 1+2 | a is b | (is)=(is) | = = = | (=)=(=) | \+a=b | (\+a)=b | - (1) | -(1.5)
-(a)+b | -(-1) | 1*(2+3) | 1*2+3 | (1+2)*3 | 1/(2/3) | a//b | a<<b>>c | a@<b | a=..b | a\==b
a\=@=b | a>:<b | a:=b | $a | $ | f($) | *(a) | * | +(+) | +(1) | 1000000000000000.0 | 1000000000000000.5
999999999999999.9 | -1234567890123456.0 | 1.0 | 1.0e10 | 1e22 | 1.0e-7 | 123456789.123 | 1.0Inf
0.1 | 100000000000000.0 | 1.0e100 | 12345678901234567890 | a:(b:-c) | (a:-b):c | {-} | {(a:-b)}
'$VAR'(x) | f(a;b) | (a;b;c) | ((a;b);c) | (a|b) | [a|[b|c]] | [[]] | [[a],[]] | 'hello'('X') | +'X'
-'A' | - 'a b' | 'a b'- 'c d' | table a | f(table) | a rem b | a xor b | 1 xor 2 | p:-(a,b) | -(3)*2
(-3)*2 | 2*(-3) | 2* -3 | 2-3 | 2 - (-3) | -(-) | \ (-) | (a,b)=c | f(A:-B) | f([]) | [] = '[]'
-[] | -{} | -(a,b) | - (a) | -(f(x)) | -f(x) | \+f(x) | f(- 1) | f(-(1)) | 1 = :- | (:-) = 1 | [:-]
[:-|:-] | [a|(:-)] | a rdiv b | -(1)^2 | 1^(-1)
"""
TEXTS = [text.strip() for line in TRICKY.strip().splitlines() for text in line.split(" | ") if text.strip()]


def writeq(text: str) -> str | None:
    """Return what writeq prints for the term in ``text``, or None if Prolog does not read it."""
    written = f"term_to_atom(T, {format_value(text)}), format(string(R), '~q', [T])"
    goal = f'findall(R, catch(({written}), _, R = "?"), [Reply])'
    SESSION.load(EMPTY)
    process = SESSION._process  # pyright: ignore[reportPrivateUsage]
    assert process is not None
    reply = process.call(goal, 10.0)
    return None if reply == "?" else reply


# Variables get numbers from Prolog.
@pytest.mark.parametrize("text", [text for text in TEXTS if not re.search(r"\b[A-Z_]\w*\b(?!')", text)])
def test_a_term_is_read_and_printed_as_prolog_does(text: str) -> None:
    written = writeq(text)
    assert written is not None, "Prolog does not read it"
    assert format_value(parse_term(text)) == written
    assert format_value(parse_term(written)) == written


NAMES = st.sampled_from(["a", "B c", "-", "+", "mod", "is", ":-", ",", "\\+", "é", "[]"]) | st.text(
    st.characters(codec="utf-8", exclude_characters="\0"), max_size=4
)
VALUES: st.SearchStrategy[Value] = st.recursive(
    NAMES | st.integers() | st.floats(allow_nan=False),
    lambda inner: (
        st.lists(inner, max_size=3).map(tuple)
        | st.builds(Term, NAMES.filter(lambda n: n != "[]"), st.lists(inner, min_size=1, max_size=3).map(tuple))
    ),
    max_leaves=8,
)


@pytest.mark.filterwarnings("ignore:.* is not computed")
@settings(deadline=None, max_examples=100)
@given(st.lists(VALUES, min_size=1, max_size=10))
@example([":÷"])
def test_answers_come_back_as_they_were_sent(values: list[Value]) -> None:
    goal = ", ".join(f"X{number} = ({format_value(value)})" for number, value in enumerate(values))
    assert [*SESSION.ask(EMPTY, goal)[0].values()] == values
