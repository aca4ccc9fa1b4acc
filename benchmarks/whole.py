"""Whole programs from start to end, ours and rivals in turn: time, memory, accuracy, a row a run.

python benchmarks/whole.py --faces 10000 100000 1000000 --record benchmarks/record/NAME.csv
python benchmarks/whole.py --mesh part.ply --noisy --runs 5 --truth valve_body \
    --rival "vsa=./cgal_peer vsa {mesh} {out} --k 40"

Ours runs with one and with two threads, with all that it writes. Seconds are those of a wall clock
and of the processor (user and system): on a busy machine only the latter mean something. A rival is
any program; {mesh}, {out}, {epsilon} (0.001, under noise 0.005) and {least} (faces of the smallest
shape) are filled in. `medians.py` makes a table of the record. Peak memory of a program is never
below that of this one, which starts it.
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import platform
import shlex
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

import quadrics
from quadrics import synth
from quadrics.answer import Answer, as_answer
from quadrics.evaluation import judge

HERE = Path(__file__).resolve().parent
PEER = HERE / "peers" / "cgal"
COLUMNS = ["program", "mesh", "faces", "variant", "run", "wall_s", "cpu_s", "peak_mb"]
COLUMNS += ["regions", "f1", "stages"]
#: Distances that count as on a shape, for rivals that must be told: fractions of the size.
EPSILON = {"clean": "0.001", "noisy": "0.005"}
#: Noise of eq. 5: a fraction of the size on nine vertices in ten.
SIGMA, RATIO = 0.01, 0.9
#: Faces of the smallest shape that RANSAC looks for, over all: 100 of 29,400.
LEAST = 1 / 294


@dataclass
class Case:
    """A mesh file, and what is known of it."""

    name: str
    variant: str
    path: Path
    faces: int
    truth: Answer | None = None


def main() -> None:
    """Run everything that was asked for."""
    options = parse()
    with tempfile.TemporaryDirectory() as folder:
        cases = [*generated(options, Path(folder)), *given(options, Path(folder))]
        rivals = dict(rival.split("=", 1) for rival in options.rival) or installed()
        every = ((run, case) for run in range(options.runs) for case in cases)
        rows = [row for run, case in every for row in runs(case, run, Path(folder), rivals)]
    if options.record:
        options.record.parent.mkdir(parents=True, exist_ok=True)
        with options.record.open("w", newline="") as file:
            file.write(f"# {machine()}\n")
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)


def parse() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--faces", type=int, nargs="*", default=[], help="sizes of the part")
    parser.add_argument("--part", nargs="*", default=["demo"], help="of `quadrics.synth`")
    parser.add_argument("--mesh", type=Path, nargs="*", default=[], help="other meshes")
    truth = "folder of the part that the meshes were made of by dividing its faces 1:4"
    parser.add_argument("--truth", type=Path, help=truth)
    noisy = f"each mesh with noise of eq. 5 too (sigma {SIGMA}, on {RATIO} of the vertices)"
    parser.add_argument("--noisy", action="store_true", help=noisy)
    rival = "another program, in turn with ours"
    parser.add_argument("--rival", action="append", default=[], metavar="NAME=COMMAND", help=rival)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--record", type=Path, help="CSV file for all rows")
    return parser.parse_args()


def generated(options: argparse.Namespace, folder: Path) -> Iterator[Case]:
    """Make the parts in every size, clean and noisy."""
    for faces in options.faces:
        for name in options.part:
            part = synth.part(name, faces)
            yield from variants(name.replace(":", "_"), part.mesh, as_answer(part), folder, True)


def given(options: argparse.Namespace, folder: Path) -> Iterator[Case]:
    """Take the meshes that were named."""
    for path in options.mesh:
        mesh = quadrics.read(path)
        truth = None if options.truth is None else divided(options.truth, mesh)
        yield from variants(path.stem, mesh, truth, folder, options.noisy)


def variants(
    name: str, mesh: quadrics.Mesh, truth: Answer | None, folder: Path, noisy: bool
) -> Iterator[Case]:
    """Write a mesh, clean and noisy, as binary PLY: CGAL does not weld STL."""
    for variant in ("clean", "noisy") if noisy else ("clean",):
        shown = mesh if variant == "clean" else synth.noise(mesh, sigma=SIGMA, ratio=RATIO)
        path = folder / f"{name}-{mesh.face_count}-{variant}.ply"
        shown.save(path)
        yield Case(name, variant, path, mesh.face_count, truth)


def divided(folder: Path, mesh: quadrics.Mesh) -> Answer | None:
    """Know the truth of a mesh whose faces are those of a part, divided in order."""
    truth = as_answer(folder)
    times, rest = divmod(mesh.face_count, len(truth.labels))
    labels = np.repeat(truth.labels, times)
    return None if rest else replace(truth, labels=labels, mesh=mesh)


def installed() -> dict[str, str]:
    """Name the rivals of this repository that were built."""
    cgal = f"{PEER} {{}} {{mesh}} "
    rivals = {
        "cgal ransac": "--epsilon {epsilon} --normal 0.8 --min-points {least}",
        "cgal vsa": "--regions 40",
        "cgal region-growing": "--epsilon {epsilon} --normal 0.8 --min-points {least}",
    }
    made = {name: cgal.replace("{}", name.split()[1]) + what for name, what in rivals.items()}
    return made if PEER.exists() else {}


def runs(case: Case, run: int, folder: Path, rivals: dict[str, str]) -> Iterator[dict[str, object]]:
    """Run ours with one and two threads, then the rivals."""
    out = folder / "out"
    command = [sys.executable, "-m", "quadrics", "segment", str(case.path), "-o", str(out)]
    for threads in (1, 2):
        ours = measured([*command, "--quiet", "--overwrite", "--threads", str(threads)])
        document = json.loads((out / "segmentation.json").read_text(encoding="utf-8"))
        ours["regions"] = len(document["regions"])
        ours["stages"] = json.dumps({k: round(v, 3) for k, v in document["timing"].items()})
        if case.truth is not None and case.truth.mesh is not None:
            found = judge(as_answer(out), case.truth, case.truth.mesh)
            ours["f1"] = round(found.f1, 3)
        yield shown(case, run, f"quadrics, threads {threads}", ours)
    known = {
        "mesh": str(case.path),
        "out": str(folder / "theirs"),
        "epsilon": EPSILON[case.variant],
        "least": str(max(1, round(LEAST * case.faces))),
    }
    for name, rival in rivals.items():
        theirs = measured([word.format(**known) for word in shlex.split(rival)])
        told = json.loads(str(theirs.pop("printed")))
        theirs["regions"] = told.get("regions", told.get("shapes"))
        yield shown(case, run, name, theirs)


def measured(command: list[str]) -> dict[str, object]:
    """Run a program and measure it as a whole."""
    started = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.PIPE)
    printed = process.stdout.read() if process.stdout else b""
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(f"{' '.join(command)} failed")
    return {
        "wall_s": round(time.perf_counter() - started, 3),
        "cpu_s": round(usage.ru_utime + usage.ru_stime, 3),
        "peak_mb": round(usage.ru_maxrss / 1024),
        "printed": printed.decode(),
    }


def shown(case: Case, run: int, program: str, row: dict[str, object]) -> dict[str, object]:
    """Complete a row, and print it."""
    row.pop("printed", None)
    about = {"program": program, "mesh": case.name, "faces": case.faces}
    whole = {**about, "variant": case.variant, "run": run, **row}
    print("  ".join(f"{whole.get(column, '')}" for column in COLUMNS[:-1]), flush=True)
    return whole


def machine() -> str:
    """Describe the machine, without its name."""
    info = Path("/proc/cpuinfo")
    lines = info.read_text().splitlines() if info.exists() else []
    model = next((line.split(":")[1].strip() for line in lines if "model name" in line), "")
    commit = ["git", "-C", str(HERE), "rev-parse", "--short", "HEAD"]
    at = subprocess.run(commit, capture_output=True, text=True, check=False).stdout.strip()
    cores = os.cpu_count()
    return f"{platform.system()} {platform.machine()}, {model}, {cores} cores, commit {at}"


if __name__ == "__main__":
    main()
