"""The figures that tell whether a shell has its shape, and where to sling and to prop it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from aag_cad.parts.index import index_of
from aag_cad.parts.model import Shell, Stud
from aag_cad.units import Floats
from assembly.base.shell_axes import shell_view

_CORNERS = {"P1": (-1.0, -1.0), "P2": (1.0, -1.0), "P3": (-1.0, 0.3), "P4": (1.0, 0.3), "P5": (0.0, 1.0)}
_PAIRS = (
    ("P1", "P2"),
    ("P3", "P4"),
    ("P1", "P4"),
    ("P2", "P3"),
    ("P1", "P5"),
    ("P2", "P5"),
    ("P3", "P5"),
    ("P4", "P5"),
)
_SLINGS = ((-0.5, -0.4), (0.5, -0.4), (-0.5, 0.4), (0.5, 0.4))
_MIDDLE = ((-0.5, 0.0), (0.5, 0.0), (0.0, 0.0))
_TOP = ((-0.6, 0.8), (0.6, 0.8), (0.0, 1.0))


@dataclass(frozen=True)
class Control:
    """Names of control studs with their height above the foot line, and distances between pairs, mm."""

    studs: dict[str, str]
    heights: dict[str, float]
    distances: dict[tuple[str, str], float]


def _seen(shell: Shell) -> tuple[list[Stud], Floats]:
    """Return the studs and where they appear square on, (n, 2) from -1 to 1."""
    studs = sorted(shell.studs, key=lambda stud: stud.mark)
    flat = shell_view(shell)(np.array([stud.frame.origin for stud in studs]))[:, :2]
    low, high = flat.min(axis=0), flat.max(axis=0)
    return studs, 2.0 * (flat - low) / (high - low) - 1.0


def outer_end(stud: Stud) -> Floats:
    """Return the middle (3,) of the outer end of a stud, where the tape is held."""
    return np.array(stud.frame.origin) + stud.length / 2.0 * np.array(stud.frame.z)


def control_figures(shell: Shell) -> Control:
    """Return control studs at the corners and the crown of a shell with their heights and distances.

    Heights are those of the studs' outer ends over the lowest foot joint, where geodesic and bottom plank meet (z of
    the shell's coordinates); over the lowest joint of all where no geodesic has a foot.
    """
    studs, flat = _seen(shell)
    heights = [joint.point[2] for joint in shell.joints if joint.kind == "foot"]
    foot = min(heights or [joint.point[2] for joint in shell.joints])
    chosen: dict[str, Stud] = {}
    for name, corner in _CORNERS.items():
        left = [i for i, stud in enumerate(studs) if stud not in chosen.values()]
        if left:
            chosen[name] = studs[max(left, key=lambda i: (round(_reach(flat[i], corner), 6), studs[i].mark))]
    ends = {name: outer_end(stud) for name, stud in chosen.items()}
    pairs = [pair for pair in _PAIRS if set(pair) <= set(chosen)]
    return Control(
        studs={name: stud.mark for name, stud in chosen.items()},
        heights={name: float(end[2]) - foot for name, end in ends.items()},
        distances={(a, b): float(np.linalg.norm(ends[a] - ends[b])) for a, b in pairs},
    )


def _reach(place: Floats, corner: tuple[float, float]) -> float:
    return float(place @ np.array(corner)) - (abs(float(place[0])) if corner[0] == 0.0 else 0.0)


def _nearest(shell: Shell, places: Sequence[tuple[float, float]], taken: Sequence[str] = ()) -> tuple[str, ...]:
    """Return a stud for each place of the view square on, fewer if the shell has fewer studs that are not taken."""
    studs, flat = _seen(shell)
    chosen: list[str] = []
    for place in places:
        left = [i for i, stud in enumerate(studs) if stud.mark not in (*chosen, *taken)]
        if left:
            nearest = min(
                left, key=lambda i: (round(float(np.linalg.norm(flat[i] - np.array(place))), 6), studs[i].mark)
            )
            chosen.append(studs[nearest].mark)
    return tuple(chosen)


def sling_points(shell: Shell) -> tuple[str, ...]:
    """Return four studs about the middle of a shell to sling it by, fewer if it has fewer studs."""
    return _nearest(shell, _SLINGS)


def prop_points(shell: Shell) -> tuple[str, ...]:
    """Return the joints to prop a stiff shell at while nothing else but its feet holds it.

    Along each upper edge every second block of a beam, from the crown down; and three studs across the middle. Without
    upper edges three studs at the top stand for these.
    """
    footed = {mark for joint in shell.joints if joint.kind == "foot" for mark in joint.members}
    edges = [mark for mark in index_of(shell).edges if mark not in footed]
    found: list[str] = []
    for edge in edges:
        joints = [joint for joint in shell.joints if joint.kind == "boundary" and edge in joint.members]
        joints.sort(key=lambda joint: (-round(joint.point[2], 6), joint.mark))
        found += [joint.mark for joint in joints[::2]]
    top = () if found else _nearest(shell, _TOP)
    return (*dict.fromkeys(found), *top, *_nearest(shell, _MIDDLE, (*sling_points(shell), *top)))
