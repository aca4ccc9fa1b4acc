"""Recognised surfaces: parameters in the units of the input, angles in degrees.

Vectors are tuples of three floats, so that surfaces compare, hash and print as values.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any, ClassVar, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from quadrics import _core

Vector: TypeAlias = tuple[float, float, float]
Array: TypeAlias = NDArray[np.float64]


class AnalyticSurface:
    """What every surface with parameters can be asked."""

    if TYPE_CHECKING:

        @property
        def type(self) -> str:
            """Its name in the result files."""

    @property
    def parameters(self) -> dict[str, Any]:
        """Parameters by their names in the result files; vectors are lists."""
        values = {name: getattr(self, name) for name in _names(self)}
        return {name: _plain(value) for name, value in values.items() if value is not None}

    def distance(self, points: ArrayLike) -> Array:
        """Signed orthogonal distances, positive on the side of the normal.

        Parameters
        ----------
        points : (n, 3) or (3,) float
            In the length unit of the surface.

        Examples
        --------
        >>> Sphere(center=(0, 0, 0), radius=2).distance([[3, 0, 0], [0, 1, 0]])
        array([ 1., -1.])
        """
        rows, shape = _rows(points)
        return _core.distance(*self._flat(), rows).reshape(shape[:-1])

    def normal(self, points: ArrayLike) -> Array:
        """Give unit normals at the feet of points; NaN where there is no answer, as on an axis."""
        rows, shape = _rows(points)
        return _core.normal(*self._flat(), rows).reshape(shape)

    def project(self, points: ArrayLike) -> Array:
        """Nearest points of the surface; NaN where they are not unique, as from an axis.

        Examples
        --------
        >>> Plane(normal=(0, 0, 1), offset=2).project([5, 6, 7])
        array([5., 6., 2.])
        """
        rows, shape = _rows(points)
        return _core.project(*self._flat(), rows).reshape(shape)

    def quadric(self) -> Array | None:
        """Coefficients c of c . [1, x, y, z, x^2, xy, xz, y^2, yz, z^2] = 0; None for a torus."""
        found = _core.coefficients(*self._flat())
        return None if found is None else np.array(found)

    def _flat(self) -> tuple[str, list[float]]:
        # As the binding takes a surface: its type, and its numbers in the order of the fields.
        numbers = np.hstack([getattr(self, name) for name in _names(self)])
        return self.type, numbers.astype(float).tolist()

    def __repr__(self) -> str:
        shown = (f"{name}={_show(value)}" for name, value in self.parameters.items())
        return f"{type(self).__name__}({', '.join(shown)})"


@dataclass(frozen=True, repr=False, init=False)
class Plane(AnalyticSurface):
    """The points x with normal . x = offset, the normal a unit vector.

    `plane.normal(points)` is what every surface has; the parameter itself is `unit_normal`.
    """

    unit_normal: Vector
    offset: float
    type: ClassVar[str] = "plane"

    def __init__(self, normal: Vector, offset: float) -> None:
        object.__setattr__(self, "unit_normal", normal)
        object.__setattr__(self, "offset", offset)

    @property
    def parameters(self) -> dict[str, Any]:
        """Parameters by their names in the result files; vectors are lists."""
        return {"normal": list(self.unit_normal), "offset": self.offset}


@dataclass(frozen=True, repr=False)
class Sphere(AnalyticSurface):
    """The points at distance `radius` from `center`."""

    center: Vector
    radius: float
    type: ClassVar[str] = "sphere"


@dataclass(frozen=True, repr=False)
class Cylinder(AnalyticSurface):
    """A circular cylinder: `point` lies on its axis, `axis` is a unit vector."""

    point: Vector
    axis: Vector
    radius: float
    type: ClassVar[str] = "cylinder"


@dataclass(frozen=True, repr=False)
class Cone(AnalyticSurface):
    """One nappe of a circular cone; `axis` points from `apex` into it."""

    apex: Vector
    axis: Vector
    half_angle_deg: float
    type: ClassVar[str] = "cone"


@dataclass(frozen=True, repr=False)
class Torus(AnalyticSurface):
    """The points at distance `minor_radius` from a circle of `major_radius` about `axis`.

    Where `minor_radius` is the larger one the torus cuts itself, and `inner` tells of which of its
    two sheets the surface is: the one like an apple, or the one like a lemon within it (barrel
    rollers, crowned pulleys), whose points are `minor_radius` from the far side of the circle.
    """

    center: Vector
    axis: Vector
    major_radius: float
    minor_radius: float
    inner: bool = False
    type: ClassVar[str] = "torus"

    @property
    def parameters(self) -> dict[str, Any]:
        """Parameters by their names in the result files; `inner` only where it is true."""
        values = super().parameters
        return values if self.inner else {k: v for k, v in values.items() if k != "inner"}


@dataclass(frozen=True, repr=False)
class Quadric(AnalyticSurface):
    """A general quadric: c . [1, x, y, z, x^2, xy, xz, y^2, yz, z^2] = 0.

    `type` names its class (`ellipsoid`, `elliptic_cylinder`, ...). Where the class is not a type of
    its own, `type` is `quadric` and `kind` names it: `sphere`, say, for a free fit to a ball, or
    `other`. `center`, `axes` and `semi_axes` are None where the class has none.
    """

    coefficients: tuple[float, ...]
    type: str = "quadric"
    center: Vector | None = None
    axes: tuple[Vector, ...] | None = None
    semi_axes: tuple[float, ...] | None = None
    kind: str = "other"

    @property
    def parameters(self) -> dict[str, Any]:
        """Parameters by their names in the result files; vectors are lists."""
        values = super().parameters
        kind = values.pop("kind")  # `class` is a word of Python.
        return {"class": kind, **values} if self.type == "quadric" else values

    def _flat(self) -> tuple[str, list[float]]:
        return "quadric", [float(number) for number in self.coefficients]


@dataclass(frozen=True)
class FreeForm:
    """No quadric and no torus fits: such a region has a type, and nothing else."""

    type: ClassVar[str] = "freeform"


Surface: TypeAlias = Plane | Sphere | Cylinder | Cone | Torus | Quadric | FreeForm

_CLASSES: dict[str, Any] = {
    shape.type: shape for shape in (Plane, Sphere, Cylinder, Cone, Torus, FreeForm)
}


def surface_from(parameters: Mapping[str, Any]) -> Surface:
    """Make the surface of a `type` and its parameters, as result files have them."""
    values = {name: _frozen(value) for name, value in parameters.items()}
    kind = values.pop("type")
    if kind in _CLASSES:
        surface: Surface = _CLASSES[kind](**values)
        return surface
    return Quadric(type=kind, kind=values.pop("class", "other"), **values)


def _names(surface: Any) -> list[str]:
    return [field.name for field in fields(surface) if field.name != "type"]


def _rows(points: ArrayLike) -> tuple[Array, tuple[int, ...]]:
    array = np.asarray(points, dtype=np.float64)
    if array.shape[-1:] != (3,):
        raise ValueError(f"points have the shape {array.shape}: (n, 3) or (3,) is needed")
    return np.ascontiguousarray(array.reshape(-1, 3)), array.shape


def _plain(value: Any) -> Any:
    return [_plain(item) for item in value] if isinstance(value, tuple) else value


def _frozen(value: Any) -> Any:
    return tuple(_frozen(item) for item in value) if isinstance(value, list | tuple) else value


def _show(value: Any) -> str:
    if isinstance(value, list):
        return f"[{', '.join(_show(item) for item in value)}]"
    return f"{value:.6g}" if isinstance(value, float) else str(value)
