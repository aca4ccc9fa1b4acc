"""Our readers against trimesh, and against what the formats say."""

from __future__ import annotations

import bz2
import gzip
import io
import json
import lzma
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

import meshes
import quadrics
from quadrics import _core

POINTS, FACES = meshes.rod(24, 5)
SQUARES = [[0, 1, 2, 3], [4, 7, 6, 5], [0, 4, 5, 1], [1, 5, 6, 2], [2, 6, 7, 3], [3, 7, 4, 0]]
CORNERS = np.array([[x, y, z] for z in (0, 1) for x, y in ((0, 0), (0, 1), (1, 1), (1, 0))], float)

WRITERS: dict[str, Callable[[Any, Any], bytes]] = {
    "binary.stl": meshes.stl,
    "solid.stl": lambda p, f: meshes.stl(p, f, b"solid made by a scanner"),
    "ascii.stl": meshes.stl_ascii,
    "upper.stl": lambda p, f: meshes.stl_ascii(p, f).upper().replace(b"\n", b"\r\n"),
    "little.ply": meshes.ply,
    "big.ply": lambda p, f: meshes.ply(p, f, ">"),
    "ascii.ply": meshes.ply_ascii,
    "part.obj": meshes.obj,
    "part.off": meshes.off,
    "part.glb": meshes.glb,
    "part.gltf": meshes.gltf,
    "part.3mf": lambda p, f: meshes.threemf(meshes.model(p, f)),
}


def triangles(vertices: Any, faces: Any) -> NDArray[np.float64]:
    corners: NDArray[np.float64] = np.asarray(vertices, float)[np.asarray(faces)]
    return corners


@pytest.mark.parametrize("name", WRITERS)
def test_a_file_is_read_as_trimesh_reads_it(name: str, tmp_path: Path) -> None:
    content = WRITERS[name](POINTS, FACES)
    (tmp_path / name).write_bytes(content)
    ours = quadrics.read(tmp_path / name)
    kind = name.split(".")[1]
    theirs: Any = trimesh.load(io.BytesIO(content), file_type=kind, process=False, force="mesh")
    assert ours.face_count == len(FACES)
    expected = triangles(theirs.vertices, theirs.faces)
    np.testing.assert_allclose(triangles(ours.vertices, ours.faces), expected, atol=1e-6)


@pytest.mark.parametrize("name", WRITERS)
def test_faces_keep_their_order_and_their_first_corner(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(WRITERS[name](POINTS, FACES))
    ours = quadrics.read(tmp_path / name)
    expected = triangles(POINTS, FACES)
    np.testing.assert_allclose(triangles(ours.vertices, ours.faces), expected, atol=1e-6)


@pytest.mark.parametrize("write", [meshes.ply, meshes.ply_ascii, meshes.obj, meshes.off])
def test_polygons_stay_the_faces_of_the_input(
    write: Callable[[Any, Any], bytes], tmp_path: Path
) -> None:
    path = tmp_path / f"part.{ {'obj': 'obj', 'off': 'off'}.get(write.__name__, 'ply') }"
    path.write_bytes(write(CORNERS, SQUARES))
    mesh = quadrics.read(path)
    assert (mesh.face_count, len(mesh.faces)) == (6, 12)
    assert mesh.parent is not None
    assert mesh.parent.tolist() == [0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5]
    assert quadrics.segment(mesh).labels.shape == (6,)


@pytest.mark.parametrize(
    ("ending", "pack"), [("gz", gzip.compress), ("bz2", bz2.compress), ("xz", lzma.compress)]
)
def test_a_compressed_file_is_unpacked(
    ending: str, pack: Callable[[bytes], bytes], tmp_path: Path
) -> None:
    path = tmp_path / f"part.stl.{ending}"
    path.write_bytes(pack(meshes.stl(POINTS, FACES)))
    assert quadrics.read(path).face_count == len(FACES)


def test_an_obj_may_count_backwards_and_name_textures(tmp_path: Path) -> None:
    path = tmp_path / "part.obj"
    path.write_bytes(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf -3/1/1 2//1 -1/1\n")
    assert quadrics.read(path).faces.tolist() == [[0, 1, 2]]


def test_a_node_moves_its_mesh(tmp_path: Path) -> None:
    path = tmp_path / "part.gltf"
    nodes = [{"mesh": 0, "translation": [5, 0, 0]}]
    path.write_bytes(meshes.gltf(POINTS, FACES, nodes=nodes))
    mesh = quadrics.read(path)
    np.testing.assert_allclose(
        triangles(mesh.vertices, mesh.faces), triangles(np.add(POINTS, [5, 0, 0]), FACES), atol=1e-6
    )


def test_a_file_may_name_a_neighbour(tmp_path: Path) -> None:
    document, data = meshes.gltf_parts(POINTS, FACES)
    document["buffers"][0]["uri"] = "my%20data.bin"
    (tmp_path / "part.gltf").write_text(json.dumps(document))
    (tmp_path / "my data.bin").write_bytes(data)
    assert quadrics.read(tmp_path / "part.gltf").face_count == len(FACES)


def test_units_of_the_file_are_noted(tmp_path: Path) -> None:
    (tmp_path / "part.3mf").write_bytes(WRITERS["part.3mf"](POINTS, FACES))
    result = quadrics.segment(tmp_path / "part.3mf")
    assert result.units in ("mm", "millimeter")


@pytest.mark.parametrize("extension", ["ply", "stl", "obj", "off"])
def test_what_is_written_reads_back(extension: str, tmp_path: Path) -> None:
    mesh = quadrics.as_mesh((POINTS, FACES))
    (tmp_path / f"part.{extension}").write_bytes(_core.write(extension, mesh.vertices, mesh.faces))
    again = quadrics.read(tmp_path / f"part.{extension}")
    np.testing.assert_allclose(
        triangles(again.vertices, again.faces), triangles(POINTS, FACES), atol=1e-6
    )


@settings(max_examples=300, deadline=None)
@given(
    name=st.sampled_from(sorted(WRITERS)),
    cut=st.integers(0, 2000),
    at=st.integers(0, 2000),
    junk=st.binary(max_size=12),
)
def test_damage_is_refused_or_read_and_never_a_fault_of_ours(
    name: str, cut: int, at: int, junk: bytes
) -> None:
    whole = WRITERS[name](CORNERS, [[0, 1, 2], [0, 2, 3], [4, 6, 5]])
    damaged = whole[: min(at, len(whole))] + junk + whole[at + cut % 40 :]
    with suppress(quadrics.InputError):
        loaded = _core.read(name.split(".")[1], damaged, lambda _: None)
        quadrics.mesh.inspect((loaded["positions"], loaded["faces"]))
