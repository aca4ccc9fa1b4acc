"""Pictures of distances: every face in a colour by how far off it is."""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from quadrics.files import write_whole
from quadrics.mesh import Mesh
from quadrics.picture import HEIGHT, look

#: From nothing to the most: darker and redder, also for who sees no colours.
RAMP = np.array([(247, 247, 247), (253, 212, 158), (252, 141, 89), (179, 0, 0), (70, 0, 10)])
#: Height of the scale below the pictures.
SCALE = 60


def colours(values: NDArray[np.float64], most: float) -> NDArray[np.uint8]:
    """Colours (n, 3) of values (n,) between 0 and `most`."""
    place = np.clip(values / (most or 1.0), 0, 1) * (len(RAMP) - 1)
    steps = np.arange(len(RAMP))
    channels = [np.interp(place, steps, RAMP[:, channel]) for channel in range(3)]
    stacked: NDArray[np.uint8] = np.stack(channels, axis=-1).round().astype(np.uint8)
    return stacked


def heat_view(mesh: Mesh, of_vertex: NDArray[np.float64], most: float) -> NDArray[np.uint8]:
    """Draw one mesh: pixels (height, width, 3)."""
    seen = look(mesh)
    of_face = colours(of_vertex[mesh.faces[seen.faces]].mean(axis=1), most)
    return seen.draw(of_face, seen.normals(), np.zeros(len(seen.faces), np.int32))


def write_map(path: Path, views: Sequence[tuple[Mesh, NDArray[np.float64]]]) -> None:
    """Draw meshes side by side on one scale, up to the largest value of the first.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    from PIL import Image, ImageDraw

    most = float(views[0][1].max(initial=0.0))
    pixels = np.hstack([heat_view(mesh, values, most) for mesh, values in views])
    width = pixels.shape[1]
    bar = np.full((SCALE, width, 3), 255, np.uint8)
    ramp = colours(np.linspace(0, most, width // 2), most)
    bar[10:25, width // 4 : width // 4 + len(ramp)] = ramp
    image = Image.fromarray(np.vstack([pixels, bar]))
    draw = ImageDraw.Draw(image)
    for at, value in ((width // 4, 0.0), (width // 2, most / 2), (3 * width // 4, most)):
        draw.text((at, HEIGHT + 30), f"{value:.3g}", fill=(40, 40, 40), anchor="ma")
    content = BytesIO()
    image.save(content, format="PNG")
    write_whole(path, content.getvalue())
