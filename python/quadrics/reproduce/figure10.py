"""Figure 10: how fast the error falls."""

from __future__ import annotations

from quadrics.reproduce.data import Data
from quadrics.reproduce.paper import regions_of
from quadrics.reproduce.plot import Curve, plot
from quadrics.reproduce.section import Drawing, Note, Section
from quadrics.run import segment

MODELS = ("bone", "chess", "sample", "fandisk")


def make(data: Data) -> Section:
    """Run both methods and plot their errors by round."""
    section = Section("Figure 10: convergence")
    for name in MODELS:
        model = data.model(name)
        regions = regions_of(name)
        ours = segment(model.mesh, preset="paper", regions=regions).energy
        theirs = segment(model.mesh, method="qsf", regions=regions).energy
        curves = [
            Curve("ours", range(len(ours)), ours),
            Curve("QSF", range(len(theirs)), theirs, dashed=True),
        ]
        drawing = plot(curves, "round", "error (eq. 1)", log=True)
        section.blocks.extend([Drawing(drawing, f"{name}, {regions} regions"), Note(model.caption)])
    words = "QSF goes on with teleportations after its loop has converged: the jumps in its curve."
    section.blocks.append(Note(words))
    return section
