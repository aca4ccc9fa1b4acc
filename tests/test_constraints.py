"""Constraints that a user gives: files, errors, and what comes of them."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import pytest

import meshes
import quadrics
from quadrics import synth
from quadrics.cli.main import main
from quadrics.constraints import as_constraints
from quadrics.result import Result
from quadrics.surfaces import Cylinder

SCHEMA = json.loads(
    (Path(quadrics.__file__).parent / "schema" / "constraints.json").read_text(encoding="utf-8")
)


@pytest.fixture(scope="module")
def part() -> synth.Part:
    return synth.part("plate", 6000)


@pytest.fixture(scope="module")
def first(part: synth.Part) -> Result:
    return quadrics.segment(part.mesh)


def _bore(result: Result) -> tuple[int, float]:
    bores = [(r.id, r.surface) for r in result.regions]
    return next((i, s.radius) for i, s in bores if isinstance(s, Cylinder))


def test_a_fixed_radius_holds_and_the_regions_stay(part: synth.Part, first: Result) -> None:
    region, radius = _bore(first)
    known = {"fix": [{"region": region, "parameter": "radius", "value": radius * 1.001}]}
    jsonschema.validate(known, SCHEMA)
    again = quadrics.segment(part.mesh, constraints=known)
    assert (again.labels == first.labels).all()
    found = again.regions[region].surface
    assert isinstance(found, Cylinder)
    assert found.radius == pytest.approx(radius * 1.001, rel=1e-9)


def test_relations_of_a_first_run_can_be_edited_and_given_back(
    part: synth.Part, first: Result
) -> None:
    document = json.loads(json.dumps(first.to_dict()))
    again = quadrics.segment(part.mesh, constraints=document)
    kinds = {(r.kind, r.regions) for r in again.relations if r.status == "accepted"}
    wanted = [r for r in first.relations if r.status == "accepted" and r.kind == "parallel"]
    assert wanted
    assert all((r.kind, r.regions) in kinds for r in wanted)
    relations = [r for r in document["relations"] if r["kind"] == "parallel"]
    pair = relations[0]["regions"][:2]
    forbidden = {"relations": [{"kind": "coplanar", "regions": pair, "status": "forbidden"}]}
    jsonschema.validate(forbidden, SCHEMA)
    quadrics.segment(part.mesh, constraints=forbidden)


def test_dimensions_have_uncertainties_and_a_grid(part: synth.Part, first: Result) -> None:
    assert {d.kind for d in first.dimensions} >= {"radius", "distance"}
    assert all(d.uncertainty >= 0 for d in first.dimensions)
    rounded = quadrics.segment(part.mesh, constraints={"round": {"length": 0.5}})
    for dimension in (d for d in rounded.dimensions if d.rounded):
        assert dimension.value / 0.5 == pytest.approx(round(dimension.value / 0.5), abs=1e-6)


def test_files_are_read_as_typed(part: synth.Part, first: Result, tmp_path: Path) -> None:
    mesh = tmp_path / "part.ply"
    mesh.write_bytes(meshes.ply(part.mesh.vertices, part.mesh.faces))
    region, radius = _bore(first)
    known = tmp_path / "known.json"
    entry = {"region": region, "parameter": "radius", "value": radius}
    known.write_text(json.dumps({"fix": [entry]}), encoding="utf-8")
    arguments = ["segment", str(mesh), "-o", str(tmp_path / "out"), "--quiet"]
    assert main([*arguments, "--constraints", str(known), "--round-length", "0.5"]) == 0
    written = json.loads((tmp_path / "out" / "segmentation.json").read_text(encoding="utf-8"))
    assert written["options"]["constraints"]["round"] == {"length": 0.5}


@pytest.mark.parametrize(
    ("document", "words"),
    [
        ("{", "is no JSON: line 1"),
        ("[]", "give True, False, a dictionary or a JSON file"),
        ('{"relation": []}', "no entry 'relation': choose relations, fix, gate, round"),
        ('{"relations": 3}', "it must be a list of objects"),
        ('{"relations": [{"kind": "coaxial", "regions": "3"}]}', "whole numbers from 0"),
        ('{"relations": [{"kind": "coaxial", "regions": [0], "status": "x"}]}', "choose forced"),
        ('{"fix": [{"region": 0, "parameter": "radius", "value": "5"}]}', "must be a number"),
        ('{"round": {"length": 0}}', "it must be above 0"),
    ],
)
def test_bad_files_are_named_in_one_line(tmp_path: Path, document: str, words: str) -> None:
    path = tmp_path / "known.json"
    path.write_text(document, encoding="utf-8")
    with pytest.raises(quadrics.QuadricsError) as caught:
        as_constraints(path)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("known", "words"),
    [
        ({"relations": [{"kind": "alike", "regions": [0, 1]}]}, "no kind"),
        ({"relations": [{"kind": "coaxial", "regions": [0, 999]}]}, "no region 999"),
        ({"fix": [{"region": 0, "parameter": "colour", "value": 1}]}, "give radius"),
        ({"fix": [{"region": 0, "parameter": "axis", "value": 1}]}, "give three numbers"),
    ],
)
def test_demands_that_do_not_fit_the_part_are_named(
    part: synth.Part, known: dict[str, object], words: str
) -> None:
    with pytest.raises(quadrics.QuadricsError, match=words):
        quadrics.segment(part.mesh, constraints=known)
