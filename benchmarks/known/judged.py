"""Runs on shapes whose surfaces are known, every region judged: a line of JSON a run.

python benchmarks/known/judged.py --data DATA --cache CACHE --out runs.jsonl
python benchmarks/known/judged.py ... --sets parts --variants clean --seeds 0 1 2 --out seeds.jsonl
python benchmarks/known/judged.py ... --given --out given.jsonl      # starts from the true labels

DATA/SET/NAME holds the clean shapes (mesh.ply, labels.npy, truth.json),
CACHE/SET/NAME/VARIANT-SEED-* their variants. The other programs of this folder read the lines.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import quadrics
from quadrics.answer import as_answer
from quadrics.evaluation import Evaluation, judge

VARIANTS = ["clean", "noise5", "noise10", "scan"]


def main() -> None:
    """Run everything that was asked for; a line is written as soon as it is known."""
    options = parse()
    with options.out.open("w", encoding="utf-8") as file:
        for folder, about in shapes(options):
            for seed in options.seeds:
                row = run(folder, seed, options) | about
                file.write(json.dumps(row) + "\n")
                file.flush()
                what = "  ".join(f"{row[key]}" for key in ("set", "name", "variant", "seed"))
                print(f"{what}  F1 {row['f1']:.3f}  HD {row['hd']:.4f}", flush=True)


def parse() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    add = parser.add_argument
    add("--data", type=Path, required=True, help="folder of the clean shapes")
    add("--cache", type=Path, required=True, help="folder of their variants")
    add("--sets", nargs="+", default=["parts", "cad"])
    add("--only", nargs="+", help="names of shapes")
    add("--variants", nargs="+", default=VARIANTS)
    add("--variant-seed", type=int, default=0)
    add("--seeds", type=int, nargs="+", default=[0], help="of the program")
    add("--given", action="store_true", help="start from the true labels")
    add("--out", type=Path, required=True, help="file of lines to write")
    return parser.parse_args()


def shapes(options: argparse.Namespace) -> Iterator[tuple[Path, dict[str, str]]]:
    """Folders of the shapes that were asked for, and what they are."""
    for variant in options.variants:
        for group in options.sets:
            for clean in sorted((options.data / group).iterdir()):
                if options.only and clean.name not in options.only:
                    continue
                about = {"set": group, "name": clean.name, "variant": variant}
                yield variant_of(clean, variant, options), about


def variant_of(clean: Path, variant: str, options: argparse.Namespace) -> Path:
    """Folder of a shape's variant."""
    if variant == "clean":
        return clean
    start = f"{variant.replace(':', '_')}-{options.variant_seed}-"
    found = sorted((options.cache / clean.parent.name / clean.name).glob(f"{start}*"))
    if not found:
        sys.exit(f"{clean.name}: no {start}* under {options.cache}: let the scoreboard make it")
    return found[-1]


def run(folder: Path, seed: int, options: argparse.Namespace) -> dict[str, object]:
    """Run on one shape and judge every region."""
    truth = as_answer(folder)
    mesh = quadrics.read(folder / "mesh.ply")
    start = truth.labels if options.given else None
    before = time.process_time()
    result = quadrics.segment(mesh, initial_labels=start, seed=seed)
    seconds = time.process_time() - before
    seen = judge(as_answer(result), truth, mesh)
    return {
        "seed": seed,
        "f1": seen.f1,
        "hd": seen.hamming,
        "ce": seen.consistency,
        "found": seen.regions_found,
        "true": seen.regions_true,
        "cpu_s": round(seconds, 2),
        "errors": seen.parameter_errors.get("all", {}),
        "regions": regions(result, seen),
    }


def regions(result: quadrics.Result, seen: Evaluation) -> list[dict[str, object]]:
    """Put what is true of every region beside what the result says of it."""
    partners = {match.found: match for match in seen.matches}
    rows = []
    for region in result.regions:
        match = partners.get(region.id)
        rows.append({
            "type": region.surface.type,
            "true_type": match.type_true if match else None,
            "confidence": region.confidence,
            "runner_up": region.runner_up,
            "faces": region.faces,
            "hit": match.hit if match else False,
            "iou": match.iou if match else 0.0,
            "rms": match.rms if match else None,
        })  # fmt: skip
    return rows


if __name__ == "__main__":
    main()
