"""Mechanical parts with known surfaces, noise as the paper adds it, and simulated scans."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quadrics import _core
from quadrics.errors import OptionError
from quadrics.mesh import Mesh, MeshLike, as_mesh, located
from quadrics.surfaces import FreeForm, Surface, surface_from


@dataclass(frozen=True, eq=False, repr=False)
class Part:
    """A mesh of which everything is known; lengths in millimetres.

    `labels` holds the region of every face, `surfaces` the surface of every region.
    """

    mesh: Mesh
    labels: NDArray[np.int32]
    surfaces: tuple[Surface, ...]

    def __repr__(self) -> str:
        return f"Part(faces={len(self.labels)}, regions={len(self.surfaces)})"


@dataclass(frozen=True)
class Scanner:
    """What a scanner does to a part; lengths are fractions of the longest side of the part.

    Parameters
    ----------
    faces : int
        Triangles, about.
    waviness : float
        Standard deviation of the errors that neighbouring points share.
    wavelength : float
        Correlation length of those.
    jitter : float
        Standard deviation of the error that every vertex has on its own.
    density : float
        Relative variation of the distance between vertices.
    holes : (int, int)
        Fewest and most holes.
    hole_radius : (float, float)
        Least and greatest radius of a hole.
    """

    faces: int = 50_000
    waviness: float = 0.001
    wavelength: float = 0.06
    jitter: float = 0.0005
    density: float = 0.15
    holes: tuple[int, int] = (2, 4)
    hole_radius: tuple[float, float] = (0.02, 0.05)


def names() -> list[str]:
    """Names that `part` knows; `plate:N` is a plate of N bores."""
    return _core.part_names()


def part(name: str = "demo", faces: int = 20_000) -> Part:
    """Make the part of that name with about `faces` faces of one size.

    Raises
    ------
    OptionError
        If there is no such part, or if its surfaces need more faces than that.

    Examples
    --------
    >>> part("shaft", 5_000).mesh.size > 0
    True
    """
    if faces < 1:
        raise OptionError(f"faces is {faces}: give a number from 1")
    return _part_from(_core.part(name, faces))


def scan(
    part: Part,
    scanner: Scanner | None = None,
    *,
    seed: int = 0,
    progress: Callable[[str, float], object] | None = None,
) -> Part:
    """Simulate a scan of a part.

    Triangles cross the edges of the part, errors are correlated, and there are holes. Regions
    are numbered anew: a region that a hole cuts in two is two.

    Examples
    --------
    >>> scan(part("shaft", 5_000), Scanner(faces=5_000), seed=1).mesh.face_count > 2_500
    True
    """
    mesh, labels = part.mesh, part.labels.astype(np.uint32)
    surfaces = [surface._flat() for surface in part.surfaces if not isinstance(surface, FreeForm)]
    how = asdict(scanner or Scanner())
    return _part_from(
        _core.scan(mesh.vertices, mesh.faces, labels, surfaces, how, _seed(seed), progress)
    )


def noise(
    source: MeshLike,
    *,
    sigma: float = 0.01,
    ratio: float = 0.9,
    gaussian: bool = False,
    seed: int = 0,
) -> Mesh:
    """Add the noise of the paper: v + sigma omega n_v, omega uniform in [-1, 1] (eq. 5).

    Parameters
    ----------
    source : path, Mesh, (vertices, faces), or another library's mesh
        See `as_mesh`. Faces and their order stay.
    sigma : float
        Largest displacement, as a fraction of the longest side of the bounding box.
    ratio : float
        Share of the vertices that move, from 0 to 1.
    gaussian : bool
        Omega is Gaussian with standard deviation 1, as in section 5.5 of the paper.
    seed : int
        Seed of every draw.
    """
    if not 0 <= sigma < np.inf:
        raise OptionError(f"sigma is {sigma}: give a number from 0")
    if not 0 <= ratio <= 1:
        raise OptionError(f"ratio is {ratio}: give a number from 0 to 1")
    mesh = as_mesh(source)
    with located(mesh):
        moved = _core.noise(mesh.vertices, mesh.faces, sigma, ratio, gaussian, _seed(seed))
    return replace(mesh, vertices=moved)


def _part_from(found: Mapping[str, Any]) -> Part:
    surfaces = tuple(surface_from(values) for values in found["surfaces"])
    mesh = Mesh(found["positions"], found["faces"])
    return Part(mesh, found["labels"].astype(np.int32), surfaces)


def _seed(seed: int) -> int:
    if not 0 <= seed < 2**63:
        raise OptionError(f"seed is {seed}: give a whole number from 0")
    return seed
