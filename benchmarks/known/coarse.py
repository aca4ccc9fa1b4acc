"""Whether the path over a coarser mesh (`--coarse on`) comes to the same regions as the full one.

python benchmarks/known/coarse.py ../shared/data/parts/* --divide 1 --record coarse.csv

A row a part: faces, regions of either path, the share of the area that both give to the same
region, F1 of either, and the median error of the radii of either in per cent.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

import numpy as np
import rows
from numpy.typing import NDArray

import quadrics
from quadrics.answer import as_answer
from quadrics.evaluation import Evaluation, judge

COLUMNS = ["name", "faces", "full", "coarse", "agree", "f1_full", "f1_coarse"]
COLUMNS += ["radius_full", "radius_coarse"]


def main() -> None:
    """Run both paths on every part."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("parts", type=Path, nargs="+", help="folders with mesh.ply and truth.json")
    parser.add_argument("--divide", type=int, default=0, help="divide every face 1:4 so many times")
    parser.add_argument("--record", type=Path, help="CSV file")
    options = parser.parse_args()
    table = []
    for folder in options.parts:
        table.append(row(folder, options.divide))
        rows.show(table[-1:], COLUMNS)
    worst = min(table, key=lambda one: one["agree"])
    mean = sum(one["agree"] for one in table) / len(table)
    print(f"agreement: mean {mean:.4f}, least {worst['agree']} ({worst['name']})")
    rows.record(options.record, table, COLUMNS)


def row(folder: Path, times: int) -> dict:
    """Compare both paths on one part."""
    truth = as_answer(folder)
    mesh, labels = quadrics.read(folder / "mesh.ply"), truth.labels
    for _ in range(times):
        mesh, labels = divided(mesh), np.repeat(labels, 4)
    truth = replace(truth, labels=labels, mesh=mesh)
    full, coarse = (quadrics.segment(mesh, coarse=choice) for choice in ("off", "on"))
    judged = [judge(as_answer(result), truth, mesh) for result in (full, coarse)]
    a, b, c = mesh.vertices[mesh.faces].transpose(1, 0, 2)
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    return {
        "name": folder.name,
        "faces": mesh.face_count,
        "full": len(full.regions),
        "coarse": len(coarse.regions),
        "agree": round(agreement(full.labels, coarse.labels, areas), 4),
        **{f"f1_{way}": round(one.f1, 3) for way, one in zip(WAYS, judged, strict=True)},
        **{f"radius_{way}": radius(one) for way, one in zip(WAYS, judged, strict=True)},
    }


WAYS = ("full", "coarse")


def radius(judged: Evaluation) -> float:
    """Give the median relative error of the radii, in per cent."""
    known = judged.parameter_errors.get("all", {}).get("radius", {})
    return float(f"{100 * known.get('median', float('nan')):.2g}")


def divided(mesh: quadrics.Mesh) -> quadrics.Mesh:
    """Divide every face 1:4 at the middles of its edges; the four follow each other."""
    ends = np.sort(mesh.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    edges, place = np.unique(ends, axis=0, return_inverse=True)
    (a, b, c), middle = mesh.faces.T, len(mesh.vertices) + place.reshape(-1, 3)
    ab, bc, ca = middle.astype(np.uint32).T
    faces = np.stack([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], axis=1).reshape(-1, 3)
    vertices = np.concatenate([mesh.vertices, mesh.vertices[edges].mean(axis=1)])
    return quadrics.Mesh(vertices, np.ascontiguousarray(faces, np.uint32))


def agreement(
    one: NDArray[np.int32], other: NDArray[np.int32], areas: NDArray[np.float64]
) -> float:
    """Give the share of the area where both agree: pairs of regions, the largest first."""
    shared = np.zeros((one.max() + 1, other.max() + 1))
    np.add.at(shared, (one, other), areas)
    pairs = zip(*np.unravel_index(np.argsort(-shared, axis=None), shared.shape), strict=True)
    taken: tuple[set[int], set[int]] = (set(), set())
    sum_ = 0.0
    for i, j in pairs:
        if shared[i, j] > 0 and i not in taken[0] and j not in taken[1]:
            taken[0].add(i)
            taken[1].add(j)
            sum_ += shared[i, j]
    return float(sum_ / areas.sum())


if __name__ == "__main__":
    main()
