"""The tables of the design file about making and building: timber, joints, cover, supports, stock, crew."""

import re
import tomllib
from datetime import date
from typing import Annotated, Literal

from pydantic import AfterValidator, Field, StringConstraints

from aag_cad.design_base import Count, DesignTable, NotNegative, Number, Positive, Text
from aag_cad.resources import template


def _iso_date(value: str) -> str:
    if not re.fullmatch(r"\d{4}-\d{2}-\d{2}", value):
        raise ValueError("a date is written year-month-day, like 2027-03-01")
    date.fromisoformat(value)
    return value


class Strength(DesignTable):
    """Characteristic values of an EN 338 class, N/mm2 and kg/m3."""

    f_m: Positive
    f_t0: Positive
    f_c0: Positive
    f_c90: Positive
    f_v: Positive
    E0: Positive
    E05: Positive
    G: Positive
    rho_k: Positive
    rho_mean: Positive


class Timber(DesignTable):
    """Species, strength class and the one cross-section of all planks."""

    species: Text
    strength_class: Literal["D30", "D35", "D40", "D50", "D60"]
    density: Positive = Field(description="kg/m3")
    width: Positive
    thickness: Positive
    min_bending_radius: Positive
    max_twist_deg_per_m: Positive

    @property
    def strength(self) -> Strength:
        """The characteristic values of the strength class."""
        with template("en338.toml").open("rb") as file:
            return Strength(**tomllib.load(file)[self.strength_class])


class Joints(DesignTable):
    """Gap, studs, bolts, screws and coupling blocks: the hole patterns of EN 1995-1-1, tables 8.2 and 8.4."""

    gap: Positive
    stud_across_flats: Positive
    stud_length: Positive
    bolt_diameter: Literal[6, 8, 10, 12]
    bolt_hole: Positive
    bolt_offset: NotNegative = Field(description="of a bolt from the centre line; half the spacing in a stud")
    stud_hole: Literal["round", "slot"] = Field("round", description="slots let AA nodes turn while deployed")
    slot_length: NotNegative = Field(3.0, description="mm longer than round, along the plank, for stud_hole = 'slot'")
    screw_diameter: Positive
    screw_hole: Positive
    screw_length: Positive
    block_length: Positive

    @property
    def loaded_end(self) -> float:
        """The distance of a bolt from a loaded end, a3,t = max(7 d, 80 mm) of EN 1995-1-1, table 8.4."""
        return max(7.0 * self.bolt_diameter, 80.0)

    @property
    def stud_slot(self) -> float:
        """How much longer than round the holes of stud bolts are, mm."""
        return self.slot_length if self.stud_hole == "slot" else 0.0


class Boundary(DesignTable):
    """Ends of planks and what stays free at the ridges."""

    end_gap: NotNegative
    end_overhang: Positive
    max_overhang: Positive
    ridge_setback: Positive
    ridge_gap: NotNegative


class Facade(DesignTable):
    """Polycarbonate sheets between aluminium bars on the geodesics, screwed to the coupling blocks."""

    cover: Annotated[bool, Field(strict=True)] = Field(True, description="false leaves the gridshell uncovered")
    sheet_thickness: Positive
    sheet_width: Positive = Field(description="of the stock sheets, across the ribs")
    sheet_lengths: Annotated[tuple[Positive, ...], Field(min_length=1)] = Field(
        (3000.0, 3500.0, 4000.0, 4500.0, 5000.0, 5500.0, 6000.0, 7000.0),
        description="of the stock sheets, along the ribs",
    )
    sheet_mass: Positive = Field(1.7, description="kg/m2")
    edge_gap: Positive = Field(5.0, description="from the geodesic to the edge of a sheet: the screws pass there")
    seal: NotNegative = Field(2.0, description="thickness of the tape under and over a sheet, which is not drawn")
    ridge_clearance: NotNegative = Field(20.0, description="of sheets and bars from the ridge or mirror plane")
    foot_clearance: Number = Field(20.0, description="of sheets and bars over the ground line of the surface")
    mullion: tuple[Positive, Positive] = Field((50.0, 3.0), description="width and thickness of the bar under them")
    clamp: tuple[Positive, Positive] = Field((50.0, 2.0), description="width and thickness of the clamping bar")
    support_spacing: Positive = Field(
        800.0, description="of the bars at most; where outer beams are farther apart, blocks on the geodesic carry them"
    )
    screw_diameter: Positive = 4.0
    screw_hole: Positive = Field(5.0, description="in mullion and clamping bar")
    screw_length: Positive = 45.0

    @property
    def build_up(self) -> float:
        """Height of mullion, tapes, sheet and clamping bar over the beams, mm: what the screw passes, head flush."""
        return self.mullion[1] + 2.0 * self.seal + self.sheet_thickness + self.clamp[1]


