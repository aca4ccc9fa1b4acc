"""What CAD programs write: few, long and exact triangles, and no vertex within a plane."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import meshes
import quadrics


def rounded(width: float, depth: float, radius: float, facets: int) -> NDArray[np.float64]:
    """The outline of a rectangle whose corners are rounded."""
    turns = np.radians(np.linspace(0, 90, facets + 1))
    corners = [(1, 1), (-1, 1), (-1, -1), (1, -1)]
    arcs = []
    for i, (x, y) in enumerate(corners):
        center = np.array([x * (width / 2 - radius), y * (depth / 2 - radius)])
        angles = turns + i * np.pi / 2
        arcs.append(center + radius * np.column_stack([np.cos(angles), np.sin(angles)]))
    return np.concatenate(arcs)


@pytest.mark.parametrize("facets", [4, 12, 400])
def test_sides_of_two_triangles_and_the_fillets_between_them(facets: int) -> None:
    found = quadrics.segment(meshes.prism(rounded(80, 50, 6, facets), 20))

    types = sorted(region.surface.type for region in found.regions)
    assert types == ["cylinder"] * 4 + ["plane"] * 6
    for region in found.regions:
        if isinstance(region.surface, quadrics.Cylinder):
            assert region.surface.radius == pytest.approx(6, rel=1e-6)
            assert region.faces == 2 * facets
    assert found.noise.position < 0.001


def test_a_nut_has_six_sides() -> None:
    angles = np.radians(60 * np.arange(6))
    found = quadrics.segment(
        meshes.prism(10 * np.column_stack([np.cos(angles), np.sin(angles)]), 8)
    )

    assert [region.surface.type for region in found.regions] == ["plane"] * 8
