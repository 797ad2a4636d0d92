"""The tables of the design file and what each key may be."""

import tomllib
from typing import Annotated, Literal, TypeAlias

from pydantic import (
    BaseModel,
    ConfigDict,
    Discriminator,
    Field,
    StringConstraints,
    Tag,
)

from aag_cad.resources import template

# Strict, because a key that reads "true" must not be built as one millimetre.
Number: TypeAlias = Annotated[float, Field(allow_inf_nan=False, strict=True)]
Positive: TypeAlias = Annotated[Number, Field(gt=0)]
NotNegative: TypeAlias = Annotated[Number, Field(ge=0)]
Count: TypeAlias = Annotated[int, Field(strict=True)]
Text: TypeAlias = Annotated[
    str, StringConstraints(strip_whitespace=True, min_length=1, max_length=80, pattern=r"^[^\x00-\x1f]+$")
]
Name: TypeAlias = Annotated[str, Field(pattern=r"^[a-z0-9][a-z0-9_-]*$", max_length=40)]


class Section(BaseModel):
    """A table of the design file: extra keys are refused, values never change."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class Project(Section):
    """What the files are called and who made them."""

    name: Name = Field(description="used in file names: lower-case letters, digits, - and _")
    title: Text
    author: str = ""
    organisation: str = ""


class CrpcSurface(Section):
    """Constant ratio of principal curvatures: k_meridian = -ratio * k_parallel."""

    profile: Literal["crpc"]
    neck_radius: Positive
    ratio: Annotated[Number, Field(gt=0.05, le=20)]


class CatenoidSurface(Section):
    """The catenoid: crpc with ratio 1."""

    profile: Literal["catenoid"]
    neck_radius: Positive


class HyperboloidSurface(Section):
    """Hyperboloid of one sheet r = neck_radius cosh u, z = semi_axis sinh u."""

    profile: Literal["hyperboloid"]
    neck_radius: Positive
    semi_axis: Positive


class ArcSurface(Section):
    """A meridian of one radius: a start for the optimiser, not CRPC."""

    profile: Literal["arc"]
    neck_radius: Positive
    meridian_radius: Positive


class SplineSurface(Section):
    """Meridian through points (radius, height), lowest first, from below the ground line z = 0 to the top."""

    profile: Literal["spline"]
    points: Annotated[tuple[tuple[Positive, Number], ...], Field(min_length=6)]


SurfaceSection: TypeAlias = Annotated[
    CrpcSurface | CatenoidSurface | HyperboloidSurface | ArcSurface | SplineSurface, Field(discriminator="profile")
]


class RidgeShells(Section):
    """Three or more shells about the centre, intersected and cropped where they meet (paper, Fig. 2d)."""

    top: Literal["ridge"] = "ridge"
    count: Annotated[Count, Field(ge=3, le=9)]
    axis_distance: Positive = Field(description="mm from the centre to the vertical axis of each shell")
    sector_deg: Annotated[Number, Field(gt=0, lt=180)]


class MirrorShells(Section):
    """A shell cropped by the vertical plane through the centre, and its mirror image (paper, Fig. 2b)."""

    top: Literal["mirror"]
    count: Literal[2] = 2
    axis_distance: Positive = Field(description="mm from the mirror plane to the vertical axis of each shell")
    sector_deg: Annotated[Number, Field(gt=0, le=120)]


class LevelShells(Section):
    """Shells cropped along parallel circles, open in sectors or closed about their axis (paper, Fig. 2a and c)."""

    top: Literal["level"]
    top_height: Positive = Field(description="mm from the neck up to the top edge")
    bottom_height: Annotated[Number, Field(le=0)] = Field(
        0.0, description="mm from the neck down to the bottom edge; below the neck lies the flipped surface"
    )
    count: Annotated[Count, Field(ge=1, le=9)]
    axis_distance: NotNegative = Field(description="mm from the centre to the vertical axis of each shell")
    sector_deg: Annotated[Number, Field(gt=0, le=360)]


def _kind_of_top(value: object) -> str | None:
    if isinstance(value, dict):
        return str(value.get("top", "ridge"))
    return getattr(value, "top", None)


ShellsSection: TypeAlias = Annotated[
    Annotated[RidgeShells, Tag("ridge")]
    | Annotated[MirrorShells, Tag("mirror")]
    | Annotated[LevelShells, Tag("level")],
    Discriminator(_kind_of_top),
]


class Pattern(Section):
    """The tri-hex pattern."""

    geodesics: Annotated[Count, Field(ge=4, le=200, multiple_of=2)]
    row_offset: Annotated[Number, Field(ge=0, lt=1)] = 0.5
    min_nodes: Annotated[Count, Field(ge=1)] = 3
    node_clearance_foot: NotNegative = 100.0
    node_clearance_ridge: NotNegative = 150.0


class Strength(Section):
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


class Timber(Section):
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


class Joints(Section):
    """Gap, studs, bolts, screws and coupling blocks."""

    gap: Positive
    stud_across_flats: Positive
    stud_length: Positive
    bolt_diameter: Literal[6, 8, 10, 12]
    bolt_hole: Positive
    bolt_offset: NotNegative
    screw_diameter: Positive
    screw_hole: Positive
    screw_length: Positive
    block_length: Positive


class Boundary(Section):
    """Ends of planks and what stays free at the ridges."""

    end_gap: NotNegative
    end_overhang: Positive
    max_overhang: Positive
    ridge_setback: Positive
    ridge_gap: NotNegative


class Facade(Section):
    """Polycarbonate sheets."""

    sheet_thickness: Positive
    sheet_width: Positive


class Supports(Section):
    """What stands under the foot of each geodesic."""

    foot_height: Positive
    block_size: tuple[Positive, Positive, Positive]


class Transport(Section):
    """The largest piece that travels."""

    length: Positive
    width: Positive
    height: Positive
    mass: Positive


class Crew(Section):
    """Who assembles it."""

    people: Annotated[Count, Field(ge=1, le=40)]
    lift_limit: Positive = Field(description="kg per person")


class Optimise(Section):
    """What the web is optimised for before it is built; without this table it is built as it is."""

    node_angle_deg: Annotated[Number, Field(gt=0, lt=180)] = Field(
        60.0, description="between the A lines, across the geodesics; 60 is the equilateral tri-hex"
    )
    crown_height: Positive | None = Field(None, description="mm from the ground line to the crown, over the centre")
    method: Literal["gauss-newton", "levenberg-marquardt"] = "gauss-newton"
    weights: dict[Literal["A-net", "geodesic", "angle", "bottom", "points", "radius", "twist"], Positive] = Field(
        default_factory=dict, description="of the energies, in place of those of the paper's Eq. (7): 1, but bottom 10"
    )
    cells: Annotated[Count, Field(ge=2, le=16, multiple_of=2)] = 2
    closeness: NotNegative = 0.0
    min_radius: Positive | None = None
    max_twist_deg_per_m: Positive | None = None
