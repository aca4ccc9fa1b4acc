"""Regions that are called sure are right, on parts that no constant was fitted to."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from numpy.typing import NDArray

import quadrics
from quadrics import synth
from quadrics.answer import as_answer
from quadrics.evaluation import judge
from quadrics.mesh import Mesh
from quadrics.synth import Part

PARTS = ("shaft", "plate", "draft", "open", "demo")


def variants(name: str) -> Iterator[tuple[Part, Mesh]]:
    """Give the part clean, under the noise of eq. 5, and as a scan."""
    part = synth.part(name, 12_000)
    yield part, part.mesh
    for sigma, ratio in ((0.005, 0.5), (0.005, 1.0), (0.01, 0.9)):
        yield part, synth.noise(part.mesh, sigma=sigma, ratio=ratio)
    scan = synth.scan(part)
    yield scan, scan.mesh


def confidences(part: Part, mesh: Mesh) -> list[tuple[float, bool]]:
    """Confidence of every region, and whether it is right."""
    result = quadrics.segment(mesh)
    hits = {m.found for m in judge(as_answer(result), as_answer(part), mesh).matches if m.hit}
    return [(region.confidence, region.id in hits) for region in result.regions]


@pytest.mark.slow
def test_of_regions_above_nine_tenths_19_in_20_are_right() -> None:
    every: NDArray[np.float64] = np.array(
        [row for name in PARTS for variant in variants(name) for row in confidences(*variant)]
    )
    sure = every[every[:, 0] > 0.9]
    assert len(sure) > 0.5 * len(every)
    assert sure[:, 1].mean() >= 0.95
