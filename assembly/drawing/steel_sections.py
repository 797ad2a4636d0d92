"""Sections through the steel: a shoe on its concrete block, a strap at the upper edge, a blade across the ridge."""

from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from aag_cad.colours import LEGEND
from aag_cad.geometry.framed import frames_at
from aag_cad.language import Language, figure, say
from aag_cad.parts.forming import formed_points
from aag_cad.parts.forms import FoldedPlate, Frame
from aag_cad.parts.index import index_of
from aag_cad.parts.marks import shell_of
from aag_cad.parts.mesh import frame_matrix, moved
from aag_cad.parts.model import Blade, Bolt, FlatBar, Gridshell, Joint, Plank, Shell, Shoe, Strap
from aag_cad.parts.shapes.folded_plate import plate_rings
from aag_cad.parts.shapes.threaded import BoltPiece, bolt_form, rod_form
from aag_cad.units import Floats, vector
from assembly.drawing.joint_sections import callout
from assembly.drawing.names import family_name
from assembly.drawing.part_outlines import Flat
from assembly.drawing.svg import CHARACTER, Style, line, path, polygon, svg

_STEEL = Style(LEGEND["steel"], "#000", 1.0)
_BOLT = Style("#222", "#fff", 0.6)
_CONCRETE = Style(LEGEND["concrete"], "#000", 1.5)
_GROUND = Style("none", "#000", 2.5, "14 8")
_UNIT = 1.6
_SIZE = 34.0
_CHARACTERS = 22
_DEPTH = 140.0
_ALONG = 180.0
_ROOM = 75.0
_NEAR = np.eye(4)


def _word(language: Language, key: str, mark: str = "", **sizes: float) -> str:
    told = {name: figure(f"{size:g}", language) for name, size in sizes.items()}
    return say(language, f"pictures.steel.{key}", mark=mark, **told)


def _in_frame(frame: Frame) -> Flat:
    """Return the section along x and z of a frame: sheet units, z up the sheet, the frame's origin at (0, 0)."""
    axes = np.array([frame.x, frame.z])

    def flat(points: Floats) -> Floats:
        return np.asarray((points - np.array(frame.origin)) @ axes.T * [_UNIT, -_UNIT])

    return flat


def _band(bar: FlatBar, low: float, high: float) -> Floats:
    """Return the outline of a flat bar seen on its narrow edge between two stations, (n, 3)."""
    stations, half = np.linspace(low, high, 24), bar.blank.section.thickness / 2.0
    faces = [np.column_stack([stations, np.zeros(24), np.full(24, side)]) for side in (-half, half)]
    return formed_points(bar, np.concatenate([faces[0], faces[1][::-1]]))


def _cross(plank: Plank, joint: str, matrix: Floats = _NEAR) -> Floats:
    """Return the corners (4, 3) of the section of a plank where a joint sits on it."""
    station = next(place.station for place in plank.joints if place.joint == joint)
    y, z = plank.blank.section.width / 2.0, plank.blank.section.thickness / 2.0
    corners = [(station, -y, -z), (station, y, -z), (station, y, z), (station, -y, z)]
    return moved(formed_points(plank, np.array(corners)), matrix)


def _plate(plate: FoldedPlate) -> Floats:
    """Return the outline (n, 2) of a folded plate seen along its folds, in the frame's x and z, sheet units."""
    rings = plate_rings(plate)[:, :, [0, 2]] * [_UNIT, -_UNIT]
    return np.concatenate([rings[:, 1], rings[::-1, 2]])


def _pieces(pieces: Iterable[BoltPiece], frame: Frame, flat: Flat) -> Iterator[str]:
    """Yield the pieces of a bolt or rod as rectangles along its axis."""
    origin, axis = flat(np.array([frame.origin, np.add(frame.origin, frame.z)]))
    along = (axis - origin) / float(np.linalg.norm(axis - origin))
    across = np.array([-along[1], along[0]])
    for piece in pieces:
        low, high, half = (_UNIT * value for value in (piece.low, piece.high, piece.size / 2.0))
        corners = [(low, -half), (high, -half), (high, half), (low, half)]
        yield path(np.array([origin + a * along + b * across for a, b in corners]))


def _bolt_items(bolts: Sequence[Bolt], flat: Flat) -> Iterator[str]:
    for bolt in bolts:
        yield "".join(polygon_of(item, _BOLT) for item in _pieces(bolt_form(bolt).pieces, bolt.frame, flat))


def polygon_of(item: str, style: Style) -> str:
    """Return a path painted by a style."""
    return f'<g fill="{style.fill}" stroke="{style.stroke}" stroke-width="{style.width:g}">{item}</g>'


def _sheet(items: Sequence[str], points: Floats, words: Sequence[tuple[Floats, str]]) -> str:
    """Return items round the points (n, 2) of what must be seen, moved on to a sheet, with words at the right."""
    low, high = points.min(axis=0) - 12.0, points.max(axis=0) + 12.0
    moved = f'<g transform="translate({-low[0]:.1f} {-low[1]:.1f})">{"".join(items)}</g>'
    width, height = (high - low).tolist()
    longest = max([_CHARACTERS, *(len(text) + 2 for _, text in words)]) if words else 0
    reach = width + longest * CHARACTER * _SIZE
    order = sorted(range(len(words)), key=lambda i: float(words[i][0][1]))
    told: list[str] = []
    for place, i in enumerate(order):
        (x, y), text = (words[i][0] - low).tolist(), words[i][1]
        told += callout(width + 14.0, height * (place + 0.5) / len(words), x, y, text, _SIZE)
    return svg(reach, height, [moved, *told])


