"""Files that nobody should have sent: one line and an exit code, or a listed repair."""

from __future__ import annotations

import bz2
import gzip
import io
import json
import lzma
import os
import resource
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import meshes
import quadrics
from quadrics.cli.main import main

P, F = meshes.box(2)
STL, PLY, GLB = meshes.stl(P, F), meshes.ply(P, F), meshes.glb(P, F)
NAN_POINTS = np.where(np.arange(len(P))[:, None] == 5, np.nan, P)
FAR = np.where(np.arange(len(P))[:, None] == 5, 1e300, P)
BAD_FACE = [*F.tolist(), [0, 1, 9000]]
LOOP = meshes.model(P, F).replace(
    "</resources>",
    '<object id="2"><components><component objectid="3"/></components></object>'
    '<object id="3"><components><component objectid="2"/></components></object></resources>',
).replace('item objectid="1"', 'item objectid="2"')  # fmt: skip

#: Name, content, and words that the one line must have.
CONTENT = [
    ("empty.stl", b"", "empty"),
    ("text.stl", b"Dear Sir, please find attached the part.\n", ""),
    ("picture.stl", b"\x89PNG\r\n\x1a\n" + bytes(200), ""),
    ("letter.docx", b"Dear Sir", ""),
    ("noname", b"\x00\x01\x02\x03", ""),
    ("cut.stl", STL[:-30], ""),
    ("header.stl", STL[:84], ""),
    ("half.stl", STL[:40], ""),
    ("no_triangles.stl", bytes(84), ""),
    ("cut_ascii.stl", meshes.stl_ascii(P, F)[:-60], ""),
    ("words.stl", meshes.stl_ascii(P, F).replace(b"vertex 0", b"vertex zero", 1), ""),
    ("nan.stl", meshes.stl(NAN_POINTS, F), "finite"),
    ("infinite.stl", meshes.stl_ascii(P, F).replace(b"vertex 3", b"vertex inf", 1), ""),
    ("no_end.ply", b"ply\nformat ascii 1.0\nelement vertex 3\n", ""),
    ("cut.ply", PLY[:-7], ""),
    ("format.ply", PLY.replace(b"binary_little_endian", b"binary_middle_endian"), ""),
    ("index.ply", meshes.ply(P, BAD_FACE), "9000"),
    ("negative.ply", meshes.ply(P, [[0, 1, -2]]), ""),
    ("points.ply", meshes.ply(P, []), "points"),
    ("nan.ply", meshes.ply(NAN_POINTS, F), "finite"),
    ("lines.ply", meshes.ply(P, [[0, 1], [1, 2]]), ""),
    ("property.ply", PLY.replace(b"property float x", b"property flout x"), ""),
    ("no_x.ply", PLY.replace(b"property float x", b"property float w"), ""),
    ("zero.obj", meshes.obj(P, F) + b"f 0 1 2\n", ""),
    ("index.obj", meshes.obj(P, BAD_FACE), "9000"),
    ("negative.obj", meshes.obj(P, F) + b"f -1 -2 -9000\n", ""),
    ("words.obj", meshes.obj(P, F) + b"f one two three\n", ""),
    ("number.obj", b"v 0 0 nil\n" + meshes.obj(P, F), ""),
    ("points.obj", meshes.obj(P, []), "points"),
    ("infinite.obj", meshes.obj(P, F).replace(b"3.0", b"1e999"), ""),
    ("far.obj", meshes.obj(FAR, F), ""),
    ("empty.obj", b"# nothing\n", ""),
    ("cut.off", meshes.off(P, F)[:-20], ""),
    ("counts.off", b"OFF\nmany 2 0\n", ""),
    ("index.off", meshes.off(P, BAD_FACE), "9000"),
    ("nan.off", meshes.off(NAN_POINTS, F), ""),
    ("version.glb", GLB[:4] + struct.pack("<I", 7) + GLB[8:], ""),
    ("cut.glb", GLB[:-40], ""),
    ("chunk.glb", GLB[:12] + struct.pack("<I", 2**31) + GLB[16:], ""),
    ("broken.gltf", b'{"asset": {"version": "2.0"}, "meshes": [', ""),
    ("no_mesh.gltf", b'{"asset": {"version": "2.0"}}', ""),
    ("passwd.gltf", meshes.gltf(P, F, "../../../../../../etc/passwd"), ""),
    ("absolute.gltf", meshes.gltf(P, F, "/etc/passwd"), ""),
    ("url.gltf", meshes.gltf(P, F, "file:///etc/passwd"), ""),
    ("missing.gltf", meshes.gltf(P, F, "part.bin"), "part.bin"),
    ("base64.gltf", meshes.gltf(P, F, "data:application/octet-stream;base64,@@@"), ""),
    ("buffer.gltf", meshes.gltf(P, F, bufferViews=[{"buffer": 9, "byteLength": 12}] * 2), ""),
    ("nodes.gltf", meshes.gltf(P, F, nodes=[{"children": [0]}]), ""),
    ("text.3mf", b"no archive at all", ""),
    ("no_model.3mf", meshes.threemf(None), ""),
    ("xml.3mf", meshes.threemf(meshes.model(P, F)[:400]), ""),
    ("index.3mf", meshes.threemf(meshes.model(P, BAD_FACE)), "9000"),
    ("loop.3mf", meshes.threemf(LOOP), ""),
    ("cut.3mf", meshes.threemf(meshes.model(P, F))[:-40], ""),
    ("cut.stl.gz", gzip.compress(STL)[:-20], "unpacked"),
    ("corrupt.stl.bz2", bz2.compress(STL)[:30] + bytes(40), "unpacked"),
    ("corrupt.stl.xz", lzma.compress(STL)[:30] + bytes(40), "unpacked"),
    ("flat.off", meshes.off(P * [1, 0, 0], F), "area"),
    ("point.stl", meshes.stl(P * 0, F), "area"),
]  # fmt: skip


