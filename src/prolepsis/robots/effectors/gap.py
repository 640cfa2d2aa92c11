"""The gap between the pads of an effector as a function of how far its joints have opened."""

from __future__ import annotations

from dataclasses import dataclass

from prolepsis.geometry.shape import FloatArray


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Gap:
    """Gap and lever over the length of the tendon that joins the joints, at evenly spaced lengths."""

    first: float
    """Least length of the tendon: the sum of the joints' coordinates [m or rad]."""
    step: float
    """Distance of two tabulated lengths [m or rad]."""
    gaps: tuple[float, ...]
    """Gap at each length [m], rising."""
    levers: tuple[float, ...]
    """Rise of the gap over the rise of the length at each length [1 or m/rad]: motor force over pad force."""
    ahead: tuple[float, ...]
    """How far along the effector's x axis what it holds has its middle at each length [m]."""
    across: tuple[float, ...]
    """And along its y axis [m]."""

    @classmethod
    def sliding(cls, first: float, width: float) -> Gap:
        """Return the gap of two pads that slide: ``first`` [m] where the joints are at 0, up to ``width`` [m]."""
        return cls(first=-first, step=width, gaps=(0.0, width), levers=(1.0, 1.0), ahead=(0.0, 0.0), across=(0.0, 0.0))

    @classmethod
    def tabulated(cls, lengths: FloatArray, gaps: FloatArray, ahead: FloatArray, across: FloatArray) -> Gap:
        """Return the gap, and where things are held, measured at evenly spaced tendon lengths, each shape (n,)."""
        step = float(lengths[1] - lengths[0])
        inner = (gaps[2:] - gaps[:-2]) / (2 * step)
        ends = (2 * inner[0] - inner[1], 2 * inner[-1] - inner[-2])
        levers = (ends[0], *inner.tolist(), ends[1])
        return cls(
            first=float(lengths[0]),
            step=step,
            gaps=tuple(gaps.tolist()),
            levers=tuple(map(float, levers)),
            ahead=tuple(ahead.tolist()),
            across=tuple(across.tolist()),
        )

    def opening(self, length: float) -> float:
        """Return the gap [m] at a tendon length; beyond the table it goes on straight."""
        return self._at(self.gaps, length)

    def lever(self, length: float) -> float:
        """Return the rise of the gap over that of the length [1 or m/rad]."""
        return self._at(self.levers, length)

    def held_at(self, gap: float) -> tuple[float, float]:
        """Return where what is held has its middle at a gap [m], along x and y of the effector's frame [m]."""
        length = self.length(gap)
        return self._at(self.ahead, length), self._at(self.across, length)

    @property
    def least(self) -> float:
        """Least gap [m]: nothing thinner is held."""
        return self.gaps[0]

    @property
    def greatest(self) -> float:
        """Greatest gap [m]."""
        return self.gaps[-1]

    def _at(self, values: tuple[float, ...], length: float) -> float:
        row = (length - self.first) / self.step
        k = min(max(int(row), 0), len(values) - 2)
        return values[k] + (row - k) * (values[k + 1] - values[k])

    def length(self, gap: float) -> float:
        """Return the tendon length at which the gap is ``gap`` [m]; the nearest one in the table."""
        low, high = 0, len(self.gaps) - 1
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (middle, high) if self.gaps[middle] <= gap else (low, middle)
        rise = self.gaps[high] - self.gaps[low]
        share = min(max((gap - self.gaps[low]) / rise, 0.0), 1.0)
        return self.first + self.step * (low + share)
