"""The main job: a mesh goes in, regions with their surfaces come out."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import asdict, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from quadrics import _core
from quadrics.constraints import for_core
from quadrics.errors import OptionError
from quadrics.mesh import Mesh, MeshLike, as_mesh, located
from quadrics.options import Options
from quadrics.result import Result, result_from


def segment(
    source: MeshLike,
    options: Options | None = None,
    *,
    initial_labels: ArrayLike | None = None,
    units: str | None = None,
    progress: Callable[[str, float], object] | None = None,
    **changes: Any,
) -> Result:
    """Divide a mesh into regions and recognise the surface of each.

    Parameters
    ----------
    source : path, Mesh, (vertices, faces), or a trimesh, PyVista, meshio or Open3D mesh
        See `as_mesh`.
    options : Options, optional
        All options; the defaults where not given.
    initial_labels : (m,) int, optional
        A region for every face of the input, from which the loop starts instead of detecting.
    units : str, optional
        Length unit of the mesh, noted in the result; nothing is converted.
    progress : callable, optional
        Called as `progress(stage, fraction)`, at most fifty times a second. What it raises
        stops the run and comes out here; returning False stops it with KeyboardInterrupt.
    **changes
        Any field of `Options` by its name: `regions=12`, `preset="paper"`, `seed=1`.

    Raises
    ------
    InputError
        If there is no usable mesh.
    OptionError
        If an option, or the start, does not fit.

    Examples
    --------
    >>> result = segment("scan.stl", regions=12)  # doctest: +SKIP
    >>> result.save("scan/")  # doctest: +SKIP
    """
    options = replace(options or Options(), **changes)
    mesh = as_mesh(source)
    started = time.perf_counter()
    start = None if initial_labels is None else _start(mesh, initial_labels)
    with located(mesh):
        values = {**asdict(options), "constraints": for_core(options.constraints)}
        found = _core.segment(mesh.vertices, mesh.faces, values, start, progress)
    # Reading is a part of what the user waits for, whoever called it.
    seconds = mesh.source.read_s + time.perf_counter() - started
    return result_from(found, mesh, options, units, seconds)


def _start(mesh: Mesh, labels: ArrayLike) -> NDArray[np.uint32]:
    """Labels of the input's faces as labels of the triangles."""
    array = np.asarray(labels)
    if array.shape != (mesh.face_count,):
        wanted = f"the input has {mesh.face_count} faces"
        raise OptionError(f"initial labels have the shape {array.shape}, but {wanted}")
    if not np.issubdtype(array.dtype, np.integer):
        raise OptionError(f"initial labels are {array.dtype}: whole numbers are needed")
    if array.size and array.min() < 0:
        face = int(np.argmax(array < 0))
        raise OptionError(f"initial label of face {face} is {array[face]}: count from 0")
    _, compact = np.unique(array, return_inverse=True)
    of_triangle = compact if mesh.parent is None else compact[mesh.parent]
    return np.ascontiguousarray(of_triangle, dtype=np.uint32)
