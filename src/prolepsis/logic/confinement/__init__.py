"""The wall around Prolog that does not depend on the guard: the process reaches no file, program or network.

The system offers it without privileges: Landlock (files, network, signals) or bubblewrap, and a filter of system
calls. A small launcher puts the walls up around itself and then becomes SWI-Prolog.
"""

from prolepsis.logic.confinement.offer import CURE, Walls, offered
from prolepsis.logic.confinement.start import command

__all__ = ["CURE", "Walls", "command", "offered"]
