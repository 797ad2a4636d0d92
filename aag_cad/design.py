"""The design file: what a designer writes, validated before anything is built."""

import math
import tomllib
from collections.abc import Iterator
from typing import Any

import numpy as np
from pydantic import ValidationError, model_validator

from aag_cad.design_base import DesignTable
from aag_cad.design_making import Boundary, Crew, Facade, Joints, Ridge, Stock, Supports, Timber, Transport
from aag_cad.design_tables import (
    LevelShells,
    Optimise,
    Pattern,
    Project,
    ShellsSection,
    Site,
    SplineSurface,
    SurfaceSection,
)
from aag_cad.errors import DesignError
from aag_cad.resources import shipped_text

# A hexagon turned by 30 degrees is wider by 1 / cos 30: between 60 degree nodes and that, a stud has to be thinner.
_LEAST_FLATS = math.cos(math.radians(30.0))
_KINDS = {"surface": ("profile", "crpc, catenoid, hyperboloid, arc, spline"), "shells": ("top", "ridge, mirror, level")}


class Design(DesignTable):
    """One design file."""

    project: Project
    surface: SurfaceSection
    shells: ShellsSection
    pattern: Pattern
    timber: Timber
    joints: Joints
    boundary: Boundary
    facade: Facade
    ridge: Ridge = Ridge()
    supports: Supports
    transport: Transport
    crew: Crew
    stock: Stock = Stock()
    optimise: Optimise | None = None
    site: Site | None = None

    @model_validator(mode="after")
    def _fits_together(self) -> "Design":
        broken = [
            *self._level_faults(),
            *self._shell_faults(),
            *self._joint_faults(),
            *self._boundary_faults(),
            *self._facade_faults(),
            *self._stock_faults(),
        ]
        if broken:
            raise ValueError("\n".join(broken))
        return self

    def _shell_faults(self) -> Iterator[str]:
        shells, limit = self.shells, 180.0 - 360.0 / self.shells.count
        if self.optimise is not None and shells.top != "ridge":
            what = f"only shells with shells.top = 'ridge' are optimised, not {shells.top!r}"
            yield f"optimise: {what}; leave the table out"
        if shells.top == "ridge" and shells.sector_deg > limit:
            yield (
                f"shells.sector_deg: {shells.sector_deg:g} is too wide for {shells.count} shells; "
                f"at most {limit:g}, or neighbouring shells rise again beyond the entry: narrow the sector"
            )
        if self.ground_spacing <= self.timber.width:
            yield (
                f"pattern.geodesics: {self.pattern.geodesics} planks of {self.timber.width:g} mm stand "
                f"{self.ground_spacing:.0f} mm apart on the ground line and overlap; use fewer geodesics or a wider "
                "shells.sector_deg"
            )

    def _joint_faults(self) -> Iterator[str]:
        joints, width, thickness = self.joints, self.timber.width, self.timber.thickness
        bolt, hole, offset = joints.bolt_diameter, joints.bolt_hole, joints.bolt_offset
        if thickness >= joints.gap:
            yield (
                f"timber.thickness: {thickness:g} mm is not thinner than joints.gap {joints.gap:g} mm; choose a "
                "thinner plank or a wider gap"
            )
        if thickness >= width:
            yield f"timber.thickness: {thickness:g} mm is not less than timber.width {width:g} mm; swap the two"
        if not _LEAST_FLATS * joints.gap <= joints.stud_across_flats <= joints.gap:
            yield (
                f"joints.stud_across_flats: {joints.stud_across_flats:g} mm does not fill joints.gap {joints.gap:g} "
                f"mm; make them equal, or at least {_LEAST_FLATS * joints.gap:.1f} mm where beams do not cross at 60 "
                "degrees"
            )
        if not bolt <= hole <= bolt + 1.0:
            yield (
                f"joints.bolt_hole: {hole:g} mm for a bolt of {bolt:g} mm; EN 1995-1-1, 10.4.3 allows the diameter to "
                "the diameter + 1 mm"
            )
        if joints.screw_diameter > joints.screw_hole:
            yield _narrow_hole("joints", joints.screw_hole, joints.screw_diameter)
        if 2 * offset + hole >= width:
            yield (
                f"joints.bolt_offset: {offset:g} mm puts the holes outside the plank of {width:g} mm width; "
                f"at most {(width - hole) / 2:g}"
            )
        if hole >= 2 * offset:
            yield f"joints.bolt_offset: {offset:g} mm lets two holes of {hole:g} mm run into each other; make it larger"
        if joints.stud_hole != "round" and joints.slot_length <= 0.0:
            yield "joints.slot_length: 0 mm makes no slot; more than 0, or joints.stud_hole = 'round'"
        if hole + joints.stud_slot > 3.0 * bolt:
            yield (
                f"joints.slot_length: {joints.slot_length:g} mm makes a slot longer than its washer of 3 d "
                f"(EN 1995-1-1, 10.4.3); at most {3.0 * bolt - hole:g}"
            )
        if not thickness < joints.screw_length < thickness + width:
            yield (
                f"joints.screw_length: {joints.screw_length:g} mm does not end inside the coupling block; "
                f"allowed {thickness:g} to {thickness + width:g}"
            )
        if joints.stud_length < (least := 2.0 * (self.layer_offset + offset + hole)):
            yield (
                f"joints.stud_length: {joints.stud_length:g} mm does not hold the bolts of both layers; "
                f"at least {least:g}"
            )
        if joints.block_length < 8.0 * bolt:
            yield (
                f"joints.block_length: {joints.block_length:g} mm leaves the bolt less than 4 d to the block's "
                f"ends (EN 1995-1-1, table 8.4); at least {8.0 * bolt:g}"
            )

    def _boundary_faults(self) -> Iterator[str]:
        boundary, least = self.boundary, self.timber.width / 2 + self.boundary.ridge_gap
        if boundary.end_overhang > boundary.max_overhang:
            yield (
                f"boundary.end_overhang: {boundary.end_overhang:g} mm is more than boundary.max_overhang "
                f"{boundary.max_overhang:g} mm"
            )
        if boundary.ridge_setback < least:
            yield (
                f"boundary.ridge_setback: {boundary.ridge_setback:g} mm leaves no room for half a plank and "
                f"boundary.ridge_gap; at least {least:g}"
            )

    def _stock_faults(self) -> Iterator[str]:
        stock, thickness = self.stock, self.timber.thickness
        needed = stock.planks_per_board * thickness + (stock.planks_per_board - 1) * stock.split_kerf
        if stock.board_thickness is not None and stock.board_thickness < needed:
            yield (
                f"stock.board_thickness: {stock.board_thickness:g} mm does not give {stock.planks_per_board} planks of "
                f"timber.thickness {thickness:g} mm; at least {needed:g}"
            )
        for key in ("lengths", "bar_lengths", "metal_lengths"):
            shortest = min(getattr(stock, key))
            if shortest <= 2.0 * stock.trim:
                yield (
                    f"stock.{key}: nothing is left of {shortest:g} mm after stock.trim {stock.trim:g} mm at each end; "
                    f"more than {2.0 * stock.trim:g}"
                )

    def _facade_faults(self) -> Iterator[str]:
        facade = self.facade
        if not facade.cover:
            return
        if facade.build_up >= facade.screw_length:
            yield (
                f"facade.screw_length: {facade.screw_length:g} mm does not reach the coupling block under mullion, "
                f"tapes, sheet and clamp; more than {facade.build_up:g}"
            )
        for name, (width, thickness) in (("mullion", facade.mullion), ("clamp", facade.clamp)):
            if thickness >= width:
                yield (
                    f"facade.{name}: {thickness:g} mm is not less than the width {width:g} mm; give [width, thickness]"
                )
        half = min(facade.mullion[0], facade.clamp[0]) / 2
        if not facade.screw_hole / 2 <= facade.edge_gap < half:
            yield (
                f"facade.edge_gap: {facade.edge_gap:g} mm; more than half of facade.screw_hole "
                f"({facade.screw_hole / 2:g}), or the screws hit the sheets, and less than half the width of mullion "
                f"and clamp ({half:g}), or these do not hold them"
            )
        if facade.screw_diameter > facade.screw_hole:
            yield _narrow_hole("facade", facade.screw_hole, facade.screw_diameter)

    def _level_faults(self) -> Iterator[str]:
        shells = self.shells
        if not isinstance(shells, LevelShells) or shells.count == 1:
            return
        if shells.sector_deg > 180.0:
            yield (
                f"shells.sector_deg: {shells.sector_deg:g} for {shells.count} shells that stand apart; at most 180, "
                "or shells.count = 1"
            )
        if shells.axis_distance <= 0.0:
            yield (
                f"shells.axis_distance: 0 puts all {shells.count} shells in one place; enlarge it or take "
                "shells.count = 1"
            )

    @property
    def closed(self) -> bool:
        """Whether the shell runs all the way round its axis, without side planks."""
        return self.shells.sector_deg == 360.0

    @property
    def bottom_height(self) -> float:
        """Height of the bottom edge over the neck or ground line of the surface, mm; not positive."""
        return self.shells.bottom_height if isinstance(self.shells, LevelShells) else 0.0

    @property
    def step(self) -> float:
        """Angle between neighbouring geodesics about the shell's axis, radians."""
        return math.radians(self.shells.sector_deg) / (self.pattern.geodesics - (0 if self.closed else 1))

    @property
    def ground_spacing(self) -> float:
        """Distance between neighbouring geodesics on the ground line, mm."""
        if isinstance(self.surface, SplineSurface):
            radii, heights = zip(*self.surface.points, strict=True)
            return self.step * float(np.interp(0.0, heights, radii))
        return self.step * self.surface.neck_radius

    @property
    def half_sector(self) -> float:
        """Half of the sector, radians."""
        return math.radians(self.shells.sector_deg) / 2.0

    @property
    def layer_offset(self) -> float:
        """Distance of the centre of the beams from the surface along its normal, mm."""
        return (self.timber.width + self.timber.thickness) / 2.0

    @property
    def sibling_offset(self) -> float:
        """Distance of the centre of each sibling plank from the centre of its beam, mm."""
        return (self.joints.gap + self.timber.thickness) / 2.0


