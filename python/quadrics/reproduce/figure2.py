"""Figure 2: input, start by RANSAC, result."""

from __future__ import annotations

from quadrics.picture import plain_view, region_view
from quadrics.reproduce.data import Data
from quadrics.reproduce.paper import regions_of
from quadrics.reproduce.section import Note, Pictures, Section
from quadrics.run import segment

MODELS = ("blade", "rolling_stage", "oil_pump", "fandisk", "part4")


def make(data: Data) -> Section:
    """Run the stages on every model."""
    section = Section("Figure 2: input, start, result")
    for name in MODELS:
        model = data.model(name)
        start = segment(model.mesh, method="ransac")
        paper = segment(model.mesh, preset="paper", regions=regions_of(name))
        ours = segment(model.mesh, regions=regions_of(name))
        views = [
            (f"{name}: {model.mesh.face_count} faces", plain_view(model.mesh)),
            (f"RANSAC: {len(start.regions)} regions", region_view(start)),
            (f"preset=paper: {len(paper.regions)} regions", region_view(paper)),
            (f"default: {len(ours.regions)} regions", region_view(ours)),
        ]
        section.blocks.extend([Pictures(views), Note(model.caption)])
    return section
