"""The recognised surfaces as a table for people."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from quadrics.surfaces import AnalyticSurface

if TYPE_CHECKING:
    from quadrics.result import Region, Relation, Result

#: Longer tables scroll away; the rest is in segmentation.json.
ROWS = 60
HEADINGS = ("region", "type", "dimensions", "side", "rms", "max", "area", "faces")
#: Words to the left, numbers to the right.
LEFT = (False, True, True, True, False, False, False, False)
RELATION_HEADINGS = ("relation", "regions", "value", "before", "after", "status")
RELATION_LEFT = (True, True, False, False, False, True)
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
    rows = [_row(region) for region in result.regions[:ROWS]]
    for line in _aligned([HEADINGS, *rows]):
        print(line)
    if len(result.regions) > ROWS:
        print(f"... and {len(result.regions) - ROWS} more in segmentation.json")
    print(f"\n{len(result.regions)} regions on {len(result.labels)} faces; lengths in {unit}; "
          f"noise {result.noise.position:.3g}; {result.timing['total_s']:.1f} s")  # fmt: skip
    for repair in result.repairs:
        print(f"found and handled: {repair.detail}")
    print(f"results in {folder}, picture in {folder / 'segmentation.png'}")


def _print_relations(result: Result) -> None:
    """Print what holds between the surfaces, and how far the free fits were from it."""
    shown = [relation for relation in result.relations if relation.status != "refused"]
    if not shown:
        return
    print()
    for line in _aligned([RELATION_HEADINGS, *map(_relation_row, shown[:ROWS])], RELATION_LEFT):
        print(line)
    if len(shown) > ROWS:
        print(f"... and {len(shown) - ROWS} more in segmentation.json")


def _relation_row(relation: Relation) -> tuple[str, ...]:
    ids = [str(number) for number in relation.regions[:IDS]]
    more = [f"and {len(relation.regions) - IDS} more"] if len(relation.regions) > IDS else []
    unit = "°" if relation.residual_unit == "deg" else ""
    return (
        relation.kind.replace("_", " "),
        " ".join([*ids, *more]),
        "" if relation.value is None else f"{relation.value:.5g}{unit}",
        f"{relation.residual_before:.2g}{unit}",
        f"{relation.residual_after:.0e}{unit}",
        relation.status,
    )


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


def _aligned(rows: list[tuple[str, ...]], left: tuple[bool, ...] = LEFT) -> list[str]:
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [
        "  ".join(
            cell.ljust(width) if words else cell.rjust(width)
            for cell, width, words in zip(row, widths, left, strict=True)
        ).rstrip()
        for row in rows
    ]
