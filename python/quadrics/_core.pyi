from collections.abc import Callable
from typing import Any, TypeAlias, TypedDict

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "__version__",
    "coefficients",
    "default_options",
    "default_scanner",
    "denoise",
    "deviation",
    "distance",
    "encode_png",
    "evaluate",
    "inspect",
    "noise",
    "normal",
    "paint",
    "part",
    "part_names",
    "project",
    "read",
    "scan",
    "see",
    "segment",
    "write",
    "write_segmentation",
]

__version__: str

class _Segmentation(TypedDict):
    labels: NDArray[np.uint32]
    regions: list[dict[str, Any]]
    relations: list[dict[str, Any]]
    dimensions: list[dict[str, Any]]
    noise: tuple[float, float]
    repairs: list[tuple[str, int, str]]
    energy: list[float]
    timing: list[tuple[str, float]]

class _Loaded(TypedDict):
    positions: NDArray[np.float64]
    faces: NDArray[np.uint32]
    parent: NDArray[np.uint32] | None
    face_count: int
    units: str | None
    repairs: list[tuple[str, int, str]]

def read(extension: str, bytes: bytes, open: Callable[[str], bytes | None]) -> _Loaded: ...
def inspect(positions: NDArray[np.float64], faces: NDArray[np.uint32]) -> dict[str, Any]: ...
def write(extension: str, positions: NDArray[np.float64], faces: NDArray[np.uint32]) -> bytes: ...
def write_segmentation(
    positions: NDArray[np.float64],
    faces: NDArray[np.uint32],
    labels: NDArray[np.int32],
    colours: NDArray[np.uint8],
) -> bytes: ...
def segment(
    positions: NDArray[np.float64],
    faces: NDArray[np.uint32],
    options: dict[str, Any],
    initial_labels: NDArray[np.uint32] | None = None,
    progress: Callable[[str, float], object] | None = None,
) -> _Segmentation: ...

_Flat: TypeAlias = tuple[str, list[float]]
_Side: TypeAlias = tuple[
    NDArray[np.int32], list[tuple[str, _Flat | None, tuple[str, _Flat] | None]]
]

def evaluate(
    positions: NDArray[np.float64],
    faces: NDArray[np.uint32],
    found: _Side,
    truth: _Side,
    tolerance: float,
    beta: float,
) -> dict[str, Any]: ...
def denoise(
    positions: NDArray[np.float64],
    faces: NDArray[np.uint32],
    labels: NDArray[np.int32],
    surfaces: list[_Flat | None],
    sigma: float,
) -> NDArray[np.float64]: ...
def deviation(
    positions: NDArray[np.float64],
    faces: NDArray[np.uint32],
    reference_positions: NDArray[np.float64],
    reference_faces: NDArray[np.uint32],
) -> dict[str, Any]: ...
def part_names() -> list[str]: ...
def part(name: str, faces: int) -> dict[str, Any]: ...
def default_scanner() -> dict[str, Any]: ...
def scan(
    positions: NDArray[np.float64],
    faces: NDArray[np.uint32],
    labels: NDArray[np.uint32],
    surfaces: list[tuple[str, list[float]]],
    scanner: dict[str, Any],
    seed: int,
    progress: Callable[[str, float], object] | None,
) -> dict[str, Any]: ...
def noise(
    positions: NDArray[np.float64],
    faces: NDArray[np.uint32],
    sigma: float,
    ratio: float,
    gaussian: bool,
    seed: int,
) -> NDArray[np.float64]: ...
def default_options() -> dict[str, Any]: ...
def distance(
    kind: str, numbers: list[float], points: NDArray[np.float64]
) -> NDArray[np.float64]: ...
def normal(kind: str, numbers: list[float], points: NDArray[np.float64]) -> NDArray[np.float64]: ...
def project(
    kind: str, numbers: list[float], points: NDArray[np.float64]
) -> NDArray[np.float64]: ...
def coefficients(kind: str, numbers: list[float]) -> list[float] | None: ...
def see(
    positions: NDArray[np.float64],
    faces: NDArray[np.uint32],
    toward_eye: tuple[float, float, float],
    width: int,
    height: int,
) -> tuple[NDArray[np.uint32], NDArray[np.uint32]]: ...
def paint(
    samples: NDArray[np.uint32],
    colours: NDArray[np.uint8],
    normals: NDArray[np.float64],
    labels: NDArray[np.int32],
    toward_eye: tuple[float, float, float],
    width: int,
    height: int,
) -> NDArray[np.uint8]: ...
def encode_png(pixels: NDArray[np.uint8]) -> bytes: ...
