"""The minimum spanning tree of points, which no path along them undercuts."""

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import minimum_spanning_tree
from scipy.spatial import Delaunay

from aag_cad.units import Floats
from assembly.laying.walking import on_floor

_ONE_LINE = 1e-9


def spanning_tree_length(points: Floats) -> float:
    """Return the length of the minimum spanning tree of points (n, 2), mm: no path along them is shorter.

    It lies on the edges of their Delaunay triangulation (Preparata and Shamos 1985, section 6.1).
    """
    points = np.unique(on_floor(points), axis=0)
    if len(points) < 2:
        return 0.0
    centred = points - points.mean(axis=0)
    _, sizes, axes = np.linalg.svd(centred, full_matrices=False)
    if sizes.size < 2 or sizes[1] <= _ONE_LINE * sizes[0]:
        return float(np.ptp(centred @ axes[0]))
    corners = Delaunay(points).simplices
    a, b = np.vstack([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]).T
    pairs = np.unique(np.sort(np.column_stack([a, b]), axis=1), axis=0)
    lengths = np.hypot(*(points[pairs[:, 0]] - points[pairs[:, 1]]).T)
    graph = csr_array((lengths, (pairs[:, 0], pairs[:, 1])), shape=(len(points), len(points)))
    return float(minimum_spanning_tree(graph).sum())
