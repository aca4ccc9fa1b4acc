"""Figure 6: the twelve under noise, as pictures."""

from __future__ import annotations

from quadrics import synth
from quadrics.picture import plain_view, region_view
from quadrics.reproduce.data import Data
from quadrics.reproduce.section import Note, Pictures, Section
from quadrics.run import segment


def make(data: Data) -> Section:
    """Segment the clean mesh, and with 20 % and 80 % of the vertices moved."""
    model = data.model("twelve")
    clean = segment(model.mesh)
    views = [("input", plain_view(model.mesh)), ("clean", region_view(clean))]
    for ratio in (0.2, 0.8):
        noisy = synth.noise(model.mesh, sigma=0.01, ratio=ratio)
        result = segment(noisy, regions=len(clean.regions))
        views.append((f"{ratio:.0%} of the vertices", region_view(result)))
    return Section("Figure 6: noise on twelve", [Pictures(views), Note(model.caption)])
