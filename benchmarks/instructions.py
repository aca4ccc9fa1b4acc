"""Instructions of the main stages, which no busy machine disturbs, against those on record.

python benchmarks/instructions.py            # fails where a stage takes more than the margin allows
python benchmarks/instructions.py --record   # after a change that is worth its price
"""

from __future__ import annotations

import csv
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
RECORD = ROOT / "benchmarks" / "record" / "instructions.csv"
STAGES = ["read", "repair", "order", "coarsen", "segment", "segment_noisy"]
#: Another compiler moves counts by some per cent; what a careless change costs is more.
MARGIN = 0.15
#: As `cargo test` has built it already.
BUILD = ["cargo", "build", "--quiet", "--locked", "--package", "quadrics"]
BUILD += ["--example", "stages", "--profile", "test"]


def main() -> int:
    """Count, compare, and say what became slower."""
    if shutil.which("valgrind") is None:
        print("instructions: valgrind is not installed, nothing compared")
        return 0
    subprocess.run(BUILD, cwd=ROOT, check=True)
    setup = count("nothing")
    counts = {stage: (count(stage) - setup) / 1e6 for stage in STAGES}
    if sys.argv[1:] == ["--record"]:
        rows = [["stage", "million_instructions"], *([s, round(n)] for s, n in counts.items())]
        with RECORD.open("w", newline="", encoding="utf-8") as file:
            csv.writer(file, lineterminator="\n").writerows(rows)
        return 0
    with RECORD.open(newline="", encoding="utf-8") as file:
        known = {row["stage"]: float(row["million_instructions"]) for row in csv.DictReader(file)}
    slower = [stage for stage in STAGES if counts[stage] > (1 + MARGIN) * known[stage]]
    for stage in STAGES:
        ratio = counts[stage] / known[stage] - 1
        mark = "  slower" if stage in slower else ""
        print(f"{stage:<15} {counts[stage]:8.0f} M instructions  {ratio:+.1%}{mark}")
    if slower:
        what = f"more than {MARGIN:.0%} above {RECORD.relative_to(ROOT)}"
        print(f"instructions: {', '.join(slower)} {what}; --record if that is worth it")
    return int(bool(slower))


def count(stage: str) -> int:
    """Instructions of one stage with all that it begins with, on a simulated processor."""
    program = ROOT / "target" / "debug" / "examples" / "stages"
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, stage]
    alone = {**os.environ, "RAYON_NUM_THREADS": "1"}
    done = subprocess.run(command, env=alone, capture_output=True, text=True, check=True)
    found = re.search(r"Collected : (\d+)", done.stderr)
    if found is None:
        raise SystemExit(f"instructions: valgrind counted nothing: {done.stderr[-300:]}")
    return int(found[1])


if __name__ == "__main__":
    sys.exit(main())
