"""What a Python program sees."""

from __future__ import annotations

import json
import threading
import time
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import jsonschema
import numpy as np
import pytest

import meshes
import quadrics
from quadrics import _core, synth
from quadrics.labels import labels_of_input
from quadrics.surfaces import AnalyticSurface, Quadric, surface_from

POINTS, FACES = meshes.box(4)
UP = (0.0, 0.0, 1.0)

#: A surface of every type, a point, its signed distance, and its nearest point.
SURFACES = [
    (quadrics.Plane(UP, 2.0), (1, 1, 5), 3.0, (1, 1, 2)),
    (quadrics.Sphere((0, 0, 1), 2.0), (0, 0, 6), 3.0, (0, 0, 3)),
    (quadrics.Cylinder((0, 0, 0), UP, 2.0), (3, 0, 7), 1.0, (2, 0, 7)),
    (quadrics.Cone((0, 0, 0), UP, 45.0), (0, 2, 0), 2**0.5, (0, 1, 1)),
    (quadrics.Torus((0, 0, 0), UP, 3.0, 1.0), (5, 0, 0), 1.0, (4, 0, 0)),
    (quadrics.Torus((0, 0, 0), UP, 3.0, 5.0, inner=True), (4, 0, 0), 2.0, (2, 0, 0)),
    (Quadric((-4, 0, 0, 0, 1, 0, 0, 1, 0, 1), "ellipsoid"), (0, 5, 0), 3.0, (0, 2, 0)),
]


@pytest.fixture(scope="module")
def result() -> quadrics.Result:
    return quadrics.segment((POINTS, FACES))


def test_the_options_are_those_of_the_core() -> None:
    ours = asdict(quadrics.Options())
    assert ours == _core.default_options()
    assert list(ours) == list(_core.default_options())


@pytest.mark.parametrize(
    "change",
    [
        {"regions": 0}, {"regions": 2.5}, {"seed": -1}, {"threads": -1}, {"preset": "best"},
        {"alpha": float("nan")}, {"epsilon": "big"}, {"beta": -1.0}, {"seeds": "vertex"},
        {"max_iterations": True}, {"max_edge": 0.0},
    ],
)  # fmt: skip
def test_an_option_that_cannot_be_meant_is_refused(change: dict[str, Any]) -> None:
    with pytest.raises(quadrics.OptionError, match=next(iter(change))):
        quadrics.Options(**change)


def test_every_option_is_described() -> None:
    from quadrics.cli.segment import _described

    assert set(_described()) == set(asdict(quadrics.Options()))


@pytest.mark.parametrize(("surface", "point", "far", "foot"), SURFACES)
def test_a_surface_answers(surface: AnalyticSurface, point: Any, far: float, foot: Any) -> None:
    assert surface.distance(point) == pytest.approx(far)
    assert surface.distance([point, foot]) == pytest.approx([far, 0], abs=1e-9)
    assert surface.project(point) == pytest.approx(foot)
    normal = surface.normal(point)
    assert np.asarray(foot) + far * normal == pytest.approx(point)
    if (quadric := surface.quadric()) is not None:
        x, y, z = foot
        terms = np.array([1, x, y, z, x * x, x * y, x * z, y * y, y * z, z * z])
        assert quadric @ terms == pytest.approx(0, abs=1e-9)
    else:
        assert surface.type == "torus"


@pytest.mark.parametrize("surface", [row[0] for row in SURFACES])
def test_a_surface_is_its_parameters(surface: AnalyticSurface) -> None:
    same = surface_from({"type": surface.type, **surface.parameters})
    assert same == surface
    assert hash(same) == hash(surface)
    assert repr(surface).startswith(type(surface).__name__)


def test_points_of_another_shape_are_refused() -> None:
    with pytest.raises(ValueError, match=r"\(n, 3\)"):
        quadrics.Sphere((0, 0, 0), 1.0).distance([[1, 2]])


def test_a_free_form_surface_has_a_type_and_nothing_else() -> None:
    surface = surface_from({"type": "freeform"})
    assert surface == quadrics.FreeForm()
    assert not hasattr(surface, "distance")


def test_a_result_covers_every_face(result: quadrics.Result) -> None:
    assert result.labels.shape == (len(FACES),)
    assert result.labels.dtype == np.int32
    assert sorted(set(result.labels.tolist())) == [region.id for region in result.regions]
    assert sum(region.faces for region in result.regions) == len(FACES)


def test_a_box_is_six_planes(result: quadrics.Result) -> None:
    assert [region.surface.type for region in result.regions] == ["plane"] * 6
    assert sum(region.area for region in result.regions) == pytest.approx(22)
    assert {round(abs(r.surface.offset), 6) for r in result.regions} == {0, 1, 2, 3}  # type: ignore[union-attr]


def test_a_result_obeys_its_schema(result: quadrics.Result) -> None:
    schema = Path(quadrics.__file__).with_name("schema") / "segmentation.json"
    document = json.loads(json.dumps(result.to_dict(), allow_nan=False))
    jsonschema.validate(document, json.loads(schema.read_text()))