def _timber(outlines: Iterable[Floats], planks: Iterable[Plank]) -> Iterator[str]:
    """Yield the sections of planks in the colours of their families."""
    for outline, plank in zip(outlines, planks, strict=True):
        yield polygon(outline, Style(LEGEND[plank.family], "#000", 1.5))


def _members(shell: Shell, joint: Joint) -> list[Plank]:
    planks = index_of(shell).planks
    return [planks[mark] for mark in joint.members if mark in planks]


def foot_section_svg(shell: Shell, shoe: Shoe, named: bool, *, language: Language = "en") -> str:
    """Return the section through a foot across the edge of the shell, outside at the right, at 1 : 6.

    ``named`` says whether words name its parts.
    """
    joint = index_of(shell).joints[shoe.mark]
    stands = next(joint for joint in shell.joints if joint.kind == "footing" and shoe.mark in joint.members)
    rod = next(rod for rod in shell.rods if rod.mark in stands.fasteners)
    footing = next(footing for footing in shell.footings if footing.mark in stands.members)
    geodesic, edge = _members(shell, joint)
    flat, bolts = _in_frame(shoe.frame), [bolt for bolt in shell.bolts if bolt.mark in joint.fasteners]
    top = flat(np.array([footing.frame.origin]))[0]
    side, deep = _UNIT * footing.length / 2.0, _UNIT * _DEPTH
    block = np.array([(-side, 0.0), (side, 0.0), (side, deep), (-side, deep)]) + top
    timber = [flat(_band(geodesic, 0.0, _ALONG)), flat(_cross(edge, joint.mark))]
    plate = _plate(shoe.plate)
    upright = np.mean(shoe.plate.line[-3:-1], axis=0) * [_UNIT, -_UNIT]
    items = [
        polygon(block, _CONCRETE),
        *_timber(timber, (geodesic, edge)),
        polygon(plate, _STEEL),
        *(polygon_of(item, _BOLT) for item in _pieces(rod_form(rod).pieces, rod.frame, flat)),
        *_bolt_items(bolts, flat),
        line(np.array([(top[0] - side - 60.0, top[1]), (top[0] + side + 60.0, top[1])]), _GROUND),
    ]
    words = [
        (timber[0].mean(axis=0), family_name(geodesic.family, language)),
        (timber[1].mean(axis=0), _word(language, "bottom")),
        (upright, _word(language, "shoe", thick=shoe.plate.thickness)),
        (
            flat(np.array([rod.frame.origin]))[0] - [0.0, _UNIT * rod.nuts[1]],
            _word(language, "rod", diameter=rod.diameter),
        ),
        (block[1:3].mean(axis=0), _word(language, "footing")),
    ]
    return _sheet(items, np.concatenate([block, *timber, plate]), words if named else [])


def strap_section_svg(shell: Shell, strap: Strap, *, language: Language = "en") -> str:
    """Return the section along a strap: end of the geodesic, edge plank, bolts; outside above, at 1 : 6."""
    joint = index_of(shell).joints[strap.mark]
    geodesic, edge = _members(shell, joint)
    along = frames_at(strap.curve, np.array([strap.curve.length / 2.0])).tangent[0]
    normal = np.array(joint.normal)
    x = along - (along @ normal) * normal
    x = x / float(np.linalg.norm(x))
    frame = Frame(joint.point, vector(x), vector(np.cross(normal, x)), vector(normal))
    flat, bolts = _in_frame(frame), [bolt for bolt in shell.bolts if bolt.mark in joint.fasteners]
    end = geodesic.blank.length
    timber = [flat(_band(geodesic, end - _ALONG, end)), flat(_cross(edge, joint.mark))]
    steel, middle = flat(_band(strap, 0.0, strap.curve.length)), strap.curve.length / 2.0
    items = [*_timber(timber, (geodesic, edge)), polygon(steel, _STEEL), *_bolt_items(bolts, flat)]
    words = [
        (timber[0].mean(axis=0), family_name(geodesic.family, language)),
        (timber[1].mean(axis=0), family_name(edge.family, language)),
        (
            flat(_band(strap, middle, middle))[0],
            _word(language, "strap", thick=strap.blank.section.thickness),
        ),
    ]
    reach = np.array([(0.0, -_ROOM), (0.0, _ROOM)])
    return _sheet(items, np.concatenate([*timber, steel, reach]), words)


def blade_section_svg(gridshell: Gridshell, blade: Blade, *, language: Language = "en") -> str:
    """Return the section across a ridge at a blade, at 1 : 6."""
    joint = index_of(gridshell).joints[blade.mark]
    index = index_of(gridshell)
    flat, bolts = _in_frame(blade.frame), [bolt for bolt in gridshell.bolts if bolt.mark in joint.fasteners]
    planks = [index.planks[mark] for mark in joint.members if mark in index.planks]
    matrices = [frame_matrix(index.shells[shell_of(plank.mark)].placement) for plank in planks]
    timber = [flat(_cross(plank, joint.mark, matrix)) for plank, matrix in zip(planks, matrices, strict=True)]
    plate = _plate(blade.plate)
    items = [*_timber(timber, planks), polygon(plate, _STEEL), *_bolt_items(bolts, flat)]
    words = [(outline.mean(axis=0), plank.mark) for outline, plank in zip(timber, planks, strict=True)]
    told = _word(language, "blade", mark=blade.mark, thick=blade.plate.thickness)
    words.append((plate[len(plate) // 4], told))
    reach = np.array([(0.0, -_ROOM), (0.0, _ROOM)])
    return _sheet(items, np.concatenate([*timber, plate, reach]), words)
