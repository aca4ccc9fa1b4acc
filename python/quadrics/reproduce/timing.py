"""How long a run takes: of the processor, which no other program changes, and by the wall clock."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

from quadrics.mesh import Mesh
from quadrics.result import Result
from quadrics.run import segment

#: Section 4: subdivision, initialisation, optimisation. Noise, types and dimensions are our own.
STATIONS = ("prepare", "detect", "segment")


@dataclass(frozen=True, eq=False)
class Timed:
    """A result and the seconds that it took: of the processor, all threads, and by the clock."""

    result: Result
    seconds: float
    wall: float

    @property
    def method_wall(self) -> float:
        """Seconds by the clock of the paper's own stations."""
        return sum(self.result.timing.get(station, 0.0) for station in STATIONS)

    @property
    def method_seconds(self) -> float:
        """Those of the processor, by their share of the wall time."""
        return self.seconds * self.method_wall / self.result.timing["total_s"]


def timed(mesh: Mesh, **options: Any) -> Timed:
    """Segment a mesh and say how long it took."""
    start, clock = time.process_time(), time.perf_counter()
    result = segment(mesh, **options)
    return Timed(result, time.process_time() - start, time.perf_counter() - clock)
