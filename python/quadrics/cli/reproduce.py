"""`quadrics reproduce`: the paper's tables and figures."""

from __future__ import annotations

import argparse
from pathlib import Path

#: What can be made; the imports that make it come later.
NAMES = (
    "figure1", "figure2", "table1", "figure3", "figure4", "figure5", "figure6", "figure7",
    "figure8", "table2", "table3", "figure9", "figure10", "figure11", "figure12",
)  # fmt: skip

SUMMARY = "Run the paper's experiments: its tables and figures beside ours"
EXAMPLES = f"""\
examples:
  quadrics reproduce table2
  quadrics reproduce table2 --data meshes/
  quadrics reproduce all --data meshes/ -o paper.html

names: {", ".join(NAMES[:8])},
{", ".join(NAMES[8:])}, or all

Tables are printed, and an HTML page with pictures and plots is written. FOLDER holds real/NAME.ply
(joint, fandisk, twelve, ...) and parts/NAME/ with mesh.ply, labels.npy, truth.json; what is not
there is replaced by a generated part, and the page says so. Everything takes some ten minutes.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    add = parser.add_argument
    add("name", choices=(*NAMES, "all"), metavar="NAME", help="table or figure, or all")
    add("--data", type=Path, metavar="FOLDER", help="meshes; generated parts when not given")
    add("-o", "--output", type=Path, metavar="FILE", help="page to write (default NAME.html)")
    add("--overwrite", action="store_true", help="replace the page if it is there")


def run(arguments: argparse.Namespace) -> None:
    """Make what was asked for, print its tables, write its page."""
    from quadrics.files import check_target, write_whole
    from quadrics.reproduce import experiment
    from quadrics.reproduce.data import Data
    from quadrics.reproduce.page import page

    output = arguments.output or Path(f"{arguments.name}.html")
    check_target(output, overwrite=arguments.overwrite, endings=(".html",))
    data = Data(arguments.data)
    sections = []
    for name in NAMES if arguments.name == "all" else (arguments.name,):
        section = experiment(name)(data)
        print(section.text(), flush=True)
        sections.append(section)
    write_whole(output, page(sections).encode())
    print(f"page with pictures in {output}")
