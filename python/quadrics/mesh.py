"""Meshes: files, arrays and other libraries' meshes, all as one kind of value."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from quadrics import _core
from quadrics.errors import InputError
from quadrics.foreign import FOREIGN_MESHES, triangles_of

MeshLike: TypeAlias = Any  # a path, a Mesh, (vertices, faces), or a foreign mesh: see as_mesh


@dataclass(frozen=True)
class Source:
    """Where a mesh came from, and what was mended on the way."""

    path: str | None = None
    sha256: str | None = None
    units: str | None = None
    repairs: tuple[tuple[str, int, str], ...] = ()
    read_s: float = 0.0


@dataclass(frozen=True, eq=False, repr=False)
class Mesh:
    """Triangles, and which face of the input each of them is a part of.

    Parameters
    ----------
    vertices : (n, 3) float
        In the length unit that every result keeps.
    faces : (m, 3) int
        Rows of `vertices`, counted from 0.
    parent : (m,) int or None
        Face of the input that a triangle was cut from; None where every face is a triangle.
    face_count : int or None
        Number of faces of the input; None where every face is a triangle.

    Raises
    ------
    InputError
        If the arrays have other shapes or faces are not whole numbers.
    """

    vertices: NDArray[np.float64]
    faces: NDArray[np.uint32]
    parent: NDArray[np.uint32] | None = None
    face_count: int = -1
    source: Source = field(default_factory=Source)

    def __post_init__(self) -> None:
        """Bring the arrays into the form that the core takes."""
        vertices, faces = _vertices(self.vertices), _indices(self.faces)
        object.__setattr__(self, "vertices", vertices)
        object.__setattr__(self, "faces", faces)
        if self.parent is None:
            object.__setattr__(self, "face_count", len(faces))

    def __repr__(self) -> str:
        return f"Mesh(vertices={len(self.vertices)}, faces={self.face_count})"

    @property
    def size(self) -> float:
        """Longest side of the bounding box, in the unit of the vertices."""
        if len(self.faces) == 0:
            return 0.0
        used = self.vertices[np.unique(self.faces)]
        return float((used.max(axis=0) - used.min(axis=0)).max())

    def save(self, path: str | os.PathLike[str], *, overwrite: bool = False) -> None:
        """Write the triangles to a PLY, STL, OBJ or OFF file, by the ending of its name.

        Raises
        ------
        OutputError
            If the file is there and `overwrite` is false, or if it cannot be written.
        """
        from quadrics.files import save  # here, because it needs Mesh

        save(self, Path(path), overwrite=overwrite)

    def areas(self) -> NDArray[np.float64]:
        """Measure the triangles."""
        double = _double_normals(self.vertices, self.faces)
        area: NDArray[np.float64] = np.linalg.norm(double, axis=1) / 2
        return area

    def normals(self) -> NDArray[np.float64]:
        """Give unit normals of the triangles; zero where a triangle has no area."""
        return normals_of(self.vertices, self.faces)


def as_mesh(source: MeshLike) -> Mesh:
    """Take the mesh out of whatever the caller holds.

    Parameters
    ----------
    source : path, Mesh, (vertices, faces), or a trimesh, PyVista, meshio or Open3D mesh
        Vertices are (n, 3) float, in the length unit that every result keeps;
        faces are (m, 3) int, rows of the vertices, counted from 0, or (m, k), or a list of
        polygons.

    Raises
    ------
    InputError
        If there is no mesh in it.

    Examples
    --------
    >>> as_mesh(([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))
    Mesh(vertices=3, faces=1)
    """
    if isinstance(source, Mesh):
        return source
    if isinstance(source, str | os.PathLike):
        return read(source)
    for arrays_of in FOREIGN_MESHES:  # By duck typing: none of these libraries is imported.
        if (arrays := arrays_of(source)) is not None:
            return _from_polygons(*arrays)
    raise InputError(f"no mesh in a {type(source).__name__}: give a path or (vertices, faces)")


def read(path: str | os.PathLike[str]) -> Mesh:
    """Read a mesh file: STL, PLY, OBJ, OFF, GLB, glTF or 3MF, also compressed (.gz, .bz2, .xz).

    Raises
    ------
    InputError
        If the file cannot be read or is no mesh; the text names the file and the place.

    Examples
    --------
    >>> read("scan.stl")  # doctest: +SKIP
    Mesh(vertices=50213, faces=100422)
    """
    from quadrics.files import load  # here, because it needs Mesh

    return load(Path(path))


def _from_polygons(vertices: Any, faces: Any) -> Mesh:
    try:
        triangles, parent, count = triangles_of(faces)
    except (TypeError, ValueError) as error:
        raise InputError(f"faces must be rows of vertex indices: {error}") from None
    return Mesh(vertices, triangles, parent, count)


def _vertices(values: ArrayLike) -> NDArray[np.float64]:
    try:
        vertices = np.ascontiguousarray(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InputError(f"vertices must be numbers: {error}") from None
    if vertices.ndim != 2 or vertices.shape[1] != 3:
        raise InputError(f"vertices have the shape {vertices.shape}: (n, 3) is needed")
    return vertices


def _indices(values: ArrayLike) -> NDArray[np.uint32]:
    faces = np.asarray(values)
    if faces.size == 0:
        faces = np.zeros((0, 3), np.uint32)
    if faces.ndim != 2 or faces.shape[1] != 3:
        raise InputError(f"faces have the shape {faces.shape}: (m, 3) is needed")
    if not np.issubdtype(faces.dtype, np.integer):
        raise InputError(f"faces are {faces.dtype}: vertex indices are whole numbers")
    limit = np.iinfo(np.uint32).max
    if faces.size and (faces.min() < 0 or faces.max() > limit):
        face = int(np.nonzero(((faces < 0) | (faces > limit)).any(axis=1))[0][0])
        raise InputError(f"face {face} refers to vertices {faces[face].tolist()}: count from 0")
    return np.ascontiguousarray(faces, dtype=np.uint32)


def normals_of(vertices: NDArray[np.float64], faces: NDArray[np.uint32]) -> NDArray[np.float64]:
    """Give unit normals of some triangles; zero where one has no area."""
    double = _double_normals(vertices, faces)
    length = np.linalg.norm(double, axis=1, keepdims=True)
    unit: NDArray[np.float64] = np.zeros_like(double)
    np.divide(double, length, out=unit, where=length > 0)
    return unit


def _double_normals(
    vertices: NDArray[np.float64], faces: NDArray[np.uint32]
) -> NDArray[np.float64]:
    corners = vertices[faces]
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


def inspect(source: MeshLike) -> dict[str, Any]:
    """Look at a mesh without segmenting it: counts, sizes, faults, and what would be repaired.

    Lengths are in the unit of the mesh. `volume` is None where the mesh is not closed.

    Examples
    --------
    >>> inspect(([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))["border_edges"]
    3
    """
    mesh = as_mesh(source)
    with located(mesh):
        seen = _core.inspect(mesh.vertices, mesh.faces)
    names = ("kind", "count", "detail")
    repairs = [*mesh.source.repairs, *seen.pop("repairs")]
    head = {"path": mesh.source.path, "units": mesh.source.units, "sha256": mesh.source.sha256}
    found = [dict(zip(names, repair, strict=True)) for repair in repairs]
    return {**head, **seen, "faces": mesh.face_count, "repairs": found}


@contextmanager
def located(mesh: Mesh) -> Iterator[None]:
    """Put the path of the mesh before the text of an input error."""
    try:
        yield
    except InputError as error:
        if mesh.source.path is None:
            raise
        raise InputError(f"{mesh.source.path}: {error}") from None
