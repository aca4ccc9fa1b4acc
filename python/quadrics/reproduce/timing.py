"""How long a run takes: processor time, since wall time is that of the whole machine."""

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
    """A result and the seconds of processor time, of all threads, that it took."""

    result: Result
    seconds: float

    @property
    def method_seconds(self) -> float:
        """Those of the paper's own stations, by their share of the wall time."""
        timing = self.result.timing
        own = sum(timing.get(station, 0.0) for station in STATIONS)
        return self.seconds * own / timing["total_s"]


def timed(mesh: Mesh, **options: Any) -> Timed:
    """Segment a mesh and say how long it took."""
    start = time.process_time()
    result = segment(mesh, **options)
    return Timed(result, time.process_time() - start)
