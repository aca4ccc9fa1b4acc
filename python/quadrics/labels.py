"""From the triangles that the core sees back to the faces of the input."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from quadrics.mesh import Mesh


def labels_of_input(mesh: Mesh, of_triangle: NDArray[np.int32], regions: int) -> NDArray[np.int32]:
    """Give every polygon the label of most of its area; ties go to the lower label.

    A region that would vanish keeps the polygon in which it has most area, unless that is the
    last one of another region.
    """
    if mesh.parent is None or regions == 0:
        return of_triangle
    pair = mesh.parent.astype(np.int64) * regions + of_triangle
    pairs, inverse = np.unique(pair, return_inverse=True)
    area = np.bincount(inverse.ravel(), weights=mesh.areas())
    polygon, label = np.divmod(pairs, regions)
    labels = np.zeros(mesh.face_count, np.int32)
    # Ascending by area, descending by label: the last one written wins.
    order = np.lexsort((-label, area))
    labels[polygon[order]] = label[order]
    for region in np.setdiff1d(np.unique(label), np.unique(labels)):
        own = np.nonzero(label == region)[0]
        counts = np.bincount(labels, minlength=regions)
        spared = own[counts[labels[polygon[own]]] > 1]
        if spared.size:
            labels[polygon[spared[np.argmax(area[spared])]]] = region
    return labels