def foreign(kind: str) -> Any:
    polygons = np.column_stack([np.full(len(FACES), 3), FACES]).ravel()
    cells = [SimpleNamespace(type="triangle", data=FACES), SimpleNamespace(type="line", data=[])]
    tensor = [SimpleNamespace(numpy=lambda values=values: values) for values in (POINTS, FACES)]
    return {
        "pair": (POINTS, FACES),
        "lists": (POINTS.tolist(), FACES.tolist()),
        "trimesh": SimpleNamespace(vertices=POINTS, faces=FACES),
        "pyvista": SimpleNamespace(points=POINTS, faces=polygons),
        "meshio": SimpleNamespace(points=POINTS, cells=cells),
        "open3d": SimpleNamespace(vertices=POINTS, triangles=FACES),
        "open3d.t": SimpleNamespace(
            vertex={"positions": tensor[0]}, triangle={"indices": tensor[1]}
        ),
    }[kind]


@pytest.mark.parametrize(
    "kind", ["pair", "lists", "trimesh", "pyvista", "meshio", "open3d", "open3d.t"]
)
def test_other_libraries_meshes_are_taken(kind: str) -> None:
    mesh = quadrics.as_mesh(foreign(kind))
    assert np.array_equal(mesh.vertices, POINTS)
    assert np.array_equal(mesh.faces, FACES)


def test_a_mesh_of_trimesh_is_taken() -> None:
    import trimesh

    mesh = quadrics.as_mesh(trimesh.Trimesh(POINTS, FACES, process=False))
    assert np.array_equal(mesh.faces, FACES)


@pytest.mark.parametrize(
    "source",
    [
        None, 5, object(), (POINTS, None), (POINTS, 7), (POINTS[:, :2], FACES), (POINTS, FACES / 2),
        (POINTS, [[0, 1]]), (POINTS, -FACES), ("xyz", FACES), (POINTS, [["a", "b", "c"]]),
        (POINTS, []), (POINTS * np.nan, FACES), (POINTS[:5], FACES), ([], []),
    ],
)  # fmt: skip
def test_what_is_no_mesh_is_refused(source: Any) -> None:
    with pytest.raises(quadrics.InputError):
        quadrics.segment(source)


def test_polygons_get_one_label_each() -> None:
    mesh = quadrics.as_mesh(([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 3, 0]], [[0, 1, 2, 3]]))
    assert (mesh.face_count, len(mesh.faces)) == (1, 2)
    # The second triangle of the fan is the larger one.
    assert labels_of_input(mesh, np.array([0, 1], np.int32), 2).tolist() == [1]


def test_a_region_that_would_vanish_keeps_a_polygon() -> None:
    square = [[0, 1, 2, 3], [1, 4, 5, 2]]
    points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1.5, 0], [2, 0, 0], [2, 1, 0]]
    mesh = quadrics.as_mesh((points, square))
    labels = labels_of_input(mesh, np.array([1, 0, 0, 0], np.int32), 2)
    assert sorted(labels.tolist()) == [0, 1]


def test_labels_of_the_input_start_the_loop() -> None:
    start = np.zeros(len(FACES), int)
    assert len(quadrics.segment((POINTS, FACES), initial_labels=start).regions) >= 1


@pytest.mark.parametrize("labels", [[0, 1], np.zeros(len(FACES)), np.full(len(FACES), -1), "no"])
def test_labels_that_do_not_fit_are_refused(labels: Any) -> None:
    with pytest.raises(quadrics.OptionError, match="initial label"):
        quadrics.segment((POINTS, FACES), initial_labels=labels)


def test_progress_is_told() -> None:
    told: list[tuple[str, float]] = []
    quadrics.segment(meshes.box(12), progress=lambda stage, done: told.append((stage, done)))
    assert told
    assert all(isinstance(stage, str) and 0 <= done <= 1 for stage, done in told)


def test_what_progress_raises_comes_out() -> None:
    def fail(stage: str, fraction: float) -> None:
        raise LookupError(stage)

    with pytest.raises(LookupError):
        quadrics.segment(meshes.box(12), progress=fail)


def test_progress_can_stop_the_run() -> None:
    with pytest.raises(KeyboardInterrupt):
        quadrics.segment(meshes.box(12), progress=lambda stage, fraction: False)


