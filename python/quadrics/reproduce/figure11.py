"""Figure 11: against VSA, QSF, HFP and RANSAC alone."""

from __future__ import annotations

from typing import Any

from quadrics.answer import as_answer
from quadrics.evaluation import judge
from quadrics.picture import region_view
from quadrics.reproduce.data import Data
from quadrics.reproduce.paper import regions_of
from quadrics.reproduce.section import Note, Pictures, Section, Table
from quadrics.run import segment

METHODS: dict[str, dict[str, Any]] = {
    "VSA": {"method": "vsa"},
    "QSF": {"method": "qsf"},
    "HFP": {"method": "hfp"},
    "RANSAC alone": {"method": "ransac"},
    "preset=paper": {"preset": "paper"},
    "default": {},
}


def make(data: Data) -> Section:
    """Judge every method on five parts, and draw them on the dynamo."""
    rows = []
    for part in data.known():
        for label, options in METHODS.items():
            # RANSAC finds the number itself.
            regions = None if label == "RANSAC alone" else len(part.truth.ids)
            result = segment(part.mesh, regions=regions, **options)
            seen = judge(as_answer(result), part.truth, part.mesh)
            values = (seen.hamming, seen.consistency, seen.f1, seen.f1_geometry)
            rows.append(
                (part.name, label, str(len(result.regions)), *(f"{v:.4f}" for v in values),
                 f"{seen.energy:.2e}", f"{result.timing['total_s']:.2f}")
            )  # fmt: skip
    headings = ("part", "method", "regions", "HD", "CE", "F1", "F1, type aside", "energy", "s")
    dynamo = data.model("dynamo")
    views = []
    for label, options in METHODS.items():
        regions = None if label == "RANSAC alone" else regions_of("dynamo")
        result = segment(dynamo.mesh, regions=regions, **options)
        views.append((f"{label}: {len(result.regions)} regions", region_view(result)))
    words = (
        "Clean parts, the true number of regions given. The regions of every method get their "
        "surfaces by the same last fit, so F1 compares regions, not fits."
    )
    return Section(
        "Figure 11: other methods",
        [Table(headings, rows), Note(words), Pictures(views), Note(dynamo.caption)],
    )
