"""Noise off a mesh, and distances between meshes."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import quadrics
from conftest import Run
from quadrics import synth
from quadrics.cli.main import main

SHAFT = synth.part("shaft", 5_000)


def test_a_noisy_part_comes_nearer_to_the_clean_one() -> None:
    noisy = synth.noise(SHAFT.mesh, sigma=0.002, ratio=0.5, seed=1)
    clean = quadrics.denoise(noisy)
    before = quadrics.deviation(noisy, SHAFT.mesh)
    after = quadrics.deviation(clean, SHAFT.mesh)
    assert after.mean < before.mean / 3
    assert (clean.faces == noisy.faces).all()
    assert before.of_vertex.shape == (len(noisy.vertices),)


def test_surfaces_come_from_a_result_a_part_or_a_folder(tmp_path: Path) -> None:
    noisy = synth.noise(SHAFT.mesh, sigma=0.002, seed=1)
    result = quadrics.segment(noisy)
    by_result = quadrics.denoise(noisy, result)
    by_folder = quadrics.denoise(noisy, result.save(tmp_path / "result"))
    assert np.allclose(by_result.vertices, by_folder.vertices, atol=1e-9)
    with pytest.raises(quadrics.OptionError, match="give sigma"):
        quadrics.denoise(noisy, SHAFT)
    by_truth = quadrics.denoise(noisy, SHAFT, sigma=result.noise.position)
    mean = [quadrics.deviation(m, SHAFT.mesh).mean for m in (noisy, by_result, by_truth)]
    assert mean[0] > mean[1] > mean[2]


def test_a_segmentation_of_another_mesh_is_refused() -> None:
    with pytest.raises(quadrics.OptionError, match="are they of this mesh"):
        quadrics.denoise(SHAFT.mesh, synth.part("shaft", 9_000), sigma=0.1)
    with pytest.raises(quadrics.OptionError, match="noise is -1"):
        quadrics.denoise(SHAFT.mesh, SHAFT, sigma=-1)


def test_the_command_writes_the_mesh_the_map_and_the_distances(
    tmp_path: Path, program: Run
) -> None:
    SHAFT.mesh.save(tmp_path / "part.ply")
    synth.noise(SHAFT.mesh, sigma=0.002, seed=1).save(tmp_path / "noisy.ply")
    arguments = ("denoise", "noisy.ply", "-o", "clean.ply", "--reference", "part.ply")
    done = program(*arguments, "--map", "map.png", "--json")
    assert (done.returncode, done.stderr) == (0, "")
    seen = json.loads(done.stdout)
    assert seen["after"]["mean"] < seen["before"]["mean"]
    assert (tmp_path / "map.png").read_bytes().startswith(b"\x89PNG")
    assert quadrics.read(tmp_path / "clean.ply").face_count == SHAFT.mesh.face_count
    again = program(*arguments)
    assert again.returncode == 4
    assert "--overwrite" in again.stderr
    shown = program(*arguments, "--overwrite")
    assert [line.split()[0] for line in shown.stdout.splitlines()[2:]] == ["before", "after"]


def test_a_map_needs_a_reference(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    SHAFT.mesh.save(tmp_path / "part.ply")
    part, out = str(tmp_path / "part.ply"), str(tmp_path / "out.ply")
    assert main(["denoise", part, "-o", out, "--map", str(tmp_path / "map.png")]) == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert not (tmp_path / "out.ply").exists()
