"""What several test files use."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

import meshes

Run = Callable[..., "subprocess.CompletedProcess[str]"]


@pytest.fixture
def part(tmp_path: Path) -> Path:
    """A binary STL of a box."""
    path = tmp_path / "part.stl"
    path.write_bytes(meshes.stl(*meshes.box()))
    return path


@pytest.fixture
def program(tmp_path: Path) -> Run:
    """The program as a user starts it, in a folder of its own."""

    def run(*arguments: object, timeout: float = 120) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "quadrics", *map(str, arguments)]
        return subprocess.run(
            command, cwd=tmp_path, capture_output=True, text=True, timeout=timeout, check=False
        )

    return run
