"""Small meshes with known surfaces, and writers of every format: plain, and slow."""

from __future__ import annotations

import base64
import io
import json
import struct
import zipfile
from typing import Any

import numpy as np
from numpy.typing import NDArray

Arrays = tuple[NDArray[np.float64], NDArray[np.int64]]


def box(n: int = 6, sides: tuple[float, float, float] = (3.0, 2.0, 1.0)) -> Arrays:
    """A closed box of 12 n^2 triangles, six planes, face by face."""
    grid = np.linspace(0, 1, n + 1)
    u, v = (values.ravel() for values in np.meshgrid(grid, grid, indexing="ij"))
    cell = np.arange(n)[:, None] * (n + 1) + np.arange(n)
    a, b, c, d = (cell + step for step in (0, n + 1, n + 2, 1))
    square = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    points: list[NDArray[np.float64]] = []
    faces: list[NDArray[np.int64]] = []
    for axis in range(3):
        for side in (0, 1):
            corners = np.zeros((len(u), 3))
            corners[:, axis] = side
            corners[:, (axis + 1) % 3], corners[:, (axis + 2) % 3] = u, v
            faces.append((square if side else square[:, ::-1]) + len(u) * len(points))
            points.append(corners)
    return weld(np.concatenate(points) * sides, np.concatenate(faces))


def rod(n: int = 48, m: int = 12, radius: float = 1.0, length: float = 4.0) -> Arrays:
    """A closed cylinder along z with two flat ends."""
    angle = 2 * np.pi * np.arange(n) / n
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    z = np.linspace(0, length, m + 1)
    wall = np.concatenate([np.column_stack([ring * radius, np.full(n, h)]) for h in z])
    i, j = np.meshgrid(np.arange(m), np.arange(n), indexing="ij")
    a, b = (i * n + j).ravel(), (i * n + (j + 1) % n).ravel()
    faces = [np.column_stack([a, b, b + n]), np.column_stack([a, b + n, a + n])]
    points, k = [wall], len(wall)
    for level, base in ((0.0, 0), (length, m * n)):
        half = np.column_stack([ring * radius / 2, np.full(n, level)])
        points += [half, np.array([[0.0, 0.0, level]])]
        at, after = np.arange(n), (np.arange(n) + 1) % n
        inner, middle = k, np.full(n, k + n)
        caps = [
            (base + at, inner + at, base + after),
            (base + after, inner + at, inner + after),
            (inner + at, middle, inner + after),
        ]
        faces += [np.column_stack(c if level == 0 else c[::-1]) for c in caps]
        k += n + 1
    return np.concatenate(points), np.concatenate(faces)


def turned(profile: NDArray[np.float64], n: int = 96) -> Arrays:
    """A closed solid about z by its profile: (radius, height) with the outside on the right."""
    angle = 2 * np.pi * np.arange(n) / n
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    rows = [np.column_stack([ring * r, np.full(n, h)]) for r, h in profile]
    poles = np.array([[0.0, 0.0, profile[0, 1]], [0.0, 0.0, profile[-1, 1]]])
    at, after = np.arange(n), (np.arange(n) + 1) % n
    faces = []
    for row in range(len(profile) - 1):
        a, b = row * n + at, row * n + after
        faces += [np.column_stack([a, b, b + n]), np.column_stack([a, b + n, a + n])]
    top, low = (len(profile) - 1) * n, np.full(n, len(profile) * n)
    faces += [np.column_stack([at, low, after]), np.column_stack([top + at, top + after, low + 1])]
    return np.concatenate([*rows, poles]), np.concatenate(faces)


def prism(outline: NDArray[np.float64], height: float) -> Arrays:
    """A closed prism as CAD programs write it: two triangles a side, ends as fans."""
    n = len(outline)
    points = np.concatenate([np.column_stack([outline, np.full(n, h)]) for h in (0.0, height)])
    at, after = np.arange(n), (np.arange(n) + 1) % n
    first, second, third = np.zeros(n - 2, int), np.arange(1, n - 1), np.arange(2, n)
    faces = [np.column_stack([at, after, after + n]), np.column_stack([at, after + n, at + n])]
    faces += [np.column_stack([first, third, second])]
    faces += [np.column_stack([first, second, third]) + n]
    return points, np.concatenate(faces)


def weld(points: NDArray[np.float64], faces: NDArray[np.int64]) -> Arrays:
    unique, inverse = np.unique(points.round(12), axis=0, return_inverse=True)
    return unique, inverse.ravel()[faces]


def stl(points: Any, faces: Any, header: bytes = b"") -> bytes:
    corners = np.asarray(points, "<f4")[np.asarray(faces)]
    rows = np.zeros(len(corners), [("n", "<f4", 3), ("p", "<f4", (3, 3)), ("a", "<u2")])
    rows["p"] = corners
    return header.ljust(80) + struct.pack("<I", len(rows)) + rows.tobytes()


