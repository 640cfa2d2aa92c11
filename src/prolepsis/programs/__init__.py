"""Control programs: plans read from terms, actions, and what they say to the robot."""

from prolepsis.programs.action import ACTIONS, ActionSpec
from prolepsis.programs.program import Program
from prolepsis.programs.reading import COMBINATORS, check_units, read_program

__all__ = ["ACTIONS", "COMBINATORS", "ActionSpec", "Program", "check_units", "read_program"]
