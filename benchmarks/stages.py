"""Time per stage on a generated part: what BENCHMARK.md records.

python benchmarks/stages.py [FACES] [PART]
"""

import sys
import tempfile
import time
from pathlib import Path

import quadrics
from quadrics import synth

faces = int(sys.argv[1]) if len(sys.argv) > 1 else 500_000
name = sys.argv[2] if len(sys.argv) > 2 else "demo"

with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "part.stl"
    synth.part(name, faces).mesh.save(path)
    start = time.perf_counter()
    mesh = quadrics.read(path)
    read = time.perf_counter() - start
    result = quadrics.segment(mesh)
    total = time.perf_counter() - start - read

print(f"{name}: {mesh.face_count} faces, {len(result.regions)} regions")
for stage, seconds in [("read", read), *result.timing.items(), ("all but reading", total)]:
    print(f"{stage:<16} {seconds:8.2f} s")
