"""`segmentation.png`: the scan beside the surfaces that were recognised in it."""

from __future__ import annotations

import colorsys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from quadrics import _core
from quadrics.surfaces import FreeForm

if TYPE_CHECKING:
    from quadrics.mesh import Mesh
    from quadrics.result import Result

#: Pixels of one of the two views.
WIDTH, HEIGHT = 900, 800
#: From above, the front and the right: shows three sides of a box.
TOWARD_EYE = (0.55, -0.75, 0.5)
#: Of the scan, and of regions without a surface.
GREY = (205, 207, 211)


def write_picture(path: Path, result: Result) -> None:
    """Draw both views and write the PNG; the same result gives the same bytes."""
    from PIL import Image

    Image.fromarray(np.hstack([plain_view(result.mesh), region_view(result)])).save(path, "PNG")


def plain_view(mesh: Mesh) -> NDArray[np.uint8]:
    """Draw a mesh in grey: pixels (HEIGHT, WIDTH, 3)."""
    grey = np.tile(np.array(GREY, np.uint8), (len(mesh.faces), 1))
    return _draw(mesh, grey, mesh.normals(), np.zeros(len(mesh.faces), np.int32))


def region_view(result: Result, shown: NDArray[np.bool_] | None = None) -> NDArray[np.uint8]:
    """Draw the regions in colours, with the normals of their surfaces; only `shown` triangles."""
    if len(result.regions) == 0:
        return plain_view(result.mesh)
    labels, normals = result.triangle_labels, _surface_normals(result)
    colours, mesh = region_colours(result)[labels], result.mesh
    if shown is None:
        return _draw(mesh, colours, normals, labels)
    part = replace(mesh, faces=mesh.faces[shown])
    return _draw(part, colours[shown], normals[shown], labels[shown])


def region_colours(result: Result) -> NDArray[np.uint8]:
    """One colour a region, (k, 3); free-form regions are grey."""
    colours = [
        GREY if isinstance(region.surface, FreeForm) else _colour(region.id)
        for region in result.regions
    ]
    return np.array(colours, np.uint8).reshape(-1, 3)


def _colour(number: int) -> tuple[int, int, int]:
    # Turning by the golden ratio never comes near a hue that was used shortly before.
    hue = (number * 0.618033988749895 + 0.08) % 1
    red, green, blue = colorsys.hls_to_rgb(hue, (0.66, 0.54, 0.76)[number % 3], 0.62)
    return round(255 * red), round(255 * green), round(255 * blue)


def _draw(
    mesh: Mesh,
    colours: NDArray[np.uint8],
    normals: NDArray[np.float64],
    labels: NDArray[np.int32],
) -> NDArray[np.uint8]:
    return _core.render(
        mesh.vertices, mesh.faces, colours, normals, labels, TOWARD_EYE, WIDTH, HEIGHT
    )


def _surface_normals(result: Result) -> NDArray[np.float64]:
    """Take normals of the surfaces, not of the noisy faces: what was recognised is smooth."""
    mesh = result.mesh
    normals = mesh.normals()
    order = np.argsort(result.triangle_labels, kind="stable")
    ends = np.searchsorted(result.triangle_labels[order], np.arange(len(result.regions) + 1))
    for region in result.regions:
        if isinstance(region.surface, FreeForm):
            continue
        faces = order[ends[region.id] : ends[region.id + 1]]
        smooth = region.surface.normal(mesh.vertices[mesh.faces[faces]].mean(axis=1))
        same_way = np.sign((smooth * normals[faces]).sum(axis=1))[:, None]
        known = np.isfinite(smooth).all(axis=1)
        normals[faces[known]] = (smooth * same_way)[known]
    return normals
