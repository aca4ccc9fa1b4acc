"""What a user may choose; the mirror of `Options` in the Rust core (a test compares them)."""

from __future__ import annotations

import os
from dataclasses import dataclass
from math import inf
from typing import Any, Literal

from quadrics.errors import OptionError


@dataclass(frozen=True)
class Options:
    """All options of a segmentation; every one is also an option of the command line.

    Relative lengths refer to the *size*: the longest side of the bounding box.

    Parameters
    ----------
    method : {"quadrics", "vsa", "qsf", "hfp", "ransac"}
        Ours, as the preset says, or one to compare it with: variational shape approximation by
        planes, quadric surface fitting from random seeds, hierarchical fitting of primitives (these
        three need the number of regions), or the detection of the paper without its loop.
    preset : {"default", "paper"}
        Method of ours: the best that we know, or section 4 of the paper to the letter.
    regions : int or None
        Number of regions to end with (the paper's kappa); found from the data when not given.
    constraints : bool, dict or path
        Whether relations between the surfaces (parallel, coaxial, ...) are sought and imposed; or
        also what is known about them, see `quadrics.constraints`.
    seed : int
        Seed of every random choice: the same seed gives the same result.
    threads : int
        Threads to use, 0 for all cores; the result does not depend on it.
    coarse : {"auto", "on", "off"}
        Whether surfaces are sought on a coarser mesh, whose surfaces the faces then choose among:
        of its own accord from 100,000 faces where the noise is above a third of an edge or the
        mesh is made of flat facets of several faces, and always from two million.
    max_edge : float
        Longest edge after subdivision (paper, 4.1), as a fraction of the size; inf for none.
    alpha : float
        Least cosine between the normal of a face and that of the shape (paper, 5.1).
    epsilon : float
        Largest distance of a face from a detected shape (paper, 5.1), as a fraction of the size.
    tau : int
        Fewest faces of a detected shape (paper, 5.1).
    beta : float
        Weight of the normal term (paper, eq. 2), as a squared fraction of the size.
    seeds : {"region", "triangle"}
        What a region grows from (paper, 4.3(1)).
    seed_candidates : int
        How many neighbourhoods compete to be the seed region (paper, m of 4.3(1)).
    seed_fraction : float
        Faces of a seed region over faces of its region (paper, 4.3(1)).
    planarity : float
        A region of smaller planarity (paper, eq. 4) is a plane.
    merge_angle_deg : float
        Adjacent planes within this angle merge (paper, 4.3(3)), in degrees.
    insertion_threshold : float or None
        A region above this area-averaged error is split (paper, 4.3(4)); off when not given.
    max_iterations : int
        Most rounds of the loop.
    convergence : float
        The loop ends when the energy changes by less than this fraction.
    """

    method: Literal["quadrics", "vsa", "qsf", "hfp", "ransac"] = "quadrics"
    preset: Literal["default", "paper"] = "default"
    regions: int | None = None
    constraints: bool | dict[str, Any] | str | os.PathLike[str] = True
    seed: int = 0
    threads: int = 0
    coarse: Literal["auto", "on", "off"] = "auto"
    max_edge: float = 0.03
    alpha: float = 0.9
    epsilon: float = 0.02
    tau: int = 100
    beta: float = 1e-3
    seeds: Literal["region", "triangle"] = "region"
    seed_candidates: int = 10
    seed_fraction: float = 0.1
    planarity: float = 1e-6
    merge_angle_deg: float = 5.0
    insertion_threshold: float | None = None
    max_iterations: int = 50
    convergence: float = 1e-4

    def __post_init__(self) -> None:
        """Refuse what cannot be meant."""
        for name, choices in CHOICES.items():
            if (value := getattr(self, name)) not in choices:
                raise OptionError(f"{name} is {value!r}: choose {' or '.join(choices)}")
        if not isinstance(self.constraints, bool):
            from quadrics.constraints import as_constraints

            object.__setattr__(self, "constraints", as_constraints(self.constraints))
        for name, (low, high) in _RANGES.items():
            value = getattr(self, name)
            if value is None and name in _OPTIONAL:
                continue
            whole = name in WHOLE
            number = isinstance(value, int if whole else int | float)
            # A comparison with NaN is false, so NaN is refused too.
            if isinstance(value, bool) or not number or not low <= value <= high:
                kind = "a whole number" if whole else "a number"
                raise OptionError(
                    f"{name} is {value!r}: it must be {kind} from {low:g} to {high:g}"
                )


_OPTIONAL = ("regions", "insertion_threshold")
#: Fields that are one of a few words.
CHOICES = {
    "method": ("quadrics", "vsa", "qsf", "hfp", "ransac"),
    "preset": ("default", "paper"),
    "coarse": ("auto", "on", "off"),
    "seeds": ("region", "triangle"),
}
#: Fields that are whole numbers.
WHOLE = ("regions", "seed", "threads", "tau", "seed_candidates", "max_iterations")
#: Least and greatest value of every number.
_RANGES: dict[str, tuple[float, float]] = {
    "regions": (1, 2**31 - 1),
    "seed": (0, 2**63 - 1),
    "threads": (0, 4096),
    "max_edge": (1e-4, inf),
    "alpha": (-1, 1),
    "epsilon": (0, 1),
    "tau": (1, 2**31 - 1),
    "beta": (0, inf),
    "seed_candidates": (1, 2**31 - 1),
    "seed_fraction": (0, 1),
    "planarity": (0, 1),
    "merge_angle_deg": (0, 90),
    "insertion_threshold": (0, inf),
    "max_iterations": (0, 2**31 - 1),
    "convergence": (0, 1),
}
