"""How good a segmentation is: against the truth, or against another result."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from quadrics import _core
from quadrics.answer import Answer, AnswerLike, as_answer
from quadrics.errors import InputError, OptionError
from quadrics.mesh import Mesh


@dataclass(frozen=True)
class Match:
    """A found region and the true region that it shares most area with, one to one.

    `rms` is the distance of the true surface from the found one as a fraction of the size; None
    where there is no surface. `errors` are those of the parameters, where the type is right.
    """

    found: int
    true: int
    iou: float
    type_found: str
    type_true: str
    rms: float | None
    hit: bool
    hit_geometry: bool
    errors: dict[str, float]


@dataclass(frozen=True)
class Evaluation:
    """All measures of one segmentation against another, `true`, of the same mesh.

    `hamming` and `consistency` are HD and CE (paper, eq. 6 and 7), by area: 0 is best, and CE is 0
    for any refinement too. `rand_index`, `adjusted_rand_index` count pairs of faces; `mean_iou` is
    the mean over true regions. A region is recognised (`precision`, `recall`, `f1`) if it overlaps
    a true one by an IoU of 0.6, its surface is close enough, and its type is right; `..._geometry`
    leaves the type aside. `energy` is eq. 1 of the found surfaces in the unit cube, over all faces
    but the share `without_surface` of the area. `missed` are the true regions not recognised.
    """

    hamming: float
    consistency: float
    rand_index: float
    adjusted_rand_index: float
    mean_iou: float
    precision: float
    recall: float
    f1: float
    precision_geometry: float
    recall_geometry: float
    f1_geometry: float
    energy: float
    without_surface: float
    unlabelled_area: float
    regions_found: int
    regions_true: int
    matches: tuple[Match, ...]
    missed: tuple[int, ...]

    @property
    def parameter_errors(self) -> dict[str, dict[str, dict[str, float]]]:
        """Median and 95th percentile of every error over the recognised regions, by true type.

        Angles are in degrees, `radius` is relative, `position` and `rms` are fractions of the size.
        """
        table: dict[str, dict[str, list[float]]] = {}
        for match in self.matches:
            if match.hit:
                own = {} if match.rms is None else {"rms": match.rms}
                for name, value in (own | match.errors).items():
                    for kind in (match.type_true, "all"):
                        table.setdefault(kind, {}).setdefault(name, []).append(value)
        return {kind: _summaries(rows.items()) for kind, rows in sorted(table.items())}

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain values, for JSON."""
        return {**asdict(self), "parameter_errors": self.parameter_errors}


def evaluate(result: AnswerLike, truth: AnswerLike, *, tolerance: float = 0.01) -> Evaluation:
    """Judge a segmentation.

    Parameters
    ----------
    result : Result, Part, or the folder that `quadrics segment` wrote
    truth : the same, or a folder with mesh.ply, labels.npy and truth.json
        A truth knows the region of every face and its surface.
    tolerance : float
        Largest RMS distance of a right surface from the true one, as a fraction of the size.

    Raises
    ------
    InputError
        If a folder cannot be read.
    OptionError
        If the two are not of the same mesh.

    Examples
    --------
    >>> from quadrics import synth
    >>> part = synth.part("shaft", 5_000)
    >>> evaluate(part, part).f1
    1.0
    """
    if not 0 < tolerance < np.inf:
        raise OptionError(f"tolerance is {tolerance}: give a fraction above 0")
    found, true = as_answer(result), as_answer(truth)
    mesh = true.mesh or found.mesh
    if mesh is None:
        raise InputError(f"{truth}: there is no mesh beside the labels")
    return judge(found, true, mesh, tolerance)


def judge(found: Answer, true: Answer, mesh: Mesh, tolerance: float = 0.01) -> Evaluation:
    """Judge an answer on a mesh, which may have noise that neither side's mesh has."""
    one, other = (found.labels, found.rows), (true.labels, true.rows)
    seen = _core.evaluate(mesh.vertices, mesh.faces, one, other, tolerance, found.beta)
    return _evaluation(seen, found, true)


def _evaluation(seen: dict[str, Any], found: Answer, true: Answer) -> Evaluation:
    count_found, count_true = seen.pop("regions")
    verdicts = seen.pop("verdicts")
    matches = tuple(
        Match(**{**v, "found": found.ids[v["found"]], "true": true.ids[v["true"]],
                 "errors": dict(v["errors"])})
        for v in verdicts
    )  # fmt: skip
    for suffix in ("", "_geometry"):
        hits = seen.pop(f"hits{suffix}")
        seen[f"precision{suffix}"] = hits / count_found if count_found else 0.0
        seen[f"recall{suffix}"] = hits / count_true if count_true else 0.0
        both = count_found + count_true
        seen[f"f1{suffix}"] = 2 * hits / both if both else 0.0
    right = {match.true for match in matches if match.hit}
    missed = tuple(number for number in true.ids if number not in right)
    return Evaluation(
        **seen,
        regions_found=count_found,
        regions_true=count_true,
        matches=matches,
        missed=missed,
    )


def _summaries(rows: Iterable[tuple[str, list[float]]]) -> dict[str, dict[str, float]]:
    return {
        name: {
            "median": float(np.median(values)),
            "p95": float(np.percentile(values, 95)),
            "count": len(values),
        }
        for name, values in rows
    }