def zeros_archive(size: int) -> bytes:
    """A 3MF whose model is a beginning and then spaces, a thousandth of it in the archive."""
    return meshes.threemf(meshes.model(P, F)[:200] + " " * size)


def gz_bomb() -> bytes:
    """A gigabyte or so of zeros, made from few bytes: gzip members may follow each other."""
    return gzip.compress(bytes(16 << 20)) * 64


#: Small files that ask for much memory.
GREEDY = [
    ("claim.stl", lambda: STL[:80] + struct.pack("<I", 2**32 - 1) + STL[84:]),
    ("claim.ply", lambda: PLY.replace(b"vertex 26", b"vertex 1000000000000")),
    ("faces.ply", lambda: PLY.replace(b"face 48", b"face 4000000000")),
    ("list.ply", lambda: meshes.ply_header("ascii", 3, 1) + b"0 0 0\n" * 3 + b"4000000000 0 1 2\n"),
    ("claim.off", lambda: b"OFF\n4000000000 4000000000 0\n0 0 0\n"),
    ("chunk.glb", lambda: GLB[:8] + struct.pack("<II", 2**32 - 1, 2**32 - 4) + GLB[16:]),
    ("count.gltf", lambda: meshes.gltf(P, F).replace(b'"count": 26', b'"count": 4000000000')),
    ("length.gltf", lambda: meshes.gltf(P, F).replace(b'"byteLength"', b'"byteLength": 1, "x"')),
    ("bomb.3mf", lambda: zeros_archive(300 << 20)),
    ("bomb.stl.gz", gz_bomb),
]  # fmt: skip

#: Name, content, and the kind of repair that must be listed.
MENDED = [
    ("twice.off", meshes.off(P, [*F, F[0]]), "duplicate_faces"),
    ("sliver.off", meshes.off(P, [*F, [0, 0, 1]]), "zero_area_faces"),
    ("wound.off", meshes.off(P, [F[0][::-1], *F[1:]]), "flipped_faces"),
    ("open.off", meshes.off(P, F[1:]), "border_edges"),
    ("spare.off", meshes.off([*P, [9, 9, 9]], F), "unreferenced_vertices"),
    ("apart.off", meshes.off(P[F].reshape(-1, 3), np.arange(3 * len(F)).reshape(-1, 3)),
     "coincident_vertices"),
    ("fin.off", meshes.off([*P, [9, 9, 9]], [*F, [F[0][0], F[0][1], len(P)]]),
     "non_manifold_edges"),
    ("two.off", meshes.off([*P, *(P + 10)], [*F, *(F + len(P))]), "components"),
]  # fmt: skip


def one_line(text: str) -> str:
    assert "Traceback" not in text
    assert text.count("\n") == 1, text
    return text