class Ridge(DesignTable):
    """The steel at the top: straps on the ends of geodesics, blades between shells at those ends or equally spaced."""

    blades: Literal["geodesics", "equal"] = "geodesics"
    blade_spacing: Positive = 600.0
    blade_width: Positive = 100.0
    blade_thickness: Positive = 5.0
    strap_width: Positive = 50.0
    strap_thickness: Positive = 3.0


class Supports(DesignTable):
    """What stands under the foot of each geodesic, and the loads that the blocks are checked for."""

    foot_height: Positive
    block_size: tuple[Positive, Positive, Positive]
    adjustment: Positive = Field(20.0, description="mm that a shoe can be set up or down on its threaded rod")
    shoe_width: Positive = 90.0
    shoe_thickness: Positive = 6.0
    rod_diameter: Literal[12, 16, 20] = 16
    wind_suction: NotNegative = Field(0.5, description="kN/m2, characteristic, upwards over the plan area")
    snow: NotNegative = Field(0.75, description="kN/m2, characteristic, on the plan area")
    friction: Annotated[Number, Field(gt=0, le=1)] = Field(0.6, description="of the blocks on the ground")


class Transport(DesignTable):
    """The largest piece that travels, and what the crane on site lifts, kg; without ``crane`` nothing limits it."""

    length: Positive
    width: Positive
    height: Positive
    mass: Positive
    shells: Annotated[bool, Field(strict=True)] = Field(
        True, description="false: shells are put together where they stand, and only planks travel"
    )
    crane: Positive | None = Field(None, description="kg that the crane lifts as far out as the shells stand")


class Minutes(DesignTable):
    """Minutes of work of one person, by what is done: our estimate, to be replaced by measured times.

    Bolts and screws are those of timber and steel joints; a part is also carried to its place, by its length.
    """

    setup: NotNegative = Field(10.0, description="for each person of a step: read its card, fetch tools and parts")
    carry: NotNegative = Field(0.5, description="a metre of a long piece to its place")
    plank: NotNegative = Field(3.0, description="find a plank of a beam and line it up with its sibling")
    block: NotNegative = Field(2.0, description="set a coupling block")
    bolt: NotNegative = Field(2.0, description="put a bolt through, with washers and nut")
    tighten: NotNegative = Field(0.5, description="tighten a bolt and mark it")
    beam: NotNegative = Field(8.0, description="lay a beam on its line and chock it")
    geodesic: NotNegative = Field(5.0, description="lay a geodesic between its marks")
    slide: NotNegative = Field(15.0, description="push a plank in between others that lie already")
    stud: NotNegative = Field(4.0, description="line up two beams and push the stud through")
    hoist: NotNegative = Field(720.0, description="sling, hoist, shape and prop a shell")
    edge_plank: NotNegative = Field(40.0, description="push an edge plank in and clamp it")
    screw: NotNegative = Field(1.5, description="pre-drill and drive a screw")
    strap: NotNegative = Field(3.0, description="hold a strap to its holes")
    footing: NotNegative = Field(30.0, description="peg out, dig, set and level a concrete block")
    rod: NotNegative = Field(3.0, description="set the nuts of a threaded rod to height")
    shoe: NotNegative = Field(6.0, description="set a shoe on its rod")
    stand: NotNegative = Field(720.0, description="carry a shell to its feet, lower and prop it")
    extra: NotNegative = Field(20.0, description="put in or take out a splice block, a plate or a brace with its bolts")
    ridge: NotNegative = Field(120.0, description="draw two shells together along their ridge")
    blade: NotNegative = Field(8.0, description="fit a blade")
    mullion: NotNegative = Field(10.0, description="bend a mullion into place")
    strip: NotNegative = Field(25.0, description="bend a strip into place, with its tapes")
    clamp: NotNegative = Field(8.0, description="lay a clamping bar over two strips")
    prop: NotNegative = Field(120.0, description="prop a standing shell for taking down")
    lower: NotNegative = Field(480.0, description="lower a shell from its shape to the floor")
    removal: NotNegative = Field(0.5, description="share of the time of putting a part in that taking it out needs")
    measure: NotNegative = Field(8.0, description="measure a plank for its reuse passport")


