"""How much the random start matters: spread over seeds of every shape and variant.

python benchmarks/known/spread.py runs.jsonl --record benchmarks/record/spread.csv

The lines come from `judged.py --seeds 0 1 2 ...`.
"""

from __future__ import annotations

import rows

COLUMNS = ["set", "name", "variant", "seeds", "regions_least", "regions_most"]
COLUMNS += ["f1_least", "f1_most", "hd_least", "hd_most"]
#: Seeds agree when F1 differs by no more and the numbers of regions are equal.
AGREES = 0.01


def main() -> None:
    """Print the shapes whose seeds disagree, and write all."""
    options = rows.parser(__doc__).parse_args()
    groups: dict[tuple[str, str, str], list[dict]] = {}
    for run in rows.read(options.runs):
        groups.setdefault((run["set"], run["name"], run["variant"]), []).append(run)
    table = [row(*key, runs) for key, runs in groups.items()]
    rows.show([one for one in table if not agrees(one)], COLUMNS)
    for group, variant in dict.fromkeys((one["set"], one["variant"]) for one in table):
        own = [one for one in table if (one["set"], one["variant"]) == (group, variant)]
        f1 = [one["f1_most"] - one["f1_least"] for one in own]
        hd = [one["hd_most"] - one["hd_least"] for one in own]
        print(
            f"{group} {variant}: {sum(map(agrees, own))} of {len(own)} agree; "
            f"spread of F1 mean {sum(f1) / len(f1):.3f}, most {max(f1):.3f}; "
            f"of HD mean {sum(hd) / len(hd):.4f}, most {max(hd):.4f}"
        )
    rows.record(options.record, table, COLUMNS)


def row(group: str, name: str, variant: str, runs: list[dict]) -> dict:
    """Least and most over the seeds."""
    about = {"set": group, "name": name, "variant": variant, "seeds": len(runs)}
    for key, source, digits in (("regions", "found", 0), ("f1", "f1", 4), ("hd", "hd", 4)):
        values = [run[source] for run in runs]
        about[f"{key}_least"] = round(min(values), digits or None)
        about[f"{key}_most"] = round(max(values), digits or None)
    return about


def agrees(one: dict) -> bool:
    """Whether the seeds of a shape and variant agree."""
    same = one["regions_least"] == one["regions_most"]
    return same and one["f1_most"] - one["f1_least"] <= AGREES


if __name__ == "__main__":
    main()