def _narrow_hole(table: str, hole: float, screw: float) -> str:
    return f"{table}.screw_hole: {hole:g} mm is narrower than {table}.screw_diameter {screw:g} mm"


def _explain(error: ValidationError) -> str:
    """Return one line per fault: the key's path, what was found, what is allowed."""
    lines = []
    for fault in error.errors():
        # Surfaces and shells are told apart by a key; its value is in the location of a fault but not in the file.
        place = [str(part) for i, part in enumerate(fault["loc"]) if not (i == 1 and fault["loc"][0] in _KINDS)]
        path = ".".join(place)
        if not path:
            lines.append(str(fault["msg"]).removeprefix("Value error, "))
        elif fault["type"] == "extra_forbidden":
            lines.append(f"{path}: unknown key; remove it or check its spelling (`aag schema` lists all keys)")
        elif fault["type"] == "union_tag_not_found":
            key, kinds = _KINDS[path]
            lines.append(f"{path}.{key}: missing; one of {kinds}")
        elif fault["type"] == "union_tag_invalid":
            key, kinds = _KINDS[path]
            lines.append(f"{path}.{key}: {fault['input'].get(key)!r} is none of {kinds}")
        elif fault["type"] == "missing":
            lines.append(f"{path}: missing; `aag new` writes a commented file that has it")
        else:
            lines.append(f"{path}: {fault['msg']}, found {fault['input']!r}")
    return "\n".join(lines)


def parse_design(text: str, source: str = "design") -> Design:
    """Return the design in a TOML text; DesignError with every fault's key path, value and allowed range."""
    if not text.strip():
        raise DesignError(f"{source}: the file is empty; `aag new NAME` writes a commented design to start from")
    try:
        data: dict[str, Any] = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise DesignError(f"{source}: not valid TOML: {error}") from error
    try:
        return Design.model_validate(data)
    except ValidationError as error:
        raise DesignError(f"{source}:\n{_explain(error)}") from error


def design_text(name_or_path: str) -> str:
    """Return the text of a shipped design or of a file; FileError if neither can be read."""
    return shipped_text("designs", ".toml", name_or_path, "design")


def load_design(name_or_path: str) -> Design:
    """Return the design of a shipped name or of a TOML file; FileError or DesignError if it cannot be had."""
    return parse_design(design_text(name_or_path), name_or_path)
