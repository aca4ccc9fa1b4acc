"""Medians of the runs that `whole.py` recorded, as a table; rivals with our share of their time.

python benchmarks/medians.py benchmarks/record/valve_body.csv
"""

from __future__ import annotations

import argparse
import csv
from collections import defaultdict
from pathlib import Path
from statistics import median

#: Ours as the user gets it.
OURS = "quadrics, threads 2"


def main() -> None:
    """Print a table for wall clock and one for processor time."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("record", type=Path, help="CSV file that whole.py wrote")
    lines = parser.parse_args().record.read_text(encoding="utf-8").splitlines()
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    for column, what in (("wall_s", "wall"), ("cpu_s", "processor")):
        print(table(rows, column, what), end="\n\n")


def table(rows: list[dict[str, str]], column: str, what: str) -> str:
    """Tell the seconds of every program on every mesh."""
    times: dict[tuple[str, str, str], dict[str, list[float]]] = defaultdict(
        lambda: defaultdict(list)
    )
    regions = {}
    for row in rows:
        mesh = (row["mesh"], row["faces"], row["variant"])
        times[mesh][row["program"]].append(float(row[column]))
        regions[mesh, row["program"]] = row["regions"] + (f", F1 {row['f1']}" if row["f1"] else "")
    programs = list(dict.fromkeys(row["program"] for row in rows))
    head = f"| mesh | {' | '.join(programs)} |"
    lines = [f"Seconds, {what}, medians.", "", head, "| --- " * (len(programs) + 1) + "|"]
    for mesh, seconds in times.items():
        ours = median(seconds[OURS])
        cells = []
        for program in programs:
            if not seconds[program]:
                cells.append("")
                continue
            own = median(seconds[program])
            share = "" if program.startswith("quadrics") else f"; ours {ours / own:.2f} of it"
            cells.append(f"{own:.2f} ({regions[mesh, program]}{share})")
        lines.append(f"| {', '.join(mesh)} | {' | '.join(cells)} |")
    return "\n".join(lines)


if __name__ == "__main__":
    main()
