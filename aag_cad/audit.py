"""Every check of a gridshell as a coded finding; nothing stops at the first."""

from collections import Counter
from collections.abc import Callable, Iterator
from typing import TypeAlias

import numpy as np

from aag_cad.design import Design
from aag_cad.findings import Finding, Severity, worst_first
from aag_cad.mechanics.checks.cover import FACADE_CHECKS
from aag_cad.mechanics.checks.fastener_spacing import shortfalls
from aag_cad.mechanics.checks.lamella import LamellaStress, lamella_stress
from aag_cad.mechanics.checks.supports import footing_checks
from aag_cad.parts.bolting import axis_distance, bolt_holes, bolts_by_joint
from aag_cad.parts.clash import clashes
from aag_cad.parts.index import index_of
from aag_cad.parts.marks import parse_mark, ridge_name
from aag_cad.parts.model import Gridshell, Shell, all_joints
from aag_cad.shop.purchases import Purchases
from aag_cad.units import Floats, deg_per_m

CONTACT = 1.0
TOUCH = 0.25
AXIS_TOLERANCE = 0.1
ANGLE_SPAN_DEG = 1.0
BOW = 1.0

Check: TypeAlias = Callable[[Design, Gridshell], Iterator[Finding]]


def forming_stresses(gridshell: Gridshell) -> list[LamellaStress]:
    """Return the forming stresses of every plank."""
    return [lamella_stress(plank, gridshell.timber) for plank in index_of(gridshell).planks.values()]


def forming_findings(design: Design, gridshell: Gridshell) -> Iterator[Finding]:
    """Yield AAG101 to AAG105: radius, twist, combined bending, torsion, edgewise stress (paper section 3)."""
    timber = gridshell.timber
    rules: tuple[tuple[str, Severity, str, Callable[[LamellaStress], float], float, str, str], ...] = (
        ("AAG101", "error", "smallest bending radius", lambda s: -s.smallest_radius, -timber.min_bending_radius, "mm",
         "flatten the surface there or take thinner planks"),
        ("AAG102", "error", "largest twist", lambda s: deg_per_m(s.largest_twist), design.timber.max_twist_deg_per_m,
         "deg/m", "flatten the surface there"),
        ("AAG103", "error", "bending and helix stress together", lambda s: s.combined, timber.bending_strength, "N/mm2",
         "flatten the surface there or take thinner planks"),
        ("AAG104", "warning", "torsion stress", lambda s: s.torsion, timber.shear_strength, "N/mm2",
         "take thinner planks; the limit f_v is that of EN 338, the paper twists further"),
        ("AAG105", "warning", "edgewise stress of forcing the unrolled plank straight", lambda s: s.edgewise,
         timber.bending_strength / 5.0, "N/mm2", "bring the beams nearer to the surface or take narrower planks"),
    )  # fmt: skip
    for stress in forming_stresses(gridshell):
        for code, severity, what, value, allowed, unit, remedy in rules:
            if value(stress) > allowed:
                yield Finding(code, severity, stress.mark, what, abs(value(stress)), abs(allowed), unit, remedy)


def hole_findings(_design: Design, gridshell: Gridshell) -> Iterator[Finding]:
    """Yield AAG201 to AAG207 of ``aag_cad.mechanics.checks.fastener_spacing``."""
    yield from shortfalls(gridshell)


def end_findings(design: Design, gridshell: Gridshell) -> Iterator[Finding]:
    """Yield AAG301: ends that reach further past their last joint than ``boundary.max_overhang``."""
    limit = design.boundary.max_overhang
    for plank in index_of(gridshell).planks.values():
        if not plank.joints:
            continue
        reach = max(plank.joints[0].station, plank.blank.length - plank.joints[-1].station)
        if reach > limit:
            remedy = "cut it back or add a joint"
            yield Finding("AAG301", "error", plank.mark, "an end past its last joint", reach, limit, "mm", remedy)


def clash_findings(_design: Design, gridshell: Gridshell) -> Iterator[Finding]:
    """Yield AAG401: parts that reach more than 1 mm into each other; AAG402: the deepest contact, where it is less."""
    found = clashes(gridshell, TOUCH)
    if found and found[0].depth <= CONTACT:
        mark = f"{found[0].first} and {found[0].second}"
        what = "the deepest contact of all parts, pressed into each other by"
        yield Finding("AAG402", "note", mark, what, found[0].depth, CONTACT, "mm", "nothing to do")
    for clash in found:
        if clash.depth <= CONTACT:
            break
        mark = f"{clash.first} and {clash.second}"
        x, y, z = clash.point
        where = f"run into each other at ({x:.0f}, {y:.0f}, {z:.0f}) by"
        yield Finding(
            "AAG401", "error", mark, where, clash.depth, CONTACT, "mm", "move the joint or cut one of them back"
        )


def joint_findings(_design: Design, gridshell: Gridshell) -> Iterator[Finding]:
    """Yield AAG501 (part without joint), AAG502 (joint whose part is missing) and AAG503 (joint without fastener)."""
    joints = all_joints(gridshell)
    named = {mark: joint.mark for joint in joints for mark in (*joint.members, *joint.fasteners)}
    present = index_of(gridshell).parts.keys()
    for mark in sorted(present - set(named)):
        yield Finding("AAG501", "error", mark, "joints", 0, 1, "", "give it a joint or leave it out")
    for mark in sorted(set(named) - present):
        what = f"is missing, but named by joint {named[mark]}; parts"
        yield Finding("AAG502", "error", mark, what, 0, 1, "", "add the part or mend the joint")
    for joint in joints:
        if not joint.fasteners:
            what = f"{joint.kind} joint of {' and '.join(joint.members)}: fasteners"
            yield Finding("AAG503", "note", joint.mark, what, 0, 1, "", "fix the plank ends with shoe, blade or screws")


