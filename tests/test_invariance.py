"""The clean parts with known truth, in another order, place, attitude and size: the same result."""

from pathlib import Path
from typing import TypeAlias

import numpy as np
import pytest
from numpy.typing import NDArray

import quadrics

Floats: TypeAlias = NDArray[np.float64]
Labels: TypeAlias = NDArray[np.integer]

PARTS = Path(__file__).parents[2] / "shared" / "data" / "parts"
NAMES = sorted(folder.name for folder in PARTS.glob("*") if (folder / "mesh.ply").exists())
MOVED = 0.002
"""Most area, as a share, that may change its region (eq. 6)."""


def turned(points: Floats) -> Floats:
    """Points of shape (n, 3) turned about an odd axis by an odd angle, moved and scaled by 1000."""
    axis = np.array([0.36, 0.48, 0.8])
    cross = np.cross(np.eye(3), axis)
    rotation = np.eye(3) + np.sin(0.7) * cross + (1 - np.cos(0.7)) * cross @ cross
    moved: Floats = 1000 * (points @ rotation.T + [3.0, -7.0, 11.0])
    return moved


def areas(mesh: quadrics.Mesh) -> Floats:
    """Area of every face, shape (n,), in squared units of the mesh."""
    a, b, c = np.moveaxis(np.asarray(mesh.vertices)[np.asarray(mesh.faces)], 1, 0)
    halves: Floats = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    return halves


def moved(one: Labels, other: Labels, weights: Floats) -> float:
    """Share of the area outside the best partner of its region, the worse of both ways (eq. 6)."""
    common = np.zeros((one.max() + 1, other.max() + 1))
    np.add.at(common, (one, other), weights)
    kept = min(common.max(axis=0).sum(), common.max(axis=1).sum())
    return float(1 - kept / weights.sum())


def types(result: quadrics.Result) -> list[str]:
    """The types of all surfaces, sorted."""
    return sorted(region.surface.type for region in result.regions)


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", NAMES or [pytest.param("", marks=pytest.mark.skip("no ../shared"))]
)
def test_order_place_attitude_and_size_do_not_matter(name: str) -> None:
    mesh = quadrics.read(PARTS / name / "mesh.ply")
    positions, faces = np.asarray(mesh.vertices), np.asarray(mesh.faces)
    plain = quadrics.segment(mesh, seed=0)
    order = np.random.default_rng(5).permutation(len(faces))
    changed = [
        (quadrics.Mesh(positions, faces[order]), np.argsort(order)),
        (quadrics.Mesh(turned(positions), faces), np.arange(len(faces))),
    ]
    for other, back in changed:
        result = quadrics.segment(other, seed=0)
        assert types(result) == types(plain)
        assert moved(plain.labels, result.labels[back], areas(mesh)) < MOVED


@pytest.mark.slow
@pytest.mark.skipif(not PARTS.exists(), reason="no ../shared")
@pytest.mark.parametrize("name", ["anchor", "block", "joint"])
def test_the_scale_of_a_faceted_mesh_does_not_hang_on_the_seed(name: str) -> None:
    """Exact planes beside bores that facets leave by 1e-4 to 1e-3 of the size (decision 0002)."""
    mesh = quadrics.read(PARTS.parent / "real" / f"{name}.ply")
    counts = {len(quadrics.segment(mesh, seed=seed).regions) for seed in range(4)}
    assert len(counts) == 1, counts
