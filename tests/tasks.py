"""What workers are given in the tests: a worker imports it by name."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path

from prolepsis.campaigns.campaign import Row
from prolepsis.scenario.scenario import Scenario


def square(number: int) -> int:
    return number * number


def square_or_die(number: int, deadly: int, survivals: str) -> int:
    """Return the square of a number; at the ``deadly`` one the process is killed, the first time."""
    if number == deadly and not Path(survivals).read_text():
        Path(survivals).write_text("next time")
        os.kill(os.getpid(), signal.SIGKILL)
    return square(number)


def square_or_end(number: int, deadly: int) -> int:
    if number == deadly:
        os._exit(1)
    return square(number)


def square_or_fail(number: int, deadly: int) -> int:
    if number == deadly:
        raise KeyError(number)
    return square(number)


def tell_and_sleep(file: str) -> None:
    """Write the number of this process into a file, and take a long time."""
    part = Path(f"{file}.part")
    part.write_text(str(os.getpid()))
    part.rename(file)
    time.sleep(600)


def row_or_end(scenario: Scenario, values: dict[str, float | str], ask: str | None, limit: int | None) -> Row:
    """Stand for a run that ends its process at a time of 0.02 s."""
    del scenario, ask, limit
    if values["Time"] == 0.02:
        os.kill(os.getpid(), signal.SIGKILL)
    return Row(values=values)
