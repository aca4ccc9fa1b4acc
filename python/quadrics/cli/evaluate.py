"""`quadrics evaluate`: how good a result is."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from quadrics.evaluation import Evaluation

SUMMARY = "Compare a result with the truth, or with another result"
EXAMPLES = """\
examples:
  quadrics evaluate scan/ truth/
  quadrics evaluate scan/ truth/ --tolerance 0.002
  quadrics evaluate new/ old/ --json | jq .hamming

RESULT is a folder that `quadrics segment` wrote. TRUTH is another one of the same mesh, or a folder
with mesh.ply, labels.npy (a region for every face) and truth.json (the surface of every region).
HD and CE are eq. 6 and 7 of the paper: 0 is best. A region is recognised if it overlaps a true one
by 0.6 (intersection over union) and its type and surface are right.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    add = parser.add_argument
    add("result", type=Path, metavar="RESULT", help="folder that `quadrics segment` wrote")
    add("truth", type=Path, metavar="TRUTH", help="folder of the truth, or of another result")
    far = "largest distance of a right surface, as a fraction of the size (default 0.01)"
    add("--tolerance", type=float, default=0.01, metavar="X", help=far)
    add("--json", action="store_true", help="print one JSON document instead of the table")


def run(arguments: argparse.Namespace) -> None:
    """Read both, compare, print."""
    from quadrics.evaluation import evaluate

    seen = evaluate(arguments.result, arguments.truth, tolerance=arguments.tolerance)
    if arguments.json:
        print(json.dumps(seen.to_dict(), indent=1, allow_nan=False))
        return
    for line in _lines(seen):
        print(line)


def _lines(seen: Evaluation) -> list[str]:
    aside = _recognised(seen.precision_geometry, seen.recall_geometry, seen.f1_geometry)
    rows = [
        ("regions", f"{seen.regions_found} found, {seen.regions_true} true"),
        ("HD, CE", f"{seen.hamming:.4f}, {seen.consistency:.4f}"),
        ("Rand, adjusted", f"{seen.rand_index:.4f}, {seen.adjusted_rand_index:.4f}"),
        ("mean IoU", f"{seen.mean_iou:.4f}"),
        ("with type", _recognised(seen.precision, seen.recall, seen.f1)),
        ("type aside", aside),
        ("energy (eq. 1)", f"{seen.energy:.4g}"),
    ]
    if seen.without_surface > 0:
        rows.append(("", f"without {seen.without_surface:.1%} of the area, which has no surface"))
    if seen.unlabelled_area > 0:
        rows.append(("without a label", f"{seen.unlabelled_area:.1%} of the area"))
    lines = [f"{name:<16} {value}" for name, value in rows]
    for kind, errors in seen.parameter_errors.items():
        shown = (f"{name} {values['median']:.2g}" for name, values in errors.items())
        count = max(values["count"] for values in errors.values())
        lines.append(f"{kind + ' (' + str(int(count)) + ')':<22} {', '.join(shown)}")
    if seen.parameter_errors:
        lines.append(
            "(medians; degrees, relative radii, position and rms as fractions of the size)"
        )
    if seen.missed:
        lines.append(f"not recognised   {', '.join(map(str, seen.missed))}")
    return lines


def _recognised(precision: float, recall: float, f1: float) -> str:
    return f"precision {precision:.3f}, recall {recall:.3f}, F1 {f1:.3f}"
