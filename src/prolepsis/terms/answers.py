"""What an answer holds: terms that are at the same time what ``json.dumps`` writes of them.

``json.dumps`` takes texts and tables and what is made of them, and asks nothing of anything else. So an interval of an
answer is a table of its start and end, any other term the text that Prolog writes, and both are terms as any other.
"""

from __future__ import annotations

from typing import cast

from prolepsis.terms.terms import Term, Value, Variable, format_value


class AnswerTerm(Term, str):
    """A term that is also its text, ``broken(egg1)``."""

    def __new__(cls, functor: str, args: tuple[Value, ...]) -> AnswerTerm:
        """Return it with its text."""
        return str.__new__(cls, format_value(Term(functor, args)))

    def __repr__(self) -> str:
        """Return it as a term."""
        return repr(Term(self.functor, self.args))

    def __eq__(self, other: object) -> bool:
        """Return whether the other is the same term; a text is none."""
        return isinstance(other, Term) and (self.functor, self.args) == (other.functor, other.args)

    def __ne__(self, other: object) -> bool:
        """Return whether it is another."""
        return not self == other

    __hash__ = Term.__hash__

    def __reduce__(self) -> tuple[object, ...]:
        """Return how it is made again."""
        return type(self), (self.functor, self.args)


class AnswerInterval(Term, dict[str, float]):
    """An interval that is also ``{"start": 0.5, "end": 2.0}`` [s]."""

    def __init__(self, functor: str, args: tuple[Value, ...]) -> None:
        """Make it of ``-`` and two numbers."""
        Term.__init__(self, functor, args)
        self["start"], self["end"] = cast("tuple[float, float]", args)

    __repr__ = AnswerTerm.__repr__
    __eq__ = AnswerTerm.__eq__
    __ne__ = AnswerTerm.__ne__
    __hash__ = Term.__hash__
    __reduce__ = AnswerTerm.__reduce__


class AnswerVariable(Variable, str):
    """A variable that nothing has bound, which is also its name."""

    def __new__(cls, name: str) -> AnswerVariable:
        """Return it with its name."""
        return str.__new__(cls, name)

    def __repr__(self) -> str:
        """Return it as a variable."""
        return repr(Variable(self.name))

    def __eq__(self, other: object) -> bool:
        """Return whether the other is a variable of that name."""
        return isinstance(other, Variable) and self.name == other.name

    __ne__ = AnswerTerm.__ne__
    __hash__ = Variable.__hash__

    def __reduce__(self) -> tuple[object, ...]:
        """Return how it is made again."""
        return type(self), (self.name,)


def is_interval(value: Value) -> bool:
    """Return whether a value is an interval of numbers, ``0.5-2.0``."""
    return (
        isinstance(value, Term)
        and value.functor == "-"
        and len(value.args) == 2
        and all(isinstance(each, int | float) for each in value.args)
    )


def as_answer(value: Value) -> Value:
    """Return a value as answers hold it."""
    match value:
        case Variable(name=name):
            return AnswerVariable(name)
        case Term(functor=functor, args=args):
            made = AnswerInterval if is_interval(value) else AnswerTerm
            return made(functor, tuple(map(as_answer, args)))
        case tuple():
            return tuple(map(as_answer, value))
        case _:
            return value
