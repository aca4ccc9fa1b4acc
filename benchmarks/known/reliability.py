"""Whether a confidence means what it says: share of right regions against it.

python benchmarks/known/reliability.py runs.jsonl --record benchmarks/record/reliability.csv \
    --plot docs/images/reliability.svg

The lines come from `judged.py`. Right is what counts for F1: overlap, type and surface.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

import rows

from quadrics.reproduce.plot import Curve, plot

#: Regions above it are called sure.
SURE = 0.9
BINS = [0.0, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.99, 1.0]
COLUMNS = ["set", "variant", "above", "up_to", "regions", "mean_confidence", "right"]


def main() -> None:
    """Print and write the tables."""
    parser = rows.parser(__doc__)
    parser.add_argument("--plot", type=Path, help="SVG file")
    options = parser.parse_args()
    runs = rows.read(options.runs)
    lines = table(runs)
    rows.show(lines, COLUMNS)
    rows.record(options.record, lines, COLUMNS)
    if options.plot:
        options.plot.write_text(drawing(runs) + "\n", encoding="utf-8")


def table(runs: Sequence[dict]) -> list[dict[str, object]]:
    """Count all regions and the sure ones by set and variant, then all by confidence."""
    lines = []
    for key in dict.fromkeys((run["set"], run["variant"]) for run in runs):
        own = regions(run for run in runs if (run["set"], run["variant"]) == key)
        lines += [line(*key, own, low, 1.0) for low in (-1.0, SURE)]
    every = regions(runs)
    lines += [line("all", "all", every, low, 1.0) for low in (-1.0, SURE)]
    return [line for line in lines if line["regions"]] + by_confidence(every)


def by_confidence(every: Sequence[dict]) -> list[dict[str, object]]:
    """Count the regions of every bin that has some."""
    bounds = zip([-1.0, *BINS[1:-1]], BINS[1:], strict=True)
    lines = [line("all", "all", every, low, high) for low, high in bounds]
    return [line for line in lines if line["regions"]]


def regions(runs: Iterable[dict]) -> list[dict]:
    """All regions of some runs."""
    return [region for run in runs for region in run["regions"]]


def line(
    group: str, variant: str, every: Sequence[dict], low: float, high: float
) -> dict[str, object]:
    """Count the regions of a range of confidence."""
    own = [region for region in every if low < region["confidence"] <= high]
    count = max(len(own), 1)
    mean = sum(region["confidence"] for region in own) / count
    right = sum(region["hit"] for region in own) / count
    return {
        "set": group, "variant": variant, "above": max(low, 0.0), "up_to": high,
        "regions": len(own), "mean_confidence": round(mean, 3), "right": round(right, 3),
    }  # fmt: skip


def drawing(runs: Sequence[dict]) -> str:
    """Share of right regions by mean confidence, for every variant."""
    curves = []
    for variant in ["all", *dict.fromkeys(run["variant"] for run in runs)]:
        own = regions(run for run in runs if variant in ("all", run["variant"]))
        bins = by_confidence(own)
        x = [row["mean_confidence"] for row in bins]
        curves.append(Curve(variant, x, [row["right"] for row in bins]))
    curves.append(Curve("what it says", [0, 1], [0, 1], dashed=True))
    svg = plot(curves, "confidence", "share of right regions")
    return svg.replace("<svg ", '<svg xmlns="http://www.w3.org/2000/svg" ', 1)


if __name__ == "__main__":
    main()
