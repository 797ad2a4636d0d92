"""The design file: what a designer writes, validated before anything is built."""

import math
import tomllib
from typing import Any, TypeAlias

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


# What must hold, and what to say where it does not.
Rules: TypeAlias = tuple[tuple[bool, str], ...]


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
        rules = (
            *self._level_rules(),
            *self._shell_rules(),
            *self._joint_rules(),
            *self._boundary_rules(),
            *self._facade_rules(),
            *self._stock_rules(),
        )
        broken = [text for holds, text in rules if not holds]
        if broken:
            raise ValueError("\n".join(broken))
        return self

    def _shell_rules(self) -> Rules:
        limit = 180.0 - 360.0 / self.shells.count
        return (
            (
                self.optimise is None or self.shells.top == "ridge",
                f"optimise: only shells with shells.top = 'ridge' are optimised, not {self.shells.top!r}; leave the "
                "table out",
            ),
            (
                self.shells.top != "ridge" or self.shells.sector_deg <= limit,
                f"shells.sector_deg: {self.shells.sector_deg:g} is too wide for {self.shells.count} shells; "
                f"at most {limit:g}, or neighbouring shells rise again beyond the entry: narrow the sector",
            ),
            (
                self.ground_spacing > self.timber.width,
                f"pattern.geodesics: {self.pattern.geodesics} planks of {self.timber.width:g} mm stand "
                f"{self.ground_spacing:.0f} mm apart on the ground line and overlap; use fewer geodesics or a wider "
                "shells.sector_deg",
            ),
        )

    def _joint_rules(self) -> Rules:
        return (
            (
                self.timber.thickness < self.joints.gap,
                f"timber.thickness: {self.timber.thickness:g} mm is not thinner than joints.gap "
                f"{self.joints.gap:g} mm; choose a thinner plank or a wider gap",
            ),
            (
                self.timber.thickness < self.timber.width,
                f"timber.thickness: {self.timber.thickness:g} mm is not less than timber.width "
                f"{self.timber.width:g} mm; swap the two",
            ),
            (
                _LEAST_FLATS * self.joints.gap <= self.joints.stud_across_flats <= self.joints.gap,
                f"joints.stud_across_flats: {self.joints.stud_across_flats:g} mm does not fill joints.gap "
                f"{self.joints.gap:g} mm; make them equal, or at least {_LEAST_FLATS * self.joints.gap:.1f} mm where "
                "beams do not cross at 60 degrees",
            ),
            (
                self.joints.bolt_diameter <= self.joints.bolt_hole <= self.joints.bolt_diameter + 1.0,
                f"joints.bolt_hole: {self.joints.bolt_hole:g} mm for a bolt of {self.joints.bolt_diameter:g} mm; "
                "EN 1995-1-1, 10.4.3 allows the diameter to the diameter + 1 mm",
            ),
            (
                self.joints.screw_diameter <= self.joints.screw_hole,
                f"joints.screw_hole: {self.joints.screw_hole:g} mm is narrower than joints.screw_diameter "
                f"{self.joints.screw_diameter:g} mm",
            ),
            (
                2 * self.joints.bolt_offset + self.joints.bolt_hole < self.timber.width,
                f"joints.bolt_offset: {self.joints.bolt_offset:g} mm puts the holes outside the plank of "
                f"{self.timber.width:g} mm width; at most {(self.timber.width - self.joints.bolt_hole) / 2:g}",
            ),
            (
                self.joints.bolt_hole < 2 * self.joints.bolt_offset,
                f"joints.bolt_offset: {self.joints.bolt_offset:g} mm lets two holes of {self.joints.bolt_hole:g} mm "
                "run into each other; make it larger",
            ),
            (
                self.joints.stud_hole == "round" or self.joints.slot_length > 0.0,
                "joints.slot_length: 0 mm makes no slot; more than 0, or joints.stud_hole = 'round'",
            ),
            (
                self.joints.bolt_hole + self.joints.stud_slot <= 3.0 * self.joints.bolt_diameter,
                f"joints.slot_length: {self.joints.slot_length:g} mm makes a slot longer than its washer of 3 d "
                f"(EN 1995-1-1, 10.4.3); at most {3.0 * self.joints.bolt_diameter - self.joints.bolt_hole:g}",
            ),
            (
                self.timber.thickness < self.joints.screw_length < self.timber.thickness + self.timber.width,
                f"joints.screw_length: {self.joints.screw_length:g} mm does not end inside the coupling block; "
                f"allowed {self.timber.thickness:g} to {self.timber.thickness + self.timber.width:g}",
            ),
            (
                self.joints.stud_length >= 2.0 * (self.layer_offset + self.joints.bolt_offset + self.joints.bolt_hole),
                f"joints.stud_length: {self.joints.stud_length:g} mm does not hold the bolts of both layers; at least "
                f"{2.0 * (self.layer_offset + self.joints.bolt_offset + self.joints.bolt_hole):g}",
            ),
            (
                self.joints.block_length >= 8.0 * self.joints.bolt_diameter,
                f"joints.block_length: {self.joints.block_length:g} mm leaves the bolt less than 4 d to the block's "
                f"ends (EN 1995-1-1, table 8.4); at least {8.0 * self.joints.bolt_diameter:g}",
            ),
        )

    def _boundary_rules(self) -> Rules:
        return (
            (
                self.boundary.end_overhang <= self.boundary.max_overhang,
                f"boundary.end_overhang: {self.boundary.end_overhang:g} mm is more than boundary.max_overhang "
                f"{self.boundary.max_overhang:g} mm",
            ),
            (
                self.boundary.ridge_setback >= self.timber.width / 2 + self.boundary.ridge_gap,
                f"boundary.ridge_setback: {self.boundary.ridge_setback:g} mm leaves no room for half a plank "
                f"and boundary.ridge_gap; at least {self.timber.width / 2 + self.boundary.ridge_gap:g}",
            ),
        )

    def _stock_rules(self) -> Rules:
        stock, thickness = self.stock, self.timber.thickness
        needed = stock.planks_per_board * thickness + (stock.planks_per_board - 1) * stock.split_kerf
        listed = {"lengths": stock.lengths, "bar_lengths": stock.bar_lengths, "metal_lengths": stock.metal_lengths}
        return (
            (
                stock.board_thickness is None or stock.board_thickness >= needed,
                f"stock.board_thickness: {stock.board_thickness or needed:g} mm does not give "
                f"{stock.planks_per_board} planks of timber.thickness {thickness:g} mm; at least {needed:g}",
            ),
            *(
                (
                    min(lengths) > 2.0 * stock.trim,
                    f"stock.{key}: nothing is left of {min(lengths):g} mm after stock.trim {stock.trim:g} mm at each "
                    f"end; more than {2.0 * stock.trim:g}",
                )
                for key, lengths in listed.items()
            ),
        )

    def _facade_rules(self) -> Rules:
        facade = self.facade
        if not facade.cover:
            return ()
        return (
            (
                facade.build_up < facade.screw_length,
                f"facade.screw_length: {facade.screw_length:g} mm does not reach the coupling block under mullion, "
                f"tapes, sheet and clamp; more than {facade.build_up:g}",
            ),
            *(
                (
                    thickness < width,
                    f"facade.{name}: {thickness:g} mm is not less than the width {width:g} mm; give [width, thickness]",
                )
                for name, (width, thickness) in (("mullion", facade.mullion), ("clamp", facade.clamp))
            ),
            (
                facade.screw_hole / 2 <= facade.edge_gap < min(facade.mullion[0], facade.clamp[0]) / 2,
                f"facade.edge_gap: {facade.edge_gap:g} mm; more than half of facade.screw_hole "
                f"({facade.screw_hole / 2:g}), or the screws hit the sheets, and less than half the width of mullion "
                f"and clamp ({min(facade.mullion[0], facade.clamp[0]) / 2:g}), or these do not hold them",
            ),
            (
                facade.screw_diameter <= facade.screw_hole,
                f"facade.screw_hole: {facade.screw_hole:g} mm is narrower than facade.screw_diameter "
                f"{facade.screw_diameter:g} mm",
            ),
        )

    def _level_rules(self) -> Rules:
        shells = self.shells
        if not isinstance(shells, LevelShells):
            return ()
        return (
            (
                shells.count == 1 or shells.sector_deg <= 180.0,
                f"shells.sector_deg: {shells.sector_deg:g} for {shells.count} shells that stand apart; at most 180, "
                "or shells.count = 1",
            ),
            (
                shells.count == 1 or shells.axis_distance > 0.0,
                f"shells.axis_distance: 0 puts all {shells.count} shells in one place; enlarge it or take "
                "shells.count = 1",
            ),
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


def design_text(name_or_path: str) -> tuple[str, str]:
    """Return (text, source) of a shipped design or of a file; FileError if neither can be read."""
    return shipped_text("designs", ".toml", name_or_path, "design"), name_or_path


def load_design(name_or_path: str) -> Design:
    """Return the design of a shipped name or of a TOML file; FileError or DesignError if it cannot be had."""
    return parse_design(*design_text(name_or_path))
