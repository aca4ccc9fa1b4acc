"""Errors of the parameters beside what the noise allows: medians over parts, a row a variant.

python benchmarks/known/errors.py runs.jsonl --record benchmarks/record/errors.csv

The lines come from `judged.py`; a part counts once, by the median over its recognised regions.
"""

from __future__ import annotations

from statistics import mean, median

import rows

COLUMNS = ["set", "variant", "runs", "f1", "hd", "ce", "axis_deg", "radius_percent", "rms_percent"]


def main() -> None:
    """Print and write the table."""
    options = rows.parser(__doc__).parse_args()
    groups: dict[tuple[str, str], list[dict]] = {}
    for run in rows.read(options.runs):
        groups.setdefault((run["set"], run["variant"]), []).append(run)
    table = [row(*key, own) for key, own in groups.items()]
    rows.show(table, COLUMNS)
    rows.record(options.record, table, COLUMNS)


def row(group: str, variant: str, runs: list[dict]) -> dict[str, object]:
    """Means of the measures, medians over parts of the errors."""

    def of_parts(name: str, scale: float = 1.0) -> float | str:
        own = [run["errors"][name]["median"] for run in runs if name in run["errors"]]
        return float(f"{scale * median(own):.3g}") if own else ""

    measures = {key: round(mean(run[key] for run in runs), 4) for key in ("f1", "hd", "ce")}
    return {
        "set": group, "variant": variant, "runs": len(runs), **measures,
        "axis_deg": of_parts("axis_deg"),
        "radius_percent": of_parts("radius", 100.0),
        "rms_percent": of_parts("rms", 100.0),
    }  # fmt: skip


if __name__ == "__main__":
    main()
