"""What of a run is the method's, as the paper counts it."""

from __future__ import annotations

from quadrics.result import Result

#: Section 4: subdivision, initialisation, optimisation. Noise, types and dimensions are our own.
STATIONS = ("prepare", "detect", "segment")


def method_seconds(result: Result) -> float:
    """Seconds of the paper's own stations."""
    return sum(result.timing.get(station, 0.0) for station in STATIONS)
