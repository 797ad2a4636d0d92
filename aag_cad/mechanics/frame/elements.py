"""Euler-Bernoulli beam elements with St Venant torsion, many at a time; six local dofs at the start, then the end."""

from dataclasses import dataclass

import numpy as np

from aag_cad.mechanics.frame.model import DOFS, Dof, FrameElement, FrameError
from aag_cad.units import Floats, Ints

_PARALLEL = 1e-6
_LOOSE = 1e-12


@dataclass(frozen=True, eq=False)
class ElementArrays:
    """Elements as arrays: nodes (m, 2), lengths (m,), local axes as rows (m, 3, 3), stiffness of the ends (m, 12, 12).

    ``to_ends`` (m, 12, 12) takes the displacements of both nodes in global axes to those of the ends in local axes.
    ``stiffness`` is that after the releases; ``condensed`` (m, 12, 12) takes fixed-end forces to those after them.
    """

    nodes: Ints
    lengths: Floats
    axes: Floats
    stiffness: Floats
    condensed: Floats
    to_ends: Floats


def local_stiffness(rigidities: Floats, lengths: Floats) -> Floats:
    """Return the stiffness (m, 12, 12) of beams with rigidities EA, GJ, EI_y, EI_z (m, 4) and lengths (m,).

    Przemieniecki, Theory of Matrix Structural Analysis, eq. 5.116 without shear; local order x y z rx ry rz.
    """
    k = np.zeros((len(lengths), 12, 12))
    axial, twist, bend_y, bend_z = (rigidities / lengths[:, None]).T
    for dof, value in ((0, axial), (3, twist)):
        k[:, dof, dof] = k[:, dof + 6, dof + 6] = value
        k[:, dof, dof + 6] = k[:, dof + 6, dof] = -value
    # A positive rotation about y lowers z, about z it raises y: hence the sign of the coupling terms.
    for shift, turn, value, sign in ((2, 4, bend_y, -1.0), (1, 5, bend_z, 1.0)):
        across, mixed = 12.0 * value / lengths**2, sign * 6.0 * value / lengths
        for i, j, entry in (
            (shift, shift, across), (shift, turn, mixed), (shift, shift + 6, -across), (shift, turn + 6, mixed),
            (turn, turn, 4.0 * value), (turn, shift + 6, -mixed), (turn, turn + 6, 2.0 * value),
            (shift + 6, shift + 6, across), (shift + 6, turn + 6, -mixed), (turn + 6, turn + 6, 4.0 * value),
        ):  # fmt: skip
            k[:, i, j] = k[:, j, i] = entry
    return k


def even_load_forces(axes: Floats, length: float, force: Floats) -> Floats:
    """Return what an even load (3,) in global axes, N/mm, gives to the clamped ends of a beam, (12,) in local axes."""
    x, y, z = axes @ force * length / 2.0
    arm = length / 6.0
    return np.array([x, y, z, 0.0, -z * arm, y * arm, x, y, z, 0.0, z * arm, -y * arm])


def _axes(elements: tuple[FrameElement, ...], along: Floats, lengths: Floats) -> Floats:
    """Return the local axes (m, 3, 3) as rows x, y, z."""
    x = along / lengths[:, None]
    wish = np.array([element.direction for element in elements]).reshape(-1, 3)
    size = np.linalg.norm(wish, axis=1)
    z = wish - np.sum(wish * x, axis=1)[:, None] * x
    height = np.linalg.norm(z, axis=1)
    bad = np.flatnonzero(height <= _PARALLEL * size)
    if len(bad):
        raise FrameError(
            f"{elements[bad[0]].mark}: the direction of local z, {elements[bad[0]].direction}, runs along the element; "
            "give one across it"
        )
    z /= height[:, None]
    return np.stack([x, np.cross(z, x), z], axis=1)


def cross_matrices(arms: Floats) -> Floats:
    """Return S (m, 3, 3) with S w = w x arm for arms (m, 3): what a rotation w moves the end of an arm by."""
    s = np.zeros((len(arms), 3, 3))
    s[:, 0, 1], s[:, 0, 2], s[:, 1, 2] = arms[:, 2], -arms[:, 1], arms[:, 0]
    return s - s.transpose(0, 2, 1)


def _released(element: FrameElement, stiffness: Floats) -> tuple[Floats, Floats]:
    """Return stiffness and force condensation, (12, 12) each, of an element with releases."""
    places = (
        ((DOFS.index(d), d) for d in element.start_releases),
        ((6 + DOFS.index(d), d) for d in element.end_releases),
    )
    free: list[tuple[int, Dof]] = [pair for end in places for pair in end]
    gone = np.array([place for place, _ in free])
    inner = stiffness[np.ix_(gone, gone)]
    scale = 1.0 / np.sqrt(np.diag(inner))
    if np.linalg.eigvalsh(inner * np.outer(scale, scale)).min() < _LOOSE * len(gone):
        raise FrameError(
            f"{element.mark}: released {', '.join(name for _, name in free)}, so that the element alone moves freely; "
            "keep one of them at one end"
        )
    condensed = np.eye(12)
    condensed[:, gone] -= stiffness[:, gone] @ np.linalg.inv(inner)
    condensed[gone] = 0.0
    return condensed @ stiffness, condensed


def element_arrays(elements: tuple[FrameElement, ...], index: dict[str, int], points: Floats) -> ElementArrays:
    """Return elements as arrays; ``index`` gives the place of a node in ``points`` (n, 3) by its mark.

    FrameError that names the element: unknown node, no length, direction along it, releases that leave it loose.
    """
    for element in elements:
        for mark in (element.start, element.end):
            if mark not in index:
                raise FrameError(f"{element.mark}: its node {mark!r} is not in the model; add it")
    nodes = np.array([(index[e.start], index[e.end]) for e in elements], dtype=np.int64).reshape(-1, 2)
    arms = np.array([(e.start_offset, e.end_offset) for e in elements]).reshape(-1, 2, 3)
    ends = points[nodes] + arms
    along = ends[:, 1] - ends[:, 0]
    lengths = np.linalg.norm(along, axis=1)
    if len(lengths) and not lengths.min() > 0.0:
        raise FrameError(f"{elements[int(np.argmin(lengths))].mark}: length 0; more than 0 mm: merge its nodes")
    axes = _axes(elements, along, lengths)
    rigidities = np.array([
        (e.material.modulus * e.section.area, e.material.shear_modulus * e.section.torsion,
         e.material.modulus * e.section.inertia_y, e.material.modulus * e.section.inertia_z)
        for e in elements
    ]).reshape(-1, 4)  # fmt: skip
    stiffness = local_stiffness(rigidities, lengths)
    condensed = np.broadcast_to(np.eye(12), stiffness.shape).copy()
    for i, element in enumerate(elements):
        if element.start_releases or element.end_releases:
            stiffness[i], condensed[i] = _released(element, stiffness[i])
    to_ends = np.zeros((len(elements), 12, 12))
    for end in (0, 1):
        at = 6 * end
        to_ends[:, at : at + 3, at : at + 3] = to_ends[:, at + 3 : at + 6, at + 3 : at + 6] = axes
        to_ends[:, at : at + 3, at + 3 : at + 6] = axes @ cross_matrices(arms[:, end])
    return ElementArrays(nodes, lengths, axes, stiffness, condensed, to_ends)


def global_stiffness(arrays: ElementArrays) -> Floats:
    """Return the stiffness (m, 12, 12) of elements against the displacements of their nodes in global axes."""
    return np.asarray(arrays.to_ends.transpose(0, 2, 1) @ arrays.stiffness @ arrays.to_ends)
