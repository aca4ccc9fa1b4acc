"""A segmentation as it is judged: from a result, a part, or a folder."""

from __future__ import annotations

import io
import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from quadrics.errors import InputError
from quadrics.files import load, read_bytes
from quadrics.mesh import Mesh
from quadrics.options import Options
from quadrics.result import Result
from quadrics.surfaces import FreeForm, Plane, surface_from
from quadrics.synth import Part

Flat: TypeAlias = tuple[str, list[float]]
#: Type, surface, and what a free-form region may as well be called.
Row: TypeAlias = tuple[str, Flat | None, tuple[str, Flat] | None]
#: What `evaluate` takes on either side.
AnswerLike: TypeAlias = "Result | Part | str | os.PathLike[str]"


@dataclass(frozen=True, eq=False)
class Answer:
    """Labels of triangles (places in `rows`, -1 for none), regions with their numbers, and a mesh.

    `beta` is the weight of the normals (eq. 2) that the segmentation was made with, `noise` the
    standard deviation that it found, if it looked for it.
    """

    labels: NDArray[np.int32]
    ids: list[int]
    rows: list[Row]
    mesh: Mesh | None
    beta: float
    noise: float | None


def as_answer(source: AnswerLike) -> Answer:
    """Take labels and surfaces out of a result, a part, a folder of a result or of a truth.

    Raises
    ------
    InputError
        If the folder holds neither, or what it holds cannot be read.
    """
    if isinstance(source, Part):
        documents = [_document(number, s) for number, s in enumerate(source.surfaces)]
        return _answer(source.labels, documents, source.mesh, Options.beta, None)
    if isinstance(source, Result):
        documents = [_document(region.id, region.surface) for region in source.regions]
        return _answer(
            source.triangle_labels,
            documents,
            source.mesh,
            source.options.beta,
            source.noise.position,
        )
    return _from_folder(Path(source))


def _document(number: int, surface: Any) -> dict[str, Any]:
    parameters = {} if isinstance(surface, FreeForm) else surface.parameters
    return {"id": number, "type": surface.type, "parameters": parameters}


def _from_folder(folder: Path) -> Answer:
    truth = (folder / "truth.json").is_file()
    path = folder / ("truth.json" if truth else "segmentation.json")
    if not path.is_file():
        raise InputError(f"{folder}: holds no segmentation.json and no truth.json")
    try:
        document = json.loads(read_bytes(path))
        regions = [dict(region, id=int(region["id"])) for region in document["regions"]]
    except (ValueError, KeyError, TypeError):
        raise InputError(f"{path}: is not what `quadrics segment` writes") from None
    try:
        labels = np.load(io.BytesIO(read_bytes(folder / "labels.npy")), allow_pickle=False)
        labels = labels.astype(np.int64, casting="same_kind")
    except (ValueError, TypeError, EOFError):
        raise InputError(f"{folder / 'labels.npy'}: is no .npy file of whole numbers") from None
    beside = folder / ("mesh.ply" if truth else "segmentation.ply")
    beta = document.get("options", {}).get("beta", Options.beta)
    noise = document.get("noise", {}).get("position")
    mesh = load(beside) if beside.is_file() else None
    return _answer(labels, regions, mesh, float(beta), noise)


def _answer(
    labels: NDArray[Any],
    documents: list[dict[str, Any]],
    mesh: Mesh | None,
    beta: float,
    noise: float | None,
) -> Answer:
    named = {document["id"]: document for document in documents}
    # A label without a region is a region without a surface.
    unnamed = [n for n in np.unique(labels[labels >= 0]).tolist() if n not in named]
    ids = [*named, *unnamed]
    places = np.full(max([*ids, -1]) + 2, -1, np.int32)
    places[ids] = np.arange(len(ids), dtype=np.int32)
    # Negative labels take the last place, which stays -1.
    places = places[np.where(labels < 0, -1, labels)]
    return Answer(places, ids, [_row(named.get(n, {})) for n in ids], mesh, beta, noise)


def _row(region: Mapping[str, Any]) -> Row:
    kind = str(region.get("type", "none"))
    parameters = region.get("parameters") or {}
    near = region.get("near")
    flat_near = None if near is None else _flat(str(near["type"]), near["parameters"])
    other = None if near is None or flat_near is None else (str(near["type"]), flat_near)
    return kind, _flat(kind, parameters), other


def _flat(kind: str, parameters: Mapping[str, Any]) -> Flat | None:
    """Numbers as the core takes a surface; None where none can be made of them."""
    for candidate in (kind, "quadric"):
        try:
            surface = surface_from({"type": candidate, **parameters})
            if isinstance(surface, FreeForm):
                return None
            name, numbers = surface._flat()
        except (TypeError, ValueError, AttributeError):
            continue
        if isinstance(surface, Plane) and (length := float(np.linalg.norm(numbers[:3]))) > 0:
            numbers = [number / length for number in numbers]
        sizes = {"plane": 4, "sphere": 4, "cylinder": 7, "cone": 7, "torus": 9, "quadric": 10}
        if len(numbers) == sizes[name] and bool(np.isfinite(numbers).all()):
            return name, numbers
    return None