def stl_ascii(points: Any, faces: Any) -> bytes:
    lines = ["solid part"]
    for face in np.asarray(points)[np.asarray(faces)]:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += [f"vertex {p[0]:.9g} {p[1]:.9g} {p[2]:.9g}" for p in face]
        lines += ["endloop", "endfacet"]
    return "\n".join([*lines, "endsolid part", ""]).encode()


def ply_header(kind: str, vertices: int, faces: int, scalar: str = "float") -> bytes:
    lines = ["ply", f"format {kind} 1.0", f"element vertex {vertices}"]
    lines += [f"property {scalar} {axis}" for axis in "xyz"]
    lines += [f"element face {faces}", "property list uchar int vertex_indices", "end_header", ""]
    return "\n".join(lines).encode()


def ply(points: Any, faces: Any, order: str = "<") -> bytes:
    kind = "binary_little_endian" if order == "<" else "binary_big_endian"
    body = np.asarray(points, order + "f4").tobytes()
    for face in faces:
        body += struct.pack(f"{order}B{len(face)}i", len(face), *face)
    return ply_header(kind, len(points), len(faces)) + body


def ply_ascii(points: Any, faces: Any) -> bytes:
    lines = [" ".join(map(str, map(float, p))) for p in points]
    lines += [" ".join(map(str, [len(f), *f])) for f in faces]
    return ply_header("ascii", len(points), len(faces)) + "\n".join([*lines, ""]).encode()


def obj(points: Any, faces: Any) -> bytes:
    lines = ["v " + " ".join(map(str, map(float, p))) for p in points]
    lines += ["f " + " ".join(str(v + 1) for v in f) for f in faces]
    return "\n".join([*lines, ""]).encode()


def off(points: Any, faces: Any) -> bytes:
    lines = ["OFF", f"{len(points)} {len(faces)} 0"]
    lines += [" ".join(map(str, map(float, p))) for p in points]
    lines += [" ".join(map(str, [len(f), *f])) for f in faces]
    return "\n".join([*lines, ""]).encode()


def gltf_parts(points: Any, faces: Any) -> tuple[dict[str, Any], bytes]:
    p, f = np.asarray(points, "<f4"), np.asarray(faces, "<u4")
    views = [{"buffer": 0, "byteOffset": 0, "byteLength": p.nbytes}]
    views.append({"buffer": 0, "byteOffset": p.nbytes, "byteLength": f.nbytes})
    accessors = [
        {"bufferView": 0, "componentType": 5126, "count": len(p), "type": "VEC3",
         "min": p.min(axis=0).tolist(), "max": p.max(axis=0).tolist()},
        {"bufferView": 1, "componentType": 5125, "count": f.size, "type": "SCALAR"},
    ]  # fmt: skip
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": accessors, "bufferViews": views,
        "buffers": [{"byteLength": p.nbytes + f.nbytes}],
    }  # fmt: skip
    return document, p.tobytes() + f.tobytes()


def gltf(points: Any, faces: Any, uri: str | None = None, **changes: Any) -> bytes:
    document, data = gltf_parts(points, faces)
    inline = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    document["buffers"][0]["uri"] = uri or inline
    return json.dumps({**document, **changes}).encode()


def glb(points: Any, faces: Any) -> bytes:
    document, data = gltf_parts(points, faces)
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", len(data), b"BIN\0") + data
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def model(points: Any, faces: Any) -> str:
    vertices = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in points)
    triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in faces)
    return (
        '<?xml version="1.0" encoding="UTF-8"?><model unit="millimeter" '
        'xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>'
        f'<object id="1" type="model"><mesh><vertices>{vertices}</vertices>'
        f"<triangles>{triangles}</triangles></mesh></object></resources>"
        '<build><item objectid="1"/></build></model>'
    )


def threemf(text: str | None, **entries: bytes) -> bytes:
    file = io.BytesIO()
    types = (
        '<?xml version="1.0" encoding="UTF-8"?>'
        '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
        '<Default Extension="rels" ContentType="'
        'application/vnd.openxmlformats-package.relationships+xml"/>'
        '<Default Extension="model" ContentType="'
        'application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>'
        "</Types>"
    )
    relations = (
        '<?xml version="1.0" encoding="UTF-8"?>'
        '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
        '<Relationship Target="/3D/3dmodel.model" Id="rel0" '
        'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'
    )
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("[Content_Types].xml", types)
        archive.writestr("_rels/.rels", relations)
        if text is not None:
            archive.writestr("3D/3dmodel.model", text)
        for name, content in entries.items():
            archive.writestr(name, content)
    return file.getvalue()
