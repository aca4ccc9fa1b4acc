"""The output folder: four files that appear together, or not at all."""

from __future__ import annotations

import json
import os
import shutil
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from quadrics import _core
from quadrics.errors import OutputError

if TYPE_CHECKING:
    from quadrics.picture import Seen
    from quadrics.result import Result

FILES = ("labels.npy", "segmentation.json", "segmentation.ply", "segmentation.png")


def check(folder: Path, *, overwrite: bool) -> None:
    """Refuse a folder that cannot take the result, before minutes are spent on it."""
    try:
        held = sorted(entry.name for entry in folder.iterdir()) if folder.exists() else []
        above = next(parent for parent in folder.absolute().parents if parent.exists())
    except NotADirectoryError:
        raise OutputError(f"{folder}: is a file, not a folder; choose another -o") from None
    except OSError as error:
        raise OutputError(f"{folder}: {_reason(error)}") from None
    if not above.is_dir():
        raise OutputError(f"{folder}: {above} is a file, not a folder; choose another -o")
    if not os.access(above, os.W_OK):
        raise OutputError(f"{folder}: no permission to write in {above}")
    others = [name for name in held if name not in FILES]
    if others:
        # Replacing the folder would delete what is not ours.
        raise OutputError(f"{folder}: holds other files ({others[0]}); choose a new folder")
    if held and not overwrite:
        raise OutputError(f"{folder}: holds a result already; add --overwrite, or choose another")


def save(
    result: Result, folder: Path, *, overwrite: bool, seen: Future[Seen] | None = None
) -> Path:
    """Write the result into a new folder beside `folder`, then rename it.

    `seen` is what `picture.look` says of the result's mesh, where somebody has asked already.
    """
    check(folder, overwrite=overwrite)
    folder = folder.absolute()
    partial = folder.with_name(f".{folder.name}.{os.getpid()}.partial")
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        partial.mkdir()
        try:
            _write(result, partial, seen)
            _swap(partial, folder)
        finally:
            shutil.rmtree(partial, ignore_errors=True)
    except OSError as error:
        raise OutputError(f"{folder}: {_reason(error)}") from error
    return folder


def to_json(result: Result) -> str:
    """`segmentation.json`: a line a region, so that people can read and compare it."""
    fields = (f" {json.dumps(name)}: {_value(v)}" for name, v in result.to_dict().items())
    return "{\n" + ",\n".join(fields) + "\n}\n"


def _value(value: Any) -> str:
    # A NaN is no JSON: better no file than one that other programs cannot read.
    if isinstance(value, list) and value and isinstance(value[0], dict):
        return "[\n  " + ",\n  ".join(json.dumps(v, allow_nan=False) for v in value) + "\n ]"
    return json.dumps(value, allow_nan=False)


def _write(result: Result, folder: Path, seen: Future[Seen] | None) -> None:
    from quadrics.picture import look, write_picture

    def draw() -> None:
        known = seen.result() if seen else look(result.mesh)
        write_picture(folder / "segmentation.png", result, known)

    if result.options.threads == 1:
        _write_data(result, folder)
        draw()
        return
    # Most of either is done without the interpreter's lock.
    with ThreadPoolExecutor(1) as pool:
        data = pool.submit(_write_data, result, folder)
        draw()
        data.result()


def _write_data(result: Result, folder: Path) -> None:
    from quadrics.picture import region_colours

    np.save(folder / "labels.npy", result.labels, allow_pickle=False)
    (folder / "segmentation.json").write_text(to_json(result), encoding="utf-8")
    mesh, labels = result.mesh, result.triangle_labels
    coloured = _core.write_segmentation(
        mesh.vertices, mesh.faces, labels, region_colours(result)[labels]
    )
    (folder / "segmentation.ply").write_bytes(coloured)


def _swap(new: Path, folder: Path) -> None:
    old = new.with_suffix(".old")
    try:
        if folder.exists():
            folder.rename(old)
        new.rename(folder)
    except BaseException:  # Ctrl-C between the two as well.
        if old.exists() and not folder.exists():
            old.rename(folder)
        raise
    shutil.rmtree(old, ignore_errors=True)


def _reason(error: OSError) -> str:
    return f"cannot be written: {(error.strerror or str(error)).lower()}"
