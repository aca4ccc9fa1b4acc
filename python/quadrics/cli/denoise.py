"""`quadrics denoise`: vertices onto the recognised surfaces."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

SUMMARY = "Take the noise off a mesh by its recognised surfaces"
EXAMPLES = """\
examples:
  quadrics denoise scan.stl -o clean.ply
  quadrics denoise scan.stl -o clean.ply --segmentation scan/
  quadrics denoise noisy.ply -o clean.ply --reference part.ply --map map.png

Vertices go to the surface of their region, to the curve of two or to the point of three; none
moves further than four standard deviations of the noise. Without --segmentation the mesh is
segmented first. With --reference the largest and the mean distance from it, both ways, are
printed before and after, as fractions of the longest side too.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    add = parser.add_argument
    add("mesh", type=Path, help="STL, PLY, OBJ, OFF, GLB, glTF or 3MF")
    where = "file to write: .ply, .stl, .obj or .off"
    add("-o", "--output", type=Path, required=True, metavar="FILE", help=where)
    add("--segmentation", type=Path, metavar="FOLDER", help="what `quadrics segment` wrote of it")
    add("--reference", type=Path, metavar="MESH", help="mesh to measure the distance from")
    picture = "with --reference: picture of the distances before and after (.png)"
    add("--map", type=Path, metavar="FILE", help=picture)
    add("--overwrite", action="store_true", help="replace files that are there")
    add("--json", action="store_true", help="print one JSON document instead of the table")


def run(arguments: argparse.Namespace) -> None:
    """Read, move, write, measure."""
    import quadrics
    from quadrics.errors import OptionError
    from quadrics.files import PICTURES, check_target
    from quadrics.mesh import read

    if arguments.map and not arguments.reference:
        raise OptionError("--map shows distances from a reference: give --reference too")
    check_target(arguments.output, overwrite=arguments.overwrite)
    if arguments.map:
        check_target(arguments.map, overwrite=arguments.overwrite, endings=PICTURES)
    noisy = read(arguments.mesh)
    reference = read(arguments.reference) if arguments.reference else None
    clean = quadrics.denoise(noisy, arguments.segmentation)
    seen: dict[str, Any] = {"vertices": len(noisy.vertices), "moved": _moved(noisy, clean)}
    if reference is not None:
        before = quadrics.deviation(noisy, reference)
        after = quadrics.deviation(clean, reference)
        for name, found in (("before", before), ("after", after)):
            seen[name] = {"hausdorff": found.hausdorff, "mean": found.mean}
        seen["size"] = reference.size
        if arguments.map:
            from quadrics.heat import write_map

            write_map(arguments.map, [(noisy, before.of_vertex), (clean, after.of_vertex)])
    clean.save(arguments.output, overwrite=arguments.overwrite)
    if arguments.json:
        print(json.dumps(seen, indent=1, allow_nan=False))
        return
    for line in _lines(seen):
        print(line)


def _moved(noisy: Any, clean: Any) -> dict[str, float]:
    import numpy as np

    way = np.linalg.norm(clean.vertices - noisy.vertices, axis=1)
    return {"count": int((way > 0).sum()), "mean": float(way.mean()), "most": float(way.max())}


def _lines(seen: dict[str, Any]) -> list[str]:
    moved = seen["moved"]
    lines = [
        f"{moved['count']} of {seen['vertices']} vertices moved, "
        f"{moved['mean']:.3g} on the mean, {moved['most']:.3g} at most"
    ]
    if "before" in seen:
        lines.append(f"{'':<10} {'largest':>24} {'mean':>24}")
        for name in ("before", "after"):
            cells = (seen[name][key] for key in ("hausdorff", "mean"))
            shown = (f"{value:.4g} ({value / seen['size']:.3%})" for value in cells)
            lines.append(f"{name:<10} " + " ".join(f"{cell:>24}" for cell in shown))
    return lines