def bolt_findings(_design: Design, gridshell: Gridshell) -> Iterator[Finding]:
    """Yield AAG601 (a hole off the axis of its bolt) and AAG602 (a bolt that does not pass one hole in each plank).

    A bolt of a beam passes both siblings, a bolt of steel the plank and the steel.
    """
    bolts = bolts_by_joint(gridshell)
    passed: Counter[str] = Counter()
    for mark, joint, station, centre in bolt_holes(gridshell):
        gap, bolt = min((axis_distance(axis, centre), name) for name, axis in bolts[joint].items())
        passed[bolt] += 1
        if gap > AXIS_TOLERANCE:
            what = f"hole at station {station:.1f} mm off the axis of {bolt} by"
            yield Finding("AAG601", "error", mark, what, gap, AXIS_TOLERANCE, "mm", "drill where the bolt passes")
    for name in sorted({name for named in bolts.values() for name in named}):
        if passed[name] != 2:
            remedy = "drill both parts that it joins"
            yield Finding("AAG602", "error", name, "holes on its axis", passed[name], 2, "", remedy)


def _node_angles_deg(shell: Shell) -> Floats:
    """Return the angles (n,) at which the two beams of each AA node cross, degrees up to 90."""
    spans = [np.ptp([hole.angle for hole in stud.holes]) for stud in shell.studs if stud.holes]
    return np.degrees([abs((span + np.pi / 2.0) % np.pi - np.pi / 2.0) for span in spans])


def angle_findings(_design: Design, gridshell: Gridshell) -> Iterator[Finding]:
    """Yield AAG701: AA nodes of a shell differ in angle, or are all alike but not at 60 degrees (paper, Fig. 3)."""
    for shell in gridshell.shells:
        angles = _node_angles_deg(shell)
        if not len(angles):
            continue
        low, high, off = float(angles.min()), float(angles.max()), float(np.abs(angles - 60.0).max())
        if high - low > ANGLE_SPAN_DEG:
            what = f"beams cross at {low:.1f} to {high:.1f} degrees, a span of"
            remedy = "one stud does not fill every node: optimise the web, or take a crpc surface"
            yield Finding("AAG701", "warning", shell.mark, what, high - low, ANGLE_SPAN_DEG, "deg", remedy)
        elif off > ANGLE_SPAN_DEG:
            what = f"beams cross at {low:.1f} to {high:.1f} degrees, off the equal angles of 60 degrees by"
            remedy = "a hexagonal stud does not lie flat against both beams: take a crpc surface of ratio 3"
            yield Finding("AAG701", "note", shell.mark, what, off, ANGLE_SPAN_DEG, "deg", remedy)


def boundary_findings(_design: Design, gridshell: Gridshell) -> Iterator[Finding]:
    """Yield AAG702: boundary planks along a curve that is no geodesic, so that no straight plank lies on it."""
    for plank in index_of(gridshell).edges.values():
        bow = lamella_stress(plank, gridshell.timber).bow
        if bow > BOW:
            what = "the boundary is no geodesic; unrolled, the plank leaves its chord by"
            remedy = "saw it curved from a wider board, or crop along a geodesic"
            yield Finding("AAG702", "warning", plank.mark, what, bow, BOW, "mm", remedy)


def support_findings(design: Design, gridshell: Gridshell) -> Iterator[Finding]:
    """Yield AAG801 and AAG802: concrete blocks too light for wind suction or for the thrust of the shell."""
    for check in footing_checks(design, gridshell):
        remedy = f"take blocks of {check.needed_mass:.0f} kg or more, or anchor them"
        for code, what, found in (
            ("AAG801", "blocks under wind suction, utilisation", check.uplift_utilisation),
            ("AAG802", "blocks sliding under own weight and snow, utilisation", check.sliding_utilisation),
        ):
            if found > 1.0:
                yield Finding(code, "warning", check.shell, what, found, 1.0, "", remedy)


def ridge_findings(design: Design, gridshell: Gridshell) -> Iterator[Finding]:
    """Yield AAG504: neighbouring shells that should meet in a ridge without a blade between them."""
    count = len(gridshell.shells)
    if count == 1 or design.shells.top == "level":
        return
    joined = {parse_mark(blade.mark).family for blade in gridshell.blades}
    for i in range(count):
        family = ridge_name(i + 1, (i + 1) % count + 1)
        if family not in joined:
            remedy = "make the ridge planks of the shells mirror images, or join them by hand"
            yield Finding("AAG504", "warning", family, "blades", 0, 1, "", remedy)


CHECKS: tuple[Check, ...] = (
    forming_findings,
    hole_findings,
    end_findings,
    clash_findings,
    joint_findings,
    bolt_findings,
    angle_findings,
    boundary_findings,
    support_findings,
    ridge_findings,
    *FACADE_CHECKS,
)


def audit(design: Design, gridshell: Gridshell, purchases: Purchases) -> list[Finding]:
    """Return the findings of all checks, errors first, then by code and mark."""
    found = [finding for check in CHECKS for finding in check(design, gridshell)]
    found += purchases.refused
    return list(worst_first(found))
