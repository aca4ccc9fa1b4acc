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
        times = paper.method_seconds, default.seconds
        per_face = [time / faces * 1e6 for time in times]
        theirs = seconds / thousands * 1e3
        ratios = [f"{each / theirs:.2f}" for each in per_face]
        kind = "" if data.has(name) else " (stand-in)"
        rows.append(
            (
                name + kind, f"{faces / 1000:.1f}", str(regions), f"{times[0]:.2f}",
                f"{paper.seconds:.2f}", f"{times[1]:.2f}", f"{seconds:.2f}",
                f"{thousands:g}", f"{per_face[0]:.1f}", f"{per_face[1]:.1f}", f"{theirs:.1f}",
                *ratios,
            )
        )  # fmt: skip
    headings = (
        "model", "faces (k)", "regions", "preset=paper (s)", "its whole run (s)", "default (s)",
        "the paper (s)", "its faces (k)", "preset=paper (us a face)", "default (us a face)",
        "the paper (us a face)", "ratio, preset=paper", "ratio, default",
    )  # fmt: skip
    words = (
        "preset=paper: subdivision, start and loop, the paper's own stations; the whole run adds "
        "repair, noise, types and dimensions. default: whole run. All seconds are processor time "
        "of two threads; the paper's machine is a 3.6 GHz i7-4790. A ratio is our time per face "
        "over the paper's."
    )
    return Section("Table 3: time", [Table(headings, rows), Note(words)])
