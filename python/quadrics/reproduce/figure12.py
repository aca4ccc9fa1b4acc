"""Figure 12: Gaussian noise, and the mesh without it."""

from __future__ import annotations

from quadrics import synth
from quadrics.denoising import denoise, deviation
from quadrics.heat import heat_view
from quadrics.picture import plain_view, region_view
from quadrics.reproduce.data import Data
from quadrics.reproduce.section import Note, Pictures, Section, Table
from quadrics.run import segment

SIGMA = 0.003


def make(data: Data) -> Section:
    """Add noise to half of the vertices of five parts, segment, denoise, measure."""
    rows = []
    pictures: list[Pictures] = []
    for part in data.known():
        noisy = synth.noise(part.mesh, sigma=SIGMA, ratio=0.5, gaussian=True)
        result = segment(noisy)
        clean = denoise(noisy, result)
        before, after = deviation(noisy, part.mesh), deviation(clean, part.mesh)
        free = deviation(denoise(noisy, segment(noisy, constraints=False)), part.mesh)
        size = part.mesh.size
        for label, found in (("noisy", before), ("free", free), ("constrained", after)):
            cells = (f"{value / size:.6f}" for value in (found.hausdorff, found.mean))
            rows.append((part.name if found is before else "", label, *cells))
        if not pictures:
            most = float(before.of_vertex.max())
            scale = f"white: 0, black: {most / size:.4f} of the size"
            views = [
                ("clean", plain_view(part.mesh)),
                ("noisy", plain_view(noisy)),
                ("regions", region_view(result)),
                ("denoised", plain_view(clean)),
                (f"distance, noisy; {scale}", heat_view(noisy, before.of_vertex, most)),
                (f"distance, denoised; {scale}", heat_view(clean, after.of_vertex, most)),
            ]
            pictures.append(Pictures(views))
    words = (
        f"Gaussian noise of standard deviation {SIGMA} along the normals on half of the vertices; "
        "symmetric distances as Metro measures them, as fractions of the size. Free is denoised "
        "without geometric constraints, constrained with them."
    )
    table = Table(("part", "mesh", "Hausdorff", "mean"), rows)
    return Section("Figure 12: denoising", [table, Note(words), *pictures])
