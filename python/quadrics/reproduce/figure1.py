"""Figure 1: fewer regions with an increasing minimal shape size."""

from __future__ import annotations

from quadrics.picture import plain_view, region_view
from quadrics.reproduce.data import Data
from quadrics.reproduce.section import Note, Pictures, Section, Table
from quadrics.run import segment

#: tau, and the number of regions that the paper found.
TAU = ((50, 28), (100, 28), (200, 22), (500, 19))


def make(data: Data) -> Section:
    """Sweep tau."""
    model = data.model("part")
    rows, views = [], [("input", plain_view(model.mesh))]
    for tau, theirs in TAU:
        result = segment(model.mesh, preset="paper", tau=tau)
        count = len(result.regions)
        rows.append((str(tau), str(count), f"{min(result.energy):.3e}", str(theirs)))
        views.append((f"tau = {tau}: {count} regions", region_view(result)))
    table = Table(("tau", "regions", "error", "the paper's regions"), rows)
    return Section("Figure 1: minimal shape size", [table, Pictures(views), Note(model.caption)])
