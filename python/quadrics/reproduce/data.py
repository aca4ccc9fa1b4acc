"""Meshes for the experiments: the user's, or generated parts of like size."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from quadrics import synth
from quadrics.answer import Answer, as_answer
from quadrics.errors import InputError
from quadrics.mesh import Mesh, read

#: For every model of the paper a generated part and its number of faces, where no file is given.
STAND_INS: dict[str, tuple[str, int]] = {
    "bone": ("open", 30_000),
    "chess": ("open", 8_500),
    "sample": ("plate:15", 26_700),
    "dynamo": ("draft", 92_500),
    "joint": ("shaft", 20_000),
    "fandisk": ("draft", 13_800),
    "twelve": ("plate:6", 9_200),
    "rolling_stage": ("plate:17", 40_000),
    "oil_pump": ("demo", 25_000),
    "carter": ("plate", 25_000),
    "blade": ("shaft", 25_000),
    "part": ("demo", 20_000),
    "part4": ("demo", 143_000),
    "master_cylinder": ("shaft", 100_000),
    "grayloc": ("plate:33", 69_500),
    "shell": ("open", 20_000),
}
#: Parts with known surfaces: names of folders, and of generated parts.
WITH_TRUTH = ("ball_joint", "bracket", "pipe_flange", "stepped_shaft", "valve_body")
GENERATED = ("shaft", "plate", "draft", "open", "demo")
FACES = 12_000


@dataclass(frozen=True, eq=False)
class Model:
    """A mesh under the paper's name for it; `note` says what it is."""

    name: str
    mesh: Mesh
    note: str

    @property
    def caption(self) -> str:
        """Say what stands for which of the paper's models."""
        return f"{self.name}: {self.note}."


@dataclass(frozen=True, eq=False)
class Known:
    """A part whose surfaces are known."""

    name: str
    mesh: Mesh
    truth: Answer


class Data:
    """Where meshes come from: a folder with real/NAME.ply and parts/NAME/, or the generator."""

    def __init__(self, folder: Path | None) -> None:
        """Look at the folder.

        Raises
        ------
        InputError
            If it is not there.
        """
        if folder is not None and not folder.is_dir():
            raise InputError(f"{folder}: no such folder")
        self._folder = folder

    def model(self, name: str) -> Model:
        """Give a model of the paper, or its stand-in."""
        for path in self._paths(name):
            if path.is_file():
                return Model(name, read(path), f"the file {path.name}")
        part, faces = STAND_INS[name]
        made = synth.part(part, faces)
        note = (
            f"stand-in: the generated part '{part}', {made.mesh.face_count} faces, "
            f"{len(made.surfaces)} surfaces"
        )
        return Model(name, made.mesh, note)

    def has(self, name: str) -> bool:
        """Whether there is a file of that name."""
        return any(path.is_file() for path in self._paths(name))

    def known(self) -> list[Known]:
        """Give five parts whose surfaces are known."""
        if self._folder is not None and all(self._truth(name).is_dir() for name in WITH_TRUTH):
            return [
                Known(name, read(self._truth(name) / "mesh.ply"), as_answer(self._truth(name)))
                for name in WITH_TRUTH
            ]
        parts = [(name, synth.part(name, FACES)) for name in GENERATED]
        return [Known(name, part.mesh, as_answer(part)) for name, part in parts]

    def _paths(self, name: str) -> list[Path]:
        if self._folder is None:
            return []
        return [self._folder / "real" / f"{name}.ply", self._folder / f"{name}.ply"]

    def _truth(self, name: str) -> Path:
        return Path(self._folder or ".") / "parts" / name