@pytest.mark.parametrize(("name", "content", "words"), CONTENT, ids=[row[0] for row in CONTENT])
def test_a_bad_file_is_refused_in_one_line(
    name: str, content: bytes, words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / name).write_bytes(content)
    assert main(["segment", str(tmp_path / name), "-o", str(tmp_path / "out")]) == 3
    line = one_line(capsys.readouterr().err)
    assert name in line
    assert words in line
    assert sorted(path.name for path in tmp_path.iterdir()) == [name]


@pytest.mark.parametrize(("name", "make"), GREEDY, ids=[row[0] for row in GREEDY])
def test_a_file_that_asks_for_much_memory_is_refused_without_taking_it(
    name: str, make: object, tmp_path: Path
) -> None:
    assert callable(make)
    (tmp_path / name).write_bytes(make())

    def limit() -> None:
        # NumPy's own threads reserve most of this; the claims go far beyond it.
        resource.setrlimit(resource.RLIMIT_AS, (3 << 30, 3 << 30))

    command = [sys.executable, "-m", "quadrics", "segment", name, "-o", "out"]
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run(
        command, cwd=tmp_path, capture_output=True, text=True, check=False,
        preexec_fn=limit, timeout=60, env=environment,
    )  # fmt: skip
    assert done.returncode == 3, done.stderr
    one_line(done.stderr)


@pytest.mark.parametrize(("name", "content", "kind"), MENDED, ids=[row[0] for row in MENDED])
def test_a_faulty_mesh_is_mended_and_says_so(
    name: str, content: bytes, kind: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / name).write_bytes(content)
    assert main(["info", str(tmp_path / name), "--json"]) == 0
    assert kind in {repair["kind"] for repair in json.loads(capsys.readouterr().out)["repairs"]}
    out = tmp_path / "out"
    assert main(["segment", str(tmp_path / name), "-o", str(out), "--quiet"]) == 0
    result = json.loads((out / "segmentation.json").read_text())
    assert kind in {repair["kind"] for repair in result["repairs"]}
    labels = np.load(out / "labels.npy")
    assert labels.shape == (result["input"]["faces"],)
    assert labels.min() >= 0


def refused(path: str, capsys: pytest.CaptureFixture[str]) -> str:
    assert main(["info", path]) == 3
    return one_line(capsys.readouterr().err)


def test_no_file(capsys: pytest.CaptureFixture[str]) -> None:
    assert "no such file" in refused("nowhere.stl", capsys)


def test_a_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert "folder" in refused(str(tmp_path), capsys)


def test_a_pipe_is_not_waited_for(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    os.mkfifo(tmp_path / "pipe.stl")
    assert "regular" in refused(str(tmp_path / "pipe.stl"), capsys)


def test_a_device(capsys: pytest.CaptureFixture[str]) -> None:
    assert "regular" in refused("/dev/zero", capsys)


def test_a_link_to_itself(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "loop.stl").symlink_to("loop.stl")
    assert "cannot be read" in refused(str(tmp_path / "loop.stl"), capsys)


def test_a_name_that_is_too_long(capsys: pytest.CaptureFixture[str]) -> None:
    assert "cannot be read" in refused("x" * 5000 + ".stl", capsys)


def test_a_file_without_permission(
    part: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def refuse(path: Path) -> bytes:
        raise PermissionError(13, "Permission denied", str(path))

    # Tests may run as root, whom no mode keeps out.
    monkeypatch.setattr(Path, "read_bytes", refuse)
    assert "permission" in refused(str(part), capsys)


def test_a_link_out_of_the_folder_is_not_followed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    inside = tmp_path / "inside"
    inside.mkdir()
    _, data = meshes.gltf_parts(P, F)
    (tmp_path / "secret.bin").write_bytes(data)
    (inside / "part.bin").symlink_to("../secret.bin")
    (inside / "part.gltf").write_bytes(meshes.gltf(P, F, "part.bin"))
    refused(str(inside / "part.gltf"), capsys)
    (inside / "part.bin").unlink()
    (inside / "part.bin").write_bytes(data)
    assert quadrics.read(inside / "part.gltf").face_count == len(F)


def test_labels_that_are_no_array(part: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pickled = io.BytesIO()
    np.save(pickled, np.array([{}], object), allow_pickle=True)
    for content in (b"", b"not numpy", pickled.getvalue()):
        labels = part.with_name("labels.npy")
        labels.write_bytes(content)
        out = part.with_name("out")
        assert main(["segment", str(part), "-o", str(out), "--initial-labels", str(labels)]) == 3
        assert "labels.npy" in one_line(capsys.readouterr().err)
