"""The whole way, on a part that we know: make it, scan it, recognise its surfaces.

    python examples/01_first_scan.py [FOLDER] [FACES]

`make demo` runs it.
"""

import sys
from pathlib import Path

import quadrics
from quadrics import synth
from quadrics.cli.progress import shown
from quadrics.cli.table import print_result

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "demo")
faces = int(sys.argv[2]) if len(sys.argv) > 2 else 40_000

# A housing on a bolted base, and what a scanner would make of it.
part = synth.part("demo", faces)
scan = synth.scan(part, seed=0)
folder.mkdir(parents=True, exist_ok=True)
scan.mesh.save(folder / "scan.ply", overwrite=True)

with shown(quiet=False) as progress:
    result = quadrics.segment(folder / "scan.ply", units="mm", progress=progress)
saved = result.save(folder / "result", overwrite=True)

print_result(result, saved)
print(f"the part has {len(part.surfaces)} surfaces; its scan is {folder / 'scan.ply'}")
