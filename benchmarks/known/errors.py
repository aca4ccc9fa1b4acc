"""Errors of the parameters beside what the noise allows: medians over parts, a row a variant.

python benchmarks/known/errors.py runs.jsonl --record benchmarks/record/errors.csv

The lines come from `judged.py`; a part counts once, by the median over its recognised regions.
"""

from __future__ import annotations

import argparse
import csv
import json
from pathlib import Path
from statistics import mean, median

COLUMNS = ["set", "variant", "runs", "f1", "hd", "ce", "axis_deg", "radius_percent", "rms_percent"]


def main() -> None:
    """Print and write the table."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("runs", type=Path, nargs="+", help="lines of judged.py")
    parser.add_argument("--record", type=Path, help="CSV file")
    options = parser.parse_args()
    runs = [json.loads(line) for path in options.runs for line in path.open(encoding="utf-8")]
    groups: dict[tuple[str, str], list[dict]] = {}
    for run in runs:
        groups.setdefault((run["set"], run["variant"]), []).append(run)
    rows = [row(*key, own) for key, own in groups.items()]
    for one in rows:
        print("  ".join(f"{one[key]:>9}" for key in COLUMNS))
    if options.record:
        with options.record.open("w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)


def row(group: str, variant: str, runs: list[dict]) -> dict[str, object]:
    """Means of the measures, medians over parts of the errors."""

    def of_parts(name: str) -> float | str:
        own = [run["errors"][name]["median"] for run in runs if name in run["errors"]]
        return float(f"{median(own):.3g}") if own else ""

    percent = {
        f"{name}_percent": 100 * value if isinstance(value := of_parts(name), float) else value
        for name in ("radius", "rms")
    }
    measures = {key: round(mean(run[key] for run in runs), 4) for key in ("f1", "hd", "ce")}
    about = {"set": group, "variant": variant, "runs": len(runs)}
    percent = {key: float(f"{value:.3g}") for key, value in percent.items() if value != ""}
    return (
        dict.fromkeys(COLUMNS, "") | about | measures | percent | {"axis_deg": of_parts("axis_deg")}
    )


if __name__ == "__main__":
    main()
