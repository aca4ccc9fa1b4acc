"""Other libraries' meshes, by what they look like: none of the libraries is imported."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

Arrays = tuple[Any, Any]  # vertices, polygons


def _pair(source: Any) -> Arrays | None:
    if isinstance(source, tuple | list) and len(source) == 2:
        return source[0], source[1]
    return None


def _trimesh(source: Any) -> Arrays | None:
    faces = getattr(source, "faces", None)
    if hasattr(source, "vertices") and faces is not None and np.ndim(faces) == 2:
        return source.vertices, faces
    return None


def _open3d(source: Any) -> Arrays | None:
    if hasattr(source, "vertices") and hasattr(source, "triangles"):
        return np.asarray(source.vertices), np.asarray(source.triangles)
    if hasattr(source, "vertex") and hasattr(source, "triangle"):
        return source.vertex["positions"].numpy(), source.triangle["indices"].numpy()
    return None


def _pyvista(source: Any) -> Arrays | None:
    faces = getattr(source, "faces", None)
    if not hasattr(source, "points") or faces is None or np.ndim(faces) != 1:
        return None
    # VTK's flat list: how many corners, then the corners, again and again.
    flat, polygons, at = np.asarray(faces), [], 0
    while at < len(flat):
        polygons.append(flat[at + 1 : at + 1 + flat[at]])
        at += 1 + int(flat[at])
    return np.asarray(source.points), polygons


def _meshio(source: Any) -> Arrays | None:
    if not hasattr(source, "points") or not hasattr(source, "cells"):
        return None
    flat = ("triangle", "quad", "polygon")
    return source.points, [row for cell in source.cells if cell.type in flat for row in cell.data]


FOREIGN_MESHES: tuple[Callable[[Any], Arrays | None], ...] = (
    _pair,
    _trimesh,
    _open3d,
    _pyvista,
    _meshio,
)


def triangles_of(polygons: Any) -> tuple[Any, NDArray[np.uint32] | None, int]:
    """Cut polygons into fans: triangles, the polygon of each, and the number of polygons."""
    if isinstance(polygons, np.ndarray) and polygons.ndim == 2 and polygons.shape[1] == 3:
        return polygons, None, len(polygons)
    rows = [np.asarray(row) for row in _iterable(polygons)]
    if all(row.shape == (3,) for row in rows):
        return np.array(rows) if rows else np.zeros((0, 3), np.uint32), None, len(rows)
    for number, row in enumerate(rows):
        if row.ndim != 1 or len(row) < 3:
            raise ValueError(f"face {number} has {row.size} corners")
    fans = [
        (row[0], row[i], row[i + 1], number)
        for number, row in enumerate(rows)
        for i in range(1, len(row) - 1)
    ]
    table = np.array(fans)
    return table[:, :3], table[:, 3].astype(np.uint32), len(rows)


def _iterable(polygons: Any) -> Iterable[Any]:
    if np.ndim(polygons) == 0 and not hasattr(polygons, "__iter__"):
        raise TypeError(f"a {type(polygons).__name__} is no list of faces")
    return list(polygons)
