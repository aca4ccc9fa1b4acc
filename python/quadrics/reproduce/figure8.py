"""Figure 8: meshes that were scanned."""

from __future__ import annotations

from quadrics.picture import plain_view, region_view
from quadrics.reproduce.data import Data
from quadrics.reproduce.section import Note, Pictures, Section
from quadrics.run import segment

MODELS = ("rolling_stage", "carter", "oil_pump")


def make(data: Data) -> Section:
    """Segment scans without any parameter."""
    section = Section("Figure 8: scanned meshes")
    for name in MODELS:
        model = data.model(name)
        result = segment(model.mesh)
        noise = result.noise.position / model.mesh.size
        found = f"{len(result.regions)} regions, noise {noise:.2g} of the size"
        views = [(name, plain_view(model.mesh)), (found, region_view(result))]
        section.blocks.extend([Pictures(views), Note(model.caption)])
    return section
