"""Figure 9: starts and ends of QSF and ours."""

from __future__ import annotations

from typing import Any

from quadrics.picture import region_view
from quadrics.reproduce.data import Data
from quadrics.reproduce.paper import regions_of
from quadrics.reproduce.section import Note, Pictures, Section
from quadrics.run import segment


def make(data: Data) -> Section:
    """Draw the four segmentations."""
    model = data.model("bone")
    regions = regions_of("bone")
    views = []
    methods: dict[str, dict[str, Any]] = {"QSF": {"method": "qsf"}, "ours": {"preset": "paper"}}
    for label, options in methods.items():
        for stage, rounds in (("start", 0), ("end", 50)):
            result = segment(model.mesh, regions=regions, max_iterations=rounds, **options)
            caption = f"{label}, {stage}: error {min(result.energy):.3e}"
            views.append((caption, region_view(result)))
    return Section("Figure 9: start and end", [Pictures(views), Note(model.caption)])
