"""Whole programs from start to end, ours and rivals in turn: time, memory, accuracy, a row a run.

python benchmarks/whole.py --faces 10000 100000 1000000 --record benchmarks/record/NAME.csv
python benchmarks/whole.py --mesh part.ply noisy.ply --runs 5

Ours runs with one and with two threads, with all that it writes. Seconds are those of a wall clock
and of the processor (user and system): on a busy machine only the latter mean something.
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import platform
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import quadrics
from quadrics import synth

HERE = Path(__file__).resolve().parent
PEER = HERE / "peers" / "cgal"
COLUMNS = ["program", "mesh", "faces", "variant", "run", "wall_s", "cpu_s", "peak_mb"]
COLUMNS += ["regions", "f1", "stages"]
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
    truth: synth.Part | None = None


def main() -> None:
    """Run everything that was asked for."""
    options = parse()
    with tempfile.TemporaryDirectory() as folder:
        cases = list(generated(options, Path(folder))) + list(given(options))
        rows = [row for run in range(options.runs) for c in cases for row in runs(c, run, folder)]
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
    parser.add_argument("--part", default="demo", help="of `quadrics.synth`")
    parser.add_argument("--mesh", type=Path, nargs="*", default=[], help="meshes without a truth")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--record", type=Path, help="CSV file for all rows")
    return parser.parse_args()


def generated(options: argparse.Namespace, folder: Path) -> Iterator[Case]:
    """Make the part in every size, clean and noisy, as binary PLY: CGAL does not weld STL."""
    for faces in options.faces:
        part = synth.part(options.part, faces)
        noisy = synth.noise(part.mesh, sigma=SIGMA, ratio=RATIO)
        for variant, mesh in (("clean", part.mesh), ("noisy", noisy)):
            path = folder / f"{options.part}-{faces}-{variant}.ply"
            mesh.save(path)
            yield Case(options.part, variant, path, mesh.face_count, part)


def given(options: argparse.Namespace) -> Iterator[Case]:
    """Take the meshes that were named."""
    for path in options.mesh:
        variant = "noisy" if "noisy" in path.name else "clean"
        yield Case(path.stem, variant, path, quadrics.read(path).face_count)


def runs(case: Case, run: int, folder: str) -> Iterator[dict[str, object]]:
    """Run ours with one and two threads, then the rivals that are installed."""
    out = Path(folder) / "out"
    command = [sys.executable, "-m", "quadrics", "segment", str(case.path), "-o", str(out)]
    for threads in (1, 2):
        ours = measured([*command, "--quiet", "--overwrite", "--threads", str(threads)])
        document = json.loads((out / "segmentation.json").read_text(encoding="utf-8"))
        ours["regions"] = len(document["regions"])
        ours["stages"] = json.dumps({k: round(v, 3) for k, v in document["timing"].items()})
        if case.truth is not None:
            ours["f1"] = round(quadrics.evaluate(out, case.truth).f1, 3)
        yield shown(case, run, f"quadrics, threads {threads}", ours)
    if not PEER.exists():
        return
    epsilon = "0.001" if case.variant == "clean" else "0.005"
    least = str(max(1, round(LEAST * case.faces)))
    for name, arguments in {
        "ransac": ["--epsilon", epsilon, "--normal", "0.8", "--min-points", least],
        "vsa": ["--regions", "40"],
    }.items():
        theirs = measured([str(PEER), name, str(case.path), *arguments])
        theirs["regions"] = json.loads(str(theirs.pop("printed")))["regions"]
        yield shown(case, run, f"cgal {name}", theirs)


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
