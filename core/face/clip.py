"""Cut a triangle mesh along the zero line of a number given at every vertex."""

from __future__ import annotations

import numpy as np


def clip_mesh(
    triangles: np.ndarray, values: np.ndarray, inside: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Keep the part of a mesh where ``inside`` >= 0, with a clean edge of new vertices at zero.

    triangles : int, shape (T, 3)
    values : shape (V, c), whatever the vertices carry (positions, texture, displacements), linear along an edge
    inside : shape (V,)
    returns : triangles (T', 3), values (V', c), and for each new vertex the old one, -1 on the cut; old vertices
        keep their order and come first, unused ones are left out
    """
    keep = inside >= 0
    kept = keep[triangles].sum(axis=1)
    on_edge: dict[tuple[int, int], int] = {}
    extra: list[np.ndarray] = []

    def crossing(a: int, b: int) -> int:
        edge = (min(a, b), max(a, b))
        if edge not in on_edge:
            t = inside[edge[0]] / (inside[edge[0]] - inside[edge[1]])
            extra.append((1 - t) * values[edge[0]] + t * values[edge[1]])
            on_edge[edge] = len(values) + len(extra) - 1
        return on_edge[edge]

    result = triangles[kept == 3].tolist()
    for triangle in triangles[(kept == 1) | (kept == 2)].tolist():
        lone = next(i for i in range(3) if keep[triangle[i]] == (keep[triangle].sum() == 1))
        a, b, c = triangle[lone:] + triangle[:lone]
        ab, ca = crossing(a, b), crossing(c, a)
        result.extend([[a, ab, ca]] if keep[a] else [[ab, b, c], [ab, c, ca]])
    result = np.array(result, int).reshape(-1, 3)
    everything = np.concatenate([values, np.array(extra).reshape(-1, values.shape[1])])
    used = np.unique(result)
    renumbered = np.full(len(everything), -1)
    renumbered[used] = np.arange(len(used))
    return renumbered[result], everything[used], np.where(used < len(values), used, -1)
