"""Figure 5: seed regions against seed triangles, from the same start."""

from __future__ import annotations

from itertools import pairwise

from quadrics import synth
from quadrics.reproduce.data import Data
from quadrics.reproduce.plot import Curve, plot
from quadrics.reproduce.section import Block, Drawing, Note, Section, Table
from quadrics.run import segment

ROUNDS = 30


def make(data: Data) -> Section:
    """Run both kinds of seed on a noisy joint."""
    model = data.model("joint")
    noisy = synth.noise(model.mesh, sigma=0.005, ratio=0.5)
    start = segment(noisy, method="ransac").labels
    curves, rows = [], []
    for seeds in ("region", "triangle"):
        result = segment(
            noisy, preset="paper", seeds=seeds, initial_labels=start, max_iterations=ROUNDS,
            convergence=0.0,
        )  # fmt: skip
        energy = result.energy
        rises = sum(max(0.0, b - a) for a, b in pairwise(energy))
        rows.append((f"seed {seeds}", str(len(energy) - 1), f"{energy[0]:.4e}",
                     f"{min(energy):.4e}", f"{rises:.2e}"))  # fmt: skip
        curves.append(Curve(f"seed {seeds}", range(len(energy)), energy, seeds == "triangle"))
    drawing = plot(curves, "round", "error (eq. 1)", log=True)
    table = Table(("", "rounds", "first", "least", "sum of rises"), rows)
    words = f"{model.caption} Half of the vertices are moved by up to 0.005 of the size."
    blocks: list[Block] = [
        table,
        Drawing(drawing, "error by round, from the same start"),
        Note(words),
    ]
    return Section("Figure 5: seed region against seed triangle", blocks)
