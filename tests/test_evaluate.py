"""Judging a result: against a part, a folder, another result."""

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


def write_truth(folder: Path, part: synth.Part) -> Path:
    """A folder as ground truth is handed around in."""
    folder.mkdir()
    part.mesh.save(folder / "mesh.ply")
    np.save(folder / "labels.npy", part.labels.astype(np.uint16))
    regions = [
        {"id": number, "type": surface.type, "parameters": surface.parameters}
        for number, surface in enumerate(part.surfaces)
        if not isinstance(surface, quadrics.FreeForm)
    ]
    (folder / "truth.json").write_text(json.dumps({"regions": regions}))
    return folder


def test_a_result_a_part_and_their_folders_are_judged_alike(tmp_path: Path) -> None:
    result = quadrics.segment(SHAFT.mesh, seed=0)
    folder = result.save(tmp_path / "result")
    truth = write_truth(tmp_path / "truth", SHAFT)
    seen = quadrics.evaluate(result, SHAFT)
    assert seen.f1 > 0.7
    assert seen.hamming < 0.1
    again = quadrics.evaluate(folder, truth)
    assert again.hamming == pytest.approx(seen.hamming, abs=1e-6)
    assert [(m.found, m.true, m.hit) for m in again.matches] == [
        (m.found, m.true, m.hit) for m in seen.matches
    ]
    assert quadrics.evaluate(folder, folder).f1 == 1
    assert quadrics.evaluate(folder, folder).missed == ()


def test_a_wrong_radius_is_measured_and_a_coarse_one_is_no_hit(tmp_path: Path) -> None:
    truth = write_truth(tmp_path / "truth", SHAFT)
    document = json.loads((truth / "truth.json").read_text())
    cylinder = next(r for r in document["regions"] if r["type"] == "cylinder")
    cylinder["parameters"]["radius"] *= 1.01
    (truth / "truth.json").write_text(json.dumps(document))
    seen = quadrics.evaluate(truth, SHAFT)
    assert seen.parameter_errors["cylinder"]["radius"]["p95"] == pytest.approx(0.01, rel=0.2)
    strict = quadrics.evaluate(truth, SHAFT, tolerance=1e-5)
    assert strict.missed == (cylinder["id"],)
    assert seen.energy > quadrics.evaluate(SHAFT, SHAFT).energy


def test_labels_without_a_region_and_faces_without_a_label(tmp_path: Path) -> None:
    folder = write_truth(tmp_path / "found", SHAFT)
    labels = np.load(folder / "labels.npy").astype(np.int32)
    labels[labels == 0] = -1
    labels[labels == 1] = 99
    np.save(folder / "labels.npy", labels)
    seen = quadrics.evaluate(folder, SHAFT)
    assert 0 < seen.unlabelled_area < seen.without_surface
    assert {0, 1} <= set(seen.missed)
    assert seen.regions_found == seen.regions_true + 1


def test_what_cannot_be_compared_is_refused(tmp_path: Path) -> None:
    with pytest.raises(quadrics.OptionError, match="is it of this mesh"):
        quadrics.evaluate(synth.part("shaft", 9_000), SHAFT)
    with pytest.raises(quadrics.InputError, match=r"no segmentation\.json"):
        quadrics.evaluate(tmp_path, SHAFT)
    with pytest.raises(quadrics.OptionError, match="tolerance"):
        quadrics.evaluate(SHAFT, SHAFT, tolerance=0)
    (tmp_path / "truth.json").write_text("[]")
    with pytest.raises(quadrics.InputError, match="is not what"):
        quadrics.evaluate(tmp_path, SHAFT)


def test_the_command_prints_a_table_or_json(tmp_path: Path, program: Run) -> None:
    truth = write_truth(tmp_path / "truth", SHAFT)
    shown = program("evaluate", truth, truth)
    assert (shown.returncode, shown.stderr) == (0, "")
    assert "F1 1.000" in shown.stdout
    assert json.loads(program("evaluate", truth, truth, "--json").stdout)["hamming"] == 0


def test_a_folder_without_a_result_is_exit_3(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["evaluate", str(tmp_path), str(tmp_path)]) == 3
    assert capsys.readouterr().err.count("\n") == 1
