"""`segmentation.png`: the scan beside the surfaces that were recognised in it."""

from __future__ import annotations

import colorsys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from quadrics import _core
from quadrics.mesh import Mesh, normals_of
from quadrics.surfaces import FreeForm

if TYPE_CHECKING:
    from quadrics.result import Result

#: Pixels of one of the two views.
WIDTH, HEIGHT = 900, 800
#: From above, the front and the right: shows three sides of a box.
TOWARD_EYE = (0.55, -0.75, 0.5)
#: Of the scan, and of regions without a surface.
GREY = (205, 207, 211)


def write_picture(path: Path, result: Result, seen: Seen) -> None:
    """Draw both views and write the PNG; the same result gives the same bytes."""
    views = [_plain(seen), _regions(seen, result)]
    path.write_bytes(_core.encode_png(np.hstack(views)))


def plain_view(mesh: Mesh) -> NDArray[np.uint8]:
    """Draw a mesh in grey: pixels (HEIGHT, WIDTH, 3)."""
    return _plain(look(mesh))


def region_view(result: Result, shown: NDArray[np.bool_] | None = None) -> NDArray[np.uint8]:
    """Draw the regions in colours, with the normals of their surfaces; only `shown` triangles."""
    mesh = result.mesh
    if shown is None:
        return _regions(look(mesh), result)
    part = look(replace(mesh, faces=mesh.faces[shown]))
    faces = np.flatnonzero(shown).astype(np.uint32)[part.faces]
    return _regions(Seen(mesh, faces, part.samples), result)


@dataclass(frozen=True, eq=False)
class Seen:
    """What is seen of a mesh: only this is coloured, however many faces lie behind."""

    mesh: Mesh
    #: The faces that are seen, (k,), ascending.
    faces: NDArray[np.uint32]
    #: The place in `faces` of what every sample of the picture shows.
    samples: NDArray[np.uint32]

    def normals(self) -> NDArray[np.float64]:
        """Give the unit normals of `faces`, (k, 3)."""
        return normals_of(self.mesh.vertices, self.mesh.faces[self.faces])

    def draw(
        self,
        colours: NDArray[np.uint8],
        normals: NDArray[np.float64],
        labels: NDArray[np.int32],
    ) -> NDArray[np.uint8]:
        """Draw with a colour, a normal and a label for each of `faces`."""
        return _core.paint(self.samples, colours, normals, labels, TOWARD_EYE, WIDTH, HEIGHT)


def look(mesh: Mesh) -> Seen:
    """Find out what is seen of a mesh."""
    return Seen(mesh, *_core.see(mesh.vertices, mesh.faces, TOWARD_EYE, WIDTH, HEIGHT))


def _plain(seen: Seen) -> NDArray[np.uint8]:
    grey = np.tile(np.array(GREY, np.uint8), (len(seen.faces), 1))
    return seen.draw(grey, seen.normals(), np.zeros(len(seen.faces), np.int32))


def _regions(seen: Seen, result: Result) -> NDArray[np.uint8]:
    if len(result.regions) == 0:
        return _plain(seen)
    labels = result.triangle_labels[seen.faces]
    return seen.draw(region_colours(result)[labels], _surface_normals(seen, result, labels), labels)


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


def _surface_normals(seen: Seen, result: Result, labels: NDArray[np.int32]) -> NDArray[np.float64]:
    """Take normals of the surfaces, not of the noisy faces: what was recognised is smooth."""
    normals = seen.normals()
    middles = seen.mesh.vertices[seen.mesh.faces[seen.faces]].mean(axis=1)
    order = np.argsort(labels, kind="stable")
    ends = np.searchsorted(labels[order], np.arange(len(result.regions) + 1))
    for region in result.regions:
        faces = order[ends[region.id] : ends[region.id + 1]]
        if isinstance(region.surface, FreeForm) or len(faces) == 0:
            continue
        smooth = region.surface.normal(middles[faces])
        same_way = np.sign((smooth * normals[faces]).sum(axis=1))[:, None]
        known = np.isfinite(smooth).all(axis=1)
        normals[faces[known]] = (smooth * same_way)[known]
    return normals
