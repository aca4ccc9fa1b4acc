"""What a segmentation is: labels, regions with their surfaces, relations, and how it went."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quadrics import _core
from quadrics.labels import labels_of_input
from quadrics.mesh import Mesh
from quadrics.options import Options
from quadrics.surfaces import FreeForm, Surface, surface_from


@dataclass(frozen=True)
class Noise:
    """Noise of the input, estimated from the mesh alone (standard deviations)."""

    position: float
    normal_deg: float


@dataclass(frozen=True)
class Repair:
    """Something that was wrong with the input and was mended."""

    kind: str
    count: int
    detail: str


@dataclass(frozen=True)
class Region:
    """A connected set of faces on one surface; of a scan in shreds, faces that are near each other.

    Lengths are in the unit of the input, angles in degrees. `rms` and `max_deviation` are
    orthogonal distances of the faces' vertices from the surface; None for a free-form region.
    `side` is `outside` where the material is behind the surface (a shaft), `inside` in a bore.
    """

    id: int
    surface: Surface
    side: str
    confidence: float
    faces: int
    area: float
    rms: float | None
    max_deviation: float | None
    mean_normal_deviation_deg: float | None
    uncertainty: dict[str, float] = field(default_factory=dict)
    neighbours: tuple[int, ...] = ()
    runner_up: str | None = None


@dataclass(frozen=True)
class Relation:
    """A geometric relation between regions, and whether it was imposed."""

    kind: str
    regions: tuple[int, ...] | tuple[tuple[int, int], ...]
    status: str
    residual_before: float
    residual_after: float
    residual_unit: str
    reason: str
    value: float | None = None
    parameters: dict[str, Any] | None = None


@dataclass(frozen=True)
class Dimension:
    """A dimension of a drawing: of every region named, or between the two.

    Lengths are in the unit of the input, angles in degrees; `uncertainty` is a standard deviation
    under the relations.
    """

    kind: str
    regions: tuple[int, ...]
    value: float
    uncertainty: float
    rounded: bool = False


@dataclass(frozen=True, eq=False, repr=False)
class Result:
    """The outcome of `segment`.

    `labels` holds the id of a region for every face of the input, in its order.
    """

    labels: NDArray[np.int32]
    regions: tuple[Region, ...]
    relations: tuple[Relation, ...]
    dimensions: tuple[Dimension, ...]
    noise: Noise
    repairs: tuple[Repair, ...]
    energy: tuple[float, ...]
    timing: dict[str, float]
    options: Options
    mesh: Mesh
    units: str | None = None

    def __repr__(self) -> str:
        return f"Result(regions={len(self.regions)}, faces={len(self.labels)})"

    @property
    def triangle_labels(self) -> NDArray[np.int32]:
        """The label of every triangle of `mesh`: of the face that it was cut from."""
        parent = self.mesh.parent
        return self.labels if parent is None else self.labels[parent]

    def to_dict(self) -> dict[str, Any]:
        """Everything but the labels, as `segmentation.json` holds it."""
        source = self.mesh.source
        return {
            "format": "quadrics.segmentation",
            "version": 1,
            "program": {"name": "quadrics", "version": _core.__version__},
            "input": {
                "path": source.path,
                "faces": self.mesh.face_count,
                "vertices": len(self.mesh.vertices),
                "units": self.units,
                "sha256": source.sha256,
            },
            "options": {name: _number(value) for name, value in asdict(self.options).items()},
            "noise": asdict(self.noise),
            "repairs": [asdict(repair) for repair in self.repairs],
            "regions": [_region_dict(region) for region in self.regions],
            "relations": [_relation_dict(relation) for relation in self.relations],
            "dimensions": [
                {**asdict(dimension), "regions": list(dimension.regions)}
                for dimension in self.dimensions
            ],
            "energy": list(self.energy),
            "timing": self.timing,
        }

    def save(self, folder: str | os.PathLike[str], *, overwrite: bool = False) -> Path:
        """Write labels, JSON, coloured mesh and picture; all of it, or nothing.

        Parameters
        ----------
        folder : path
            Made if it is not there; must be empty unless `overwrite` is true.
        overwrite : bool
            Replace an earlier result. A folder that holds anything else is refused all the same.

        Raises
        ------
        OutputError
            If the folder cannot be written.
        """
        from quadrics.folder import save

        return save(self, Path(folder), overwrite=overwrite)


def result_from(
    found: Mapping[str, Any], mesh: Mesh, options: Options, units: str | None, seconds: float
) -> Result:
    """Turn what the core returns into what the user holds."""
    of_triangle = found["labels"].astype(np.int32)
    labels = labels_of_input(mesh, of_triangle, len(found["regions"]))
    counts: NDArray[np.int64] = np.bincount(labels, minlength=len(found["regions"]))
    repairs = (*mesh.source.repairs, *found["repairs"])
    timing = {"read_s": mesh.source.read_s, "total_s": seconds, **dict(found["timing"])}
    return Result(
        labels=labels,
        regions=tuple(_region(values, counts) for values in found["regions"]),
        relations=tuple(_relation(values) for values in found["relations"]),
        dimensions=tuple(
            Dimension(**{**values, "regions": tuple(values["regions"])})
            for values in found["dimensions"]
        ),
        noise=Noise(*found["noise"]),
        repairs=tuple(Repair(*repair) for repair in repairs),
        energy=tuple(found["energy"]),
        timing=timing,
        options=options,
        mesh=mesh,
        units=units or mesh.source.units,
    )


def _region(values: Mapping[str, Any], counts: Any) -> Region:
    changed = {
        "surface": surface_from(values["surface"]),
        "faces": int(counts[values["id"]]),
        "uncertainty": dict(values["uncertainty"]),
        "neighbours": tuple(values["neighbours"]),
    }
    return Region(**{**values, **changed})


def _relation(values: Mapping[str, Any]) -> Relation:
    regions = (
        tuple(entry) if isinstance(entry, list | tuple) else entry for entry in values["regions"]
    )
    return Relation(**{**values, "regions": tuple(regions)})


def _region_dict(region: Region) -> dict[str, Any]:
    surface = region.surface
    values: dict[str, Any] = {
        "id": region.id,
        "type": surface.type,
        "parameters": {} if isinstance(surface, FreeForm) else surface.parameters,
        "side": region.side,
        "confidence": region.confidence,
        "faces": region.faces,
        "area": region.area,
        "rms": region.rms,
        "max_deviation": region.max_deviation,
        "mean_normal_deviation_deg": region.mean_normal_deviation_deg,
        "uncertainty": region.uncertainty,
        "neighbours": list(region.neighbours),
    }
    return values if region.runner_up is None else {**values, "runner_up": region.runner_up}


def _relation_dict(relation: Relation) -> dict[str, Any]:
    values = {**asdict(relation), "regions": list(relation.regions)}
    return {name: value for name, value in values.items() if value is not None}


def _number(value: Any) -> Any:
    # JSON has no infinity; null is "no limit".
    return None if isinstance(value, float) and math.isinf(value) else value
