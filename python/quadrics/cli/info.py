"""`quadrics info`: what is in a file, and what would be repaired, without segmenting."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

SUMMARY = "Show what is in a file, and what would be repaired"
EXAMPLES = """\
examples:
  quadrics info scan.stl
  quadrics info scan.stl --json | jq .area
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    parser.add_argument("mesh", type=Path, help="STL, PLY, OBJ, OFF, GLB, glTF or 3MF")
    parser.add_argument("--json", action="store_true", help="print one JSON document instead")


def run(arguments: argparse.Namespace) -> None:
    """Read, look, print."""
    from quadrics.mesh import inspect, read

    found = inspect(read(arguments.mesh))
    if arguments.json:
        print(json.dumps(found, indent=1, allow_nan=False))
        return
    for line in _lines(found):
        print(line)


def _lines(found: dict[str, Any]) -> list[str]:
    low, high = found["bounds"]
    sides = " x ".join(f"{b - a:.6g}" for a, b in zip(low, high, strict=True))
    pieces = f"{found['components']} ({found['closed_components']} closed)"
    volume = "open" if found["volume"] is None else f"{found['volume']:.6g}"
    rows = [
        ("file", found["path"]),
        ("units", found["units"] or "not given in the file"),
        ("faces", found["faces"]),
        ("vertices", found["vertices"]),
        ("sides", sides),
        ("lowest corner", ", ".join(f"{x:.6g}" for x in low)),
        ("area", f"{found['area']:.6g}"),
        ("volume", volume),
        ("median edge", f"{found['median_edge']:.4g}"),
        ("components", pieces),
        ("border edges", found["border_edges"]),
        ("non-manifold edges", found["non_manifold_edges"]),
        ("Euler number", found["euler"]),
    ]
    lines = [f"{name:<19} {value}" for name, value in rows]
    repairs = [r["detail"] for r in found["repairs"]]
    return [*lines, *(f"to be handled       {repair}" for repair in repairs or ["nothing"])]