class Crew(DesignTable):
    """Who assembles it, and how long a day."""

    people: Annotated[Count, Field(ge=1, le=40)]
    lift_limit: Positive = Field(description="kg per person")
    hours_per_day: Annotated[Number, Field(ge=1, le=16)] = Field(8.0, description="of work, without breaks")
    days_per_week: Annotated[Count, Field(ge=1, le=7)] = Field(5, description="of work, from Monday on")
    start: Annotated[str, AfterValidator(_iso_date)] | None = Field(
        None, description="first working day as text, year-month-day, for the calendar"
    )
    minutes: Minutes = Field(
        default_factory=lambda: Minutes.model_validate({}),
        description="of one person, by what is done, in place of our estimates",
    )


class Stock(DesignTable):
    """What the workshop buys timber, metal bars and sheets in, and how it saws them.

    A board is cut to length first and then split into planks of one length; shorter twins are cut back afterwards.
    """

    lengths: Annotated[tuple[Positive, ...], Field(min_length=1)] = Field(
        default=(4000.0, 5000.0, 6000.0, 7000.0), description="mm, of the boards that planks are cut from"
    )
    board_thickness: Positive | None = Field(
        default=None,
        description="mm, as bought; without it, that of the planks of a board and the saw cuts between them",
    )
    planks_per_board: Annotated[Count, Field(ge=1, le=6)] = 2
    kerf: NotNegative = Field(default=4.0, description="mm, of the cross-cut saw")
    split_kerf: NotNegative = Field(default=1.0, description="mm, of the saw that splits boards into planks")
    trim: NotNegative = Field(default=10.0, description="mm, cut off at each end of a board or bar")
    finger_joint: Annotated[bool, Field(strict=True)] = Field(
        default=False, description="whether planks longer than every board are finger-jointed"
    )
    finger_length: NotNegative = Field(default=15.0, description="mm, that the fingers of both pieces share")
    finger_clearance: NotNegative = Field(
        default=60.0, description="mm, from the fingers to the rim of the nearest hole"
    )
    finger_spacing: Positive = Field(
        default=600.0, description="mm, from a finger joint to the next, a sibling's or an end"
    )
    template_paper: Literal["roll", "a3"] = Field(default="roll", description="that drill templates are printed on")
    offcuts: Annotated[str, StringConstraints(min_length=1)] | None = Field(
        default=None,
        description="CSV file of old planks, used before boards; a relative path starts in the working folder",
    )
    accept_old_holes: Annotated[bool, Field(strict=True)] = Field(
        default=False, description="whether an old hole may lie in a plank cut from an old one"
    )
    old_hole_clearance: NotNegative = Field(
        default=24.0, description="mm, from the rim of an old hole to that of a new one"
    )
    old_hole_tolerance: NotNegative = Field(
        default=0.3, description="mm, within which an old hole is used again as a new one"
    )
    bar_lengths: Annotated[tuple[Positive, ...], Field(min_length=1)] = Field(
        default=(3000.0, 4000.0), description="mm, of the timber bars that studs and coupling blocks are cut from"
    )
    metal_lengths: Annotated[tuple[Positive, ...], Field(min_length=1)] = Field(
        default=(6000.0,), description="mm, of aluminium and steel bars"
    )
    sheet_gap: NotNegative = Field(default=5.0, description="mm, between two strips cut from one sheet")
