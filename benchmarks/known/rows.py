"""What the programs of this folder share: lines of `judged.py` in, a table out."""

from __future__ import annotations

import argparse
import csv
import json
from collections.abc import Mapping, Sequence
from pathlib import Path


def parser(description: str) -> argparse.ArgumentParser:
    """Give the options that every table has."""
    options = argparse.ArgumentParser(description=description.split("\n")[0])
    options.add_argument("runs", type=Path, nargs="+", help="lines of judged.py")
    options.add_argument("--record", type=Path, help="CSV file")
    return options


def read(paths: Sequence[Path]) -> list[dict]:
    """Read the runs of some files."""
    return [json.loads(line) for path in paths for line in path.open(encoding="utf-8")]


def show(rows: Sequence[Mapping[str, object]], columns: Sequence[str]) -> None:
    """Print a line a row."""
    for row in rows:
        print("  ".join(f"{row[key]:>9}" for key in columns))


def record(path: Path | None, rows: Sequence[Mapping[str, object]], columns: Sequence[str]) -> None:
    """Write a CSV file, where one was asked for."""
    if path is None:
        return
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
