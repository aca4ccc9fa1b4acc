"""The recognised surfaces as a table for people."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from quadrics.surfaces import AnalyticSurface

if TYPE_CHECKING:
    from quadrics.result import Dimension, Region, Relation, Result

#: Longer tables scroll away; the rest is in segmentation.json.
ROWS = 60
HEADINGS = ("region", "type", "dimensions", "side", "rms", "max", "area", "faces")
#: Words to the left, numbers to the right.
LEFT = (False, True, True, True, False, False, False, False)
RELATION_HEADINGS = ("relation", "regions", "value", "before", "after")
RELATION_LEFT = (True, True, False, False, False)
DIMENSION_HEADINGS = ("dimension", "regions", "value", "±")
DIMENSION_LEFT = (True, True, False, False)
#: So many regions of a relation are named.
IDS = 8
#: Of these a person thinks as sizes; where a surface lies is in segmentation.json.
_SIZES = {
    "offset": "offset",
    "radius": "radius",
    "half_angle_deg": "half angle",
    "major_radius": "major radius",
    "minor_radius": "minor radius",
    "semi_axes": "semi-axes",
}


def print_result(result: Result, folder: Path) -> None:
    """Print the table, the repairs, and where the files are."""
    _print_relations(result)
    unit = result.units or "units of the input"
    _print_rows(HEADINGS, [_row(region) for region in result.regions], LEFT)
    print(f"\n{len(result.regions)} regions on {len(result.labels)} faces; lengths in {unit}; "
          f"noise {result.noise.position:.3g}; {result.timing['total_s']:.1f} s")  # fmt: skip
    for repair in result.repairs:
        print(f"found and handled: {repair.detail}")
    print(f"results in {folder}, picture in {folder / 'segmentation.png'}")


def _print_relations(result: Result) -> None:
    """Print what holds between the surfaces, how far the free fits were from it, and distances."""
    shown = [relation for relation in result.relations if relation.status == "accepted"]
    _print_rows(RELATION_HEADINGS, [_relation_row(r) for r in shown], RELATION_LEFT)
    counts = [
        f"{count} {status}"
        for status in ("implied", "refused")
        if (count := sum(r.status == status for r in result.relations))
    ]
    if counts:
        print(f"... {' and '.join(counts)}, with reasons in segmentation.json")
    between = [d for d in result.dimensions if d.rounded or d.kind in ("distance", "angle")]
    _print_rows(DIMENSION_HEADINGS, [_dimension_row(d) for d in between], DIMENSION_LEFT)


def _print_rows(
    headings: tuple[str, ...], rows: list[tuple[str, ...]], left: tuple[bool, ...]
) -> None:
    """Print a table and how much of it is not shown; nothing where there are no rows."""
    if rows:
        print()
        for line in _aligned([headings, *rows[:ROWS]], left):
            print(line)
        if len(rows) > ROWS:
            print(f"... and {len(rows) - ROWS} more in segmentation.json")


def _relation_row(relation: Relation) -> tuple[str, ...]:
    unit = "°" if relation.residual_unit == "deg" else ""
    return (
        relation.kind.replace("_", " "),
        _named(relation.regions),
        "" if relation.value is None else f"{relation.value:.5g}{unit}",
        f"{relation.residual_before:.2g}{unit}",
        f"{relation.residual_after:.0e}{unit}",
    )


def _dimension_row(dimension: Dimension) -> tuple[str, ...]:
    unit = "°" if dimension.kind in ("half_angle", "angle") else ""
    return (
        dimension.kind.replace("_", " "),
        _named(dimension.regions),
        f"{dimension.value:.5g}{unit}",
        "rounded" if dimension.rounded else f"{dimension.uncertainty:.1g}{unit}",
    )


def _named(regions: Sequence[int | tuple[int, int]]) -> str:
    """Name the first regions, or pairs of them."""
    ids = ["-".join(map(str, r)) if isinstance(r, tuple) else str(r) for r in regions[:IDS]]
    more = [f"and {len(regions) - IDS} more"] if len(regions) > IDS else []
    return " ".join([*ids, *more])


def dimensions(region: Region) -> str:
    """Sizes of a surface, with their standard deviations where those are known."""
    surface = region.surface
    if not isinstance(surface, AnalyticSurface):
        return ""
    parts = []
    for name, value in surface.parameters.items():
        if name in _SIZES:
            values = value if isinstance(value, list) else [value]
            text = " x ".join(f"{number:.5g}" for number in values)
            degrees = "°" if name.endswith("_deg") else ""
            sigma = region.uncertainty.get(name)
            spread = "" if sigma is None else f" ± {sigma:.1g}"
            parts.append(f"{_SIZES[name]} {text}{spread}{degrees}")
    return ", ".join(parts)


def _row(region: Region) -> tuple[str, ...]:
    return (
        str(region.id),
        region.surface.type.replace("_", " "),
        dimensions(region),
        region.side,
        "" if region.rms is None else f"{region.rms:.3g}",
        "" if region.max_deviation is None else f"{region.max_deviation:.3g}",
        f"{region.area:.5g}",
        str(region.faces),
    )


def _aligned(rows: list[tuple[str, ...]], left: tuple[bool, ...]) -> list[str]:
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [
        "  ".join(
            cell.ljust(width) if words else cell.rjust(width)
            for cell, width, words in zip(row, widths, left, strict=True)
        ).rstrip()
        for row in rows
    ]
