"""Table 3: time at the paper's number of regions."""

from __future__ import annotations

from quadrics.reproduce.data import Data
from quadrics.reproduce.paper import TABLE3
from quadrics.reproduce.section import Note, Section, Table
from quadrics.reproduce.timing import timed


def make(data: Data) -> Section:
    """Run both presets on every model."""
    rows = []
    for name, (thousands, regions, seconds) in TABLE3.items():
        model = data.model(name)
        paper = timed(model.mesh, preset="paper", regions=regions)
        default = timed(model.mesh, regions=regions)
        faces = model.mesh.face_count
        theirs = seconds / thousands * 1e3
        times = paper.method_wall, default.wall, paper.method_seconds, default.seconds
        per_face = [time / faces * 1e6 for time in times]
        kind = "" if data.has(name) else " (stand-in)"
        rows.append(
            (
                name + kind, f"{faces / 1000:.1f}", str(regions), f"{times[0]:.2f}",
                f"{paper.wall:.2f}", f"{times[1]:.2f}", f"{seconds:.2f}", f"{thousands:g}",
                f"{per_face[0]:.1f}", f"{per_face[1]:.1f}", f"{theirs:.1f}",
                *(f"{each / theirs:.2f}" for each in per_face),
            )
        )  # fmt: skip
    headings = (
        "model", "faces (k)", "regions", "preset=paper (s)", "its whole run (s)", "default (s)",
        "the paper (s)", "its faces (k)", "preset=paper (us a face)", "default (us a face)",
        "the paper (us a face)", "ratio, preset=paper", "ratio, default",
        "the same of the processor, preset=paper", "default",
    )  # fmt: skip
    words = (
        "preset=paper: subdivision, start and loop, the paper's own stations; the whole run adds "
        "repair, noise, types and dimensions. default: whole run. Seconds are those of the clock, "
        "with all cores; the paper's machine is a 3.6 GHz i7-4790 of four. A ratio is our time per "
        "face over the paper's; the last two are of processor time, which other programs on the "
        "machine change less."
    )
    return Section("Table 3: time", [Table(headings, rows), Note(words)])
