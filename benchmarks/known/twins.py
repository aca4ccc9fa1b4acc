"""Real meshes under noise against themselves without: HD and CE of the two segmentations.

python benchmarks/known/twins.py DATA/real --record benchmarks/record/twins.csv

NAME_noisy.ply is NAME.ply with its vertices moved; nothing is told of either.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import rows

import quadrics
from quadrics.answer import as_answer
from quadrics.evaluation import judge

COLUMNS = ["mesh", "faces", "regions", "regions_noisy", "hd", "ce"]


def main() -> None:
    """Compare every pair of a folder."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--record", type=Path, help="CSV file")
    options = parser.parse_args()
    table = [compare(noisy) for noisy in sorted(options.folder.glob("*_noisy.ply"))]
    rows.record(options.record, table, COLUMNS)


def compare(noisy: Path) -> dict[str, object]:
    """Segment both; the one without noise is taken for the truth."""
    name = noisy.stem.removesuffix("_noisy")
    mesh = quadrics.read(noisy)
    clean = quadrics.segment(noisy.with_name(f"{name}.ply"))
    found = quadrics.segment(mesh)
    seen = judge(as_answer(found), as_answer(clean), mesh)
    counts = {"regions": len(clean.regions), "regions_noisy": len(found.regions)}
    measures = {"hd": round(seen.hamming, 4), "ce": round(seen.consistency, 4)}
    row = {"mesh": name, "faces": mesh.face_count} | counts | measures
    print("  ".join(f"{key} {value}" for key, value in row.items()), flush=True)
    return row


if __name__ == "__main__":
    main()
