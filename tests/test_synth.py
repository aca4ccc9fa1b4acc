"""The generator as Python sees it: what it says about a part is true."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest

import quadrics
from quadrics import _core, synth
from quadrics.cli.main import main
from quadrics.surfaces import AnalyticSurface


@pytest.mark.parametrize("name", synth.names())
def test_every_vertex_lies_on_the_surface_of_its_region(name: str) -> None:
    part = synth.part(name, 5_000)
    assert sorted(set(part.labels.tolist())) == list(range(len(part.surfaces)))
    for number, surface in enumerate(part.surfaces):
        assert isinstance(surface, AnalyticSurface)
        corners = part.mesh.vertices[np.unique(part.mesh.faces[part.labels == number])]
        assert np.abs(surface.distance(corners)).max() < 1e-6 * part.mesh.size


def test_noise_moves_its_share_of_the_vertices_by_no_more_than_sigma() -> None:
    part = synth.part("shaft", 4_000)
    noisy = synth.noise(part.mesh, sigma=0.01, ratio=0.3, seed=1)
    moved = np.linalg.norm(noisy.vertices - part.mesh.vertices, axis=1)
    assert np.array_equal(noisy.faces, part.mesh.faces)
    assert moved.max() <= 0.01 * part.mesh.size
    assert (moved > 0).mean() == pytest.approx(0.3, abs=0.01)
    again = synth.noise(part.mesh, sigma=0.01, ratio=0.3, seed=1)
    assert np.array_equal(noisy.vertices, again.vertices)


@pytest.mark.parametrize("wrong", [{"sigma": -1.0}, {"ratio": 1.5}, {"sigma": float("nan")}])
def test_noise_that_cannot_be_meant_is_refused(wrong: dict[str, float]) -> None:
    with pytest.raises(quadrics.OptionError, match=next(iter(wrong))):
        synth.noise(synth.part("shaft", 4_000).mesh, **wrong)  # type: ignore[arg-type]


def test_the_scanner_is_that_of_the_core() -> None:
    assert asdict(synth.Scanner()) == _core.default_scanner()


def test_a_scan_lies_near_the_surfaces_and_is_made_again_by_its_seed() -> None:
    part = synth.part("shaft", 5_000)
    scanner = synth.Scanner(faces=5_000)
    scan, again = (synth.scan(part, scanner, seed=2) for _ in range(2))
    assert np.array_equal(scan.mesh.vertices, again.mesh.vertices)
    assert scan.labels.shape == (scan.mesh.face_count,)
    centres = scan.mesh.vertices[scan.mesh.faces].mean(axis=1)
    off = np.zeros(len(centres))
    for number, surface in enumerate(scan.surfaces):
        assert isinstance(surface, AnalyticSurface)
        own = scan.labels == number
        off[own] = surface.distance(centres[own])
    # Waviness and jitter are a thousandth of the size; most faces do not touch an edge.
    assert np.median(np.abs(off)) < 0.003 * part.mesh.size


def test_an_unknown_part_names_those_that_there_are() -> None:
    with pytest.raises(quadrics.OptionError, match="shaft"):
        synth.part("teapot")


def test_the_noise_command_writes_a_mesh_of_the_same_faces(
    part: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    noisy = part.with_name("noisy.ply")
    assert main(["noise", str(part), "-o", str(noisy), "--sigma", "0.02", "--seed", "3"]) == 0
    assert np.array_equal(quadrics.read(noisy).faces, quadrics.read(part).faces)
    assert main(["noise", str(part), "-o", str(noisy)]) == 4
    assert main(["noise", str(part), "-o", str(part.with_name("noisy.step"))]) == 4
    assert main(["noise", str(part), "-o", str(part.parent / "none" / "n.ply")]) == 4
    assert main(["noise", str(part), "-o", str(noisy), "--overwrite", "--ratio", "2"]) == 2
    assert capsys.readouterr().err.count("\n") == 4
