"""`quadrics segment`: the main job."""

from __future__ import annotations

import argparse
import inspect
import re
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import fields
from pathlib import Path
from typing import Any

from quadrics.options import CHOICES, WHOLE, Options

SUMMARY = "Recognise the surfaces of a mesh"
EXAMPLES = """\
examples:
  quadrics segment scan.stl -o scan/
  quadrics segment scan.stl -o scan/ --regions 24 --seed 1
  quadrics segment scan.ply -o scan/ --preset paper --beta 0.01
  quadrics segment scan.stl -o scan/ --initial-labels mine.npy
  quadrics segment scan.stl -o scan/ --constraints known.json --round-length 0.1
  quadrics segment scan.stl -o scan/ --json | jq '.regions[].type'

The folder then holds labels.npy (a region for every face of the input), segmentation.json,
segmentation.ply (coloured) and segmentation.png. Lengths are in the unit of the input.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options; those of `Options` by their names and from its docstring."""
    add = parser.add_argument
    formats = "STL, PLY, OBJ, OFF, GLB, glTF or 3MF, or one of them as .gz, .bz2 or .xz"
    add("mesh", type=Path, help=formats)
    where = "folder for the results; made if it is not there"
    add("-o", "--output", type=Path, required=True, metavar="FOLDER", help=where)
    add("--overwrite", action="store_true", help="replace an earlier result in that folder")
    start = "start from these regions: one whole number per face of the input"
    add("--initial-labels", type=Path, metavar="FILE.npy", help=start)
    unit = "length unit of the mesh, such as mm; noted, nothing is converted"
    relations = "relations between surfaces: sought and imposed, or not, or what is known of them"
    add("--constraints", default="on", metavar="on|off|FILE.json", help=f"{relations} (default on)")
    grid = "round dimensions to multiples of this length where the data allow it"
    add("--round-length", type=float, metavar="X", help=grid)
    add("--round-angle-deg", type=float, metavar="X", help="the same for angles, in degrees")
    add("--units", metavar="UNIT", help=unit)
    add("--json", action="store_true", help="print segmentation.json instead of the table")
    add("--quiet", action="store_true", help="no table and no progress")
    group = parser.add_argument_group("options of the method")
    described = _described()
    for field in (f for f in fields(Options) if f.name != "constraints"):
        default = "" if field.default is None else f" (default {field.default})"
        group.add_argument(
            f"--{field.name.replace('_', '-')}",
            type=str if field.name in CHOICES else _whole if field.name in WHOLE else float,
            choices=CHOICES.get(field.name),
            metavar=None if field.name in CHOICES else "N" if field.name in WHOLE else "X",
            default=argparse.SUPPRESS,
            help=described.get(field.name, "").replace("%", "%%") + default,
        )


def run(arguments: argparse.Namespace) -> None:
    """Segment, save, and print."""
    given = vars(arguments)
    chosen = {f.name: given[f.name] for f in fields(Options) if f.name in given}
    options = Options(**{**chosen, "constraints": _constraints(arguments)})

    from quadrics import folder, mesh, segment
    from quadrics.cli.progress import shown
    from quadrics.picture import look

    folder.check(arguments.output, overwrite=arguments.overwrite)
    with shown(quiet=arguments.quiet) as progress, ThreadPoolExecutor(1) as pool:
        progress("read", 0.0)
        source = mesh.read(arguments.mesh)
        labels = _labels(arguments.initial_labels)
        # What is seen of the mesh does not hang on what is recognised in it.
        seen = None if options.threads == 1 else pool.submit(look, source)
        result = segment(
            source, options, initial_labels=labels, units=arguments.units, progress=progress
        )
        progress("write", 0.0)
        saved = folder.save(result, arguments.output, overwrite=arguments.overwrite, seen=seen)
    if arguments.json:
        sys.stdout.write(folder.to_json(result))
    elif not arguments.quiet:
        from quadrics.cli.table import print_result

        print_result(result, saved)


def _constraints(arguments: argparse.Namespace) -> bool | dict[str, Any]:
    from quadrics.constraints import as_constraints
    from quadrics.errors import OptionError

    given = arguments.constraints
    grid = {"length": arguments.round_length, "angle_deg": arguments.round_angle_deg}
    grid = {name: value for name, value in grid.items() if value is not None}
    if given in ("on", "off") and not grid:
        return bool(given == "on")
    if given == "off":
        raise OptionError("--round-length and --round-angle-deg need --constraints on")
    document = {} if given == "on" else as_constraints(Path(given))
    return {**document, "round": {**document.get("round", {}), **grid}}


def _labels(path: Path | None) -> Any:
    if path is None:
        return None
    import io

    import numpy as np

    from quadrics.errors import InputError
    from quadrics.files import read_bytes

    try:
        # No pickles: such a file could run anything.
        return np.load(io.BytesIO(read_bytes(path)), allow_pickle=False)
    except InputError:
        raise
    except Exception:
        raise InputError(f"{path}: is no .npy file of whole numbers") from None


def _whole(text: str) -> int:
    return int(text)


_whole.__name__ = "whole number"  # argparse names the type in its errors.


def _described() -> dict[str, str]:
    """Descriptions of the fields, from the docstring of `Options`."""
    # Python 3.13 takes the indentation out of docstrings, older ones leave it in.
    text = inspect.cleandoc(Options.__doc__ or "")
    found = re.findall(r"^(\w+) : .*\n((?: {4}.*\n?)+)", text, re.MULTILINE)
    return {name: " ".join(lines.split()).removesuffix(".") for name, lines in found}