def test_other_threads_run_meanwhile() -> None:
    ticks, stop = [0], threading.Event()

    def tick() -> None:
        while not stop.is_set():
            ticks[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    started = time.perf_counter()
    quadrics.segment(meshes.box(40))
    seconds = time.perf_counter() - started
    stop.set()
    thread.join()
    # A held lock would allow about none; a busy machine allows far fewer than a thousand a second.
    assert ticks[0] > 20 * seconds


def untimed(result: quadrics.Result) -> dict[str, Any]:
    document = result.to_dict()
    del document["timing"], document["options"]["threads"]
    return document


@pytest.mark.parametrize("make", [meshes.box, meshes.rod])
def test_any_number_of_threads_gives_the_same_result(make: Callable[[], meshes.Arrays]) -> None:
    one, two = (quadrics.segment(make(), seed=3, threads=threads) for threads in (1, 2))
    assert np.array_equal(one.labels, two.labels)
    assert untimed(one) == untimed(two)


def test_a_saved_result_is_four_files(result: quadrics.Result, tmp_path: Path) -> None:
    folder = result.save(tmp_path / "a" / "b")
    names = ["labels.npy", "segmentation.json", "segmentation.ply", "segmentation.png"]
    assert sorted(path.name for path in folder.iterdir()) == names
    assert np.array_equal(np.load(folder / "labels.npy"), result.labels)
    again = quadrics.read(folder / "segmentation.ply")
    assert np.array_equal(again.faces, FACES)
    assert (folder / "segmentation.png").read_bytes().startswith(b"\x89PNG")
    with pytest.raises(quadrics.OutputError, match="--overwrite"):
        result.save(folder)
    result.save(folder, overwrite=True)


def test_the_picture_is_the_same_every_time(result: quadrics.Result, tmp_path: Path) -> None:
    first, second = (result.save(tmp_path / name) / "segmentation.png" for name in "ab")
    assert first.read_bytes() == second.read_bytes()


def test_a_save_that_fails_leaves_nothing(
    result: quadrics.Result, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: Any) -> None:
        raise OSError(28, "No space left on device")

    kept = result.save(tmp_path / "kept") / "labels.npy"
    monkeypatch.setattr("quadrics.picture.write_picture", full)
    for folder in ("new", "kept"):
        with pytest.raises(quadrics.OutputError, match="no space"):
            result.save(tmp_path / folder, overwrite=True)
    assert [path.name for path in tmp_path.iterdir()] == ["kept"]
    assert kept.exists()


def test_relations_hold_to_rounding_and_can_be_left_out() -> None:
    part = synth.part("shaft", 5_000)
    result = quadrics.segment(part.mesh, seed=0)
    kinds = {relation.kind for relation in result.relations}
    assert {"parallel", "coaxial"} <= kinds
    held = [relation for relation in result.relations if relation.status != "refused"]
    assert all(relation.residual_after < 1e-6 for relation in held)
    assert quadrics.segment(part.mesh, seed=0, constraints=False).relations == ()


def test_dense_noise_hides_less_than_sparse_noise() -> None:
    found = {}
    for faces in (15_000, 240_000):
        part = quadrics.synth.part("demo", faces)
        noisy = quadrics.synth.noise(part.mesh, sigma=0.005, ratio=0.5)
        result = quadrics.segment(noisy)
        found[faces] = quadrics.evaluate(result, part).f1
        # Half of the vertices move by up to sigma of the longest side: 0.41 of it on the mean
        # square.
        sides = part.mesh.vertices.max(axis=0) - part.mesh.vertices.min(axis=0)
        assert result.noise.position == pytest.approx(0.005 * 0.41 * sides.max(), rel=0.25)
    assert found[240_000] > max(found[15_000], 0.7)


def test_a_coarser_mesh_leads_to_the_same_regions() -> None:
    part = quadrics.synth.part("shaft", 60_000)
    coarse = quadrics.segment(part.mesh, coarse="on")
    whole = quadrics.segment(part.mesh, coarse="off")
    assert quadrics.evaluate(coarse, whole).hamming < 0.01
    assert quadrics.evaluate(coarse, part).f1 == quadrics.evaluate(whole, part).f1 == 1.0


def test_a_crowned_roller_with_a_domed_end_is_both_sheets_of_tori() -> None:
    def arc(center: tuple[float, float], radius: float, turn: tuple[float, float]) -> Any:
        angle = np.radians(np.linspace(*turn, 40))
        return np.asarray(center) + radius * np.column_stack([np.cos(angle), np.sin(angle)])

    crown = arc((-30.0, 0.0), 50.0, (-20.0, 20.0))
    edge = crown[-1]
    steep = np.degrees(np.arccos((edge[0] - 6.0) / 20.0))
    dome = arc((6.0, edge[1] - 20.0 * np.sin(np.radians(steep))), 20.0, (steep, 90.0))
    flat = np.linspace(0.0, 1.0, 8)[1:-1, None]
    low = np.column_stack([flat * crown[0, 0], np.full(6, crown[0, 1])])
    top = np.column_stack([flat[::-1] * 6.0, np.full(6, dome[-1, 1])])
    found = quadrics.segment(meshes.turned(np.concatenate([low, crown, dome[1:], top])))

    surfaces = [region.surface for region in found.regions]
    assert sorted(surface.type for surface in surfaces) == ["plane", "plane", "torus", "torus"]
    tori = [surface for surface in surfaces if isinstance(surface, quadrics.Torus)]
    crowned, domed = sorted(tori, key=lambda torus: -torus.minor_radius)
    assert (crowned.major_radius, crowned.minor_radius) == pytest.approx((30, 50), rel=1e-4)
    assert (domed.major_radius, domed.minor_radius) == pytest.approx((6, 20), rel=1e-4)
    assert crowned.inner
    assert not domed.inner
