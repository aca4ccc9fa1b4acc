"""Noise off a mesh whose surfaces are known, and how far two meshes are apart."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from quadrics import _core
from quadrics.answer import AnswerLike, as_answer
from quadrics.errors import OptionError
from quadrics.mesh import Mesh, MeshLike, as_mesh, located
from quadrics.run import segment


def denoise(
    source: MeshLike, segmentation: AnswerLike | None = None, *, sigma: float | None = None
) -> Mesh:
    """Move the vertices of a mesh onto the surfaces that were recognised in it.

    A vertex inside a region goes to its surface, one between two regions to the curve where their
    surfaces meet, one between three to their point. No vertex moves further than four standard
    deviations of the noise, nor off what its neighbours allow; no face turns over, free-form
    regions become smooth.

    Parameters
    ----------
    source : path, Mesh, (vertices, faces), or another library's mesh
        See `as_mesh`. Faces and their order stay.
    segmentation : Result, Part, or folder of a result or a truth, optional
        Of the same mesh; made with the defaults of `segment` when not given.
    sigma : float, optional
        Standard deviation of the noise across the surface, in the unit of the mesh; what the
        segmentation says when not given.

    Raises
    ------
    OptionError
        If the segmentation is not of this mesh, or knows no noise and `sigma` is not given.

    Examples
    --------
    >>> from quadrics import synth
    >>> part = synth.part("shaft", 5_000)
    >>> noisy = synth.noise(part.mesh, sigma=0.002)
    >>> clean = denoise(noisy, part, sigma=0.1)
    >>> deviation(clean, part.mesh).mean < deviation(noisy, part.mesh).mean / 3
    True
    """
    mesh = as_mesh(source)
    answer = as_answer(segment(mesh) if segmentation is None else segmentation)
    sigma = answer.noise if sigma is None else sigma
    if sigma is None:
        raise OptionError("the segmentation says nothing of the noise: give sigma")
    surfaces = [flat for _, flat, _ in answer.rows]
    with located(mesh):
        moved = _core.denoise(mesh.vertices, mesh.faces, answer.labels, surfaces, sigma)
    return replace(mesh, vertices=moved)


@dataclass(frozen=True, eq=False)
class Deviation:
    """Distances between two meshes, in their unit, sampled as Metro does.

    `hausdorff` is the largest distance of a point of either mesh from the other, `mean` the mean
    over both surfaces by area, `of_vertex` (n,) the distance of every vertex of the first mesh.
    """

    hausdorff: float
    mean: float
    of_vertex: NDArray[np.float64]


def deviation(source: MeshLike, reference: MeshLike) -> Deviation:
    """Measure how far two meshes are apart.

    Examples
    --------
    >>> triangle = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    >>> lifted = [[0, 0, 2], [1, 0, 2], [0, 1, 2]]
    >>> deviation((triangle, [[0, 1, 2]]), (lifted, [[0, 1, 2]])).hausdorff
    2.0
    """
    one, other = as_mesh(source), as_mesh(reference)
    return Deviation(**_core.deviation(one.vertices, one.faces, other.vertices, other.faces))
