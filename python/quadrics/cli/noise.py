"""`quadrics noise`: the noise of the paper's experiments."""

from __future__ import annotations

import argparse
from pathlib import Path

SUMMARY = "Add the noise of the paper's experiments to a mesh (eq. 5)"
EXAMPLES = """\
examples:
  quadrics noise part.stl -o noisy.ply
  quadrics noise part.stl -o noisy.ply --sigma 0.005 --ratio 0.5 --seed 1
  quadrics noise part.stl -o noisy.ply --sigma 0.004 --ratio 0.5 --gaussian

A share RATIO of the vertices moves along its normal by up to SIGMA times the longest side of
the bounding box, either way. Faces and their order stay, so labels of the part stay true;
polygons are written as triangles.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    add = parser.add_argument
    add("mesh", type=Path, help="STL, PLY, OBJ, OFF, GLB, glTF or 3MF")
    where = "file to write: .ply, .stl, .obj or .off"
    add("-o", "--output", type=Path, required=True, metavar="FILE", help=where)
    size = "largest displacement, as a fraction of the longest side (default 0.01)"
    add("--sigma", type=float, default=0.01, metavar="X", help=size)
    share = "share of the vertices that move, from 0 to 1 (default 0.9)"
    add("--ratio", type=float, default=0.9, metavar="X", help=share)
    bell = "Gaussian displacements, of which SIGMA is the standard deviation (paper, 5.5)"
    add("--gaussian", action="store_true", help=bell)
    add("--seed", type=int, default=0, metavar="N", help="seed of every draw (default 0)")
    add("--overwrite", action="store_true", help="replace the file if it is there")


def run(arguments: argparse.Namespace) -> None:
    """Read, move, write."""
    from quadrics import synth
    from quadrics.files import check_target
    from quadrics.mesh import read

    check_target(arguments.output, overwrite=arguments.overwrite)
    mesh = read(arguments.mesh)
    noisy = synth.noise(
        mesh,
        sigma=arguments.sigma,
        ratio=arguments.ratio,
        gaussian=arguments.gaussian,
        seed=arguments.seed,
    )
    noisy.save(arguments.output, overwrite=arguments.overwrite)
    print(f"{arguments.output}: {len(noisy.vertices)} vertices, {len(noisy.faces)} faces")
