"""Writes binary PLY; reading is the core's."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from quadrics.picture import region_colours

if TYPE_CHECKING:
    from quadrics.mesh import Mesh
    from quadrics.result import Result


Column: TypeAlias = tuple[str, str] | tuple[str, str, int]


def write_mesh(path: Path, mesh: Mesh) -> None:
    """Write vertices and triangles."""
    _write(path, mesh, [], [], [])


def write_coloured(path: Path, result: Result) -> None:
    """Write the triangles with the colour of their region and its number as `label`."""
    labels = result.triangle_labels
    names = ["uchar red", "uchar green", "uchar blue", "int label"]
    fields: list[Column] = [("colour", "u1", 3), ("label", "<i4")]
    _write(path, result.mesh, names, fields, [region_colours(result)[labels], labels])


def _write(
    path: Path,
    mesh: Mesh,
    names: list[str],
    fields: list[Column],
    columns: list[NDArray[np.generic]],
) -> None:
    # Single precision where it says the same, for the many programs that read nothing else.
    single = mesh.vertices.astype("<f4")
    exact = bool((single == mesh.vertices).all())
    faces = np.zeros(len(mesh.faces), [("count", "u1"), ("corners", "<i4", 3), *fields])
    faces["count"], faces["corners"] = 3, mesh.faces
    for field, column in zip(fields, columns, strict=True):
        faces[field[0]] = column
    kind = "float" if exact else "double"
    lines = ["ply", "format binary_little_endian 1.0", "comment written by quadrics"]
    lines += [f"element vertex {len(mesh.vertices)}", *(f"property {kind} {c}" for c in "xyz")]
    lines += [f"element face {len(faces)}", "property list uchar int vertex_indices"]
    lines += [*(f"property {name}" for name in names), "end_header", ""]
    with path.open("wb") as file:
        file.write("\n".join(lines).encode("ascii"))
        file.write((single if exact else mesh.vertices.astype("<f8")).tobytes())
        file.write(faces.tobytes())
