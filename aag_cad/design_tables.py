"""The tables of the design file about form and place: project, surface, shells, pattern, site, optimiser."""

from typing import Annotated, Literal, TypeAlias

from pydantic import Discriminator, Field, Tag, model_validator

from aag_cad.design_base import Count, DesignTable, Name, NotNegative, Number, Positive, Text


class Project(DesignTable):
    """What the files are called and who made them."""

    name: Name = Field(description="used in file names: lower-case letters, digits, - and _")
    title: Text
    author: str = ""
    organisation: str = ""


class CrpcSurface(DesignTable):
    """Constant ratio of principal curvatures: k_meridian = -ratio * k_parallel."""

    profile: Literal["crpc"]
    neck_radius: Positive
    ratio: Annotated[Number, Field(gt=0.05, le=20)]


class CatenoidSurface(DesignTable):
    """The catenoid: crpc with ratio 1."""

    profile: Literal["catenoid"]
    neck_radius: Positive


class HyperboloidSurface(DesignTable):
    """Hyperboloid of one sheet r = neck_radius cosh u, z = semi_axis sinh u."""

    profile: Literal["hyperboloid"]
    neck_radius: Positive
    semi_axis: Positive


class ArcSurface(DesignTable):
    """A meridian of one radius: a start for the optimiser, not CRPC."""

    profile: Literal["arc"]
    neck_radius: Positive
    meridian_radius: Positive


class SplineSurface(DesignTable):
    """Meridian through points (radius, height), lowest first, from below the ground line z = 0 to the top."""

    profile: Literal["spline"]
    points: Annotated[tuple[tuple[Positive, Number], ...], Field(min_length=6)]


SurfaceSection: TypeAlias = Annotated[
    CrpcSurface | CatenoidSurface | HyperboloidSurface | ArcSurface | SplineSurface, Field(discriminator="profile")
]


class RidgeShells(DesignTable):
    """Three or more shells about the centre, intersected and cropped where they meet (paper, Fig. 2d)."""

    top: Literal["ridge"] = "ridge"
    count: Annotated[Count, Field(ge=3, le=9)]
    axis_distance: Positive = Field(description="mm from the centre to the vertical axis of each shell")
    sector_deg: Annotated[Number, Field(gt=0, lt=180)]


class MirrorShells(DesignTable):
    """A shell cropped by the vertical plane through the centre, and its mirror image (paper, Fig. 2b)."""

    top: Literal["mirror"]
    count: Literal[2] = 2
    axis_distance: Positive = Field(description="mm from the mirror plane to the vertical axis of each shell")
    sector_deg: Annotated[Number, Field(gt=0, le=120)]


class LevelShells(DesignTable):
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


class Pattern(DesignTable):
    """The tri-hex pattern."""

    geodesics: Annotated[Count, Field(ge=4, le=200, multiple_of=2)]
    row_offset: Annotated[Number, Field(ge=0, lt=1)] = 0.5
    min_nodes: Annotated[Count, Field(ge=1)] = 3
    node_clearance_foot: NotNegative = 100.0
    node_clearance_ridge: NotNegative = 150.0


class Site(DesignTable):
    """Where the gridshell stands: names, and how vault coordinates lie in a projected coordinate system.

    The origin of the vault (its centre on the ground line) has the eastings, northings and height given, in metres.
    """

    name: Text = "Site"
    building: Text | None = Field(default=None, description="name of the building; without it, project.title")
    address: tuple[Text, ...] = Field(
        default=(), description="lines of the postal address, the street first, the town last"
    )
    epsg: Annotated[Count, Field(ge=1024, le=998999)] | None = Field(
        default=None, description="number of the projected coordinate system in the EPSG register, e.g. 25832"
    )
    crs_name: Text | None = Field(default=None, description="its name, e.g. ETRS89 / UTM zone 32N")
    vertical_datum: Text | None = Field(default=None, description="of the height, e.g. DHHN2016")
    eastings: Number | None = Field(default=None, description="m, of the vault's origin")
    northings: Number | None = Field(default=None, description="m, of the vault's origin")
    height: Number = Field(default=0.0, description="m over the vertical datum, of the vault's origin")
    rotation_deg: Annotated[Number, Field(ge=-360, le=360)] = Field(
        default=0.0, description="from grid east to the vault's x axis, counter-clockwise seen from above"
    )
    true_north_deg: Annotated[Number, Field(ge=-360, le=360)] | None = Field(
        default=None,
        description="from the vault's y axis to true north, counter-clockwise; without it, grid north is taken",
    )
    latitude_deg: Annotated[Number, Field(ge=-90, le=90)] | None = None
    longitude_deg: Annotated[Number, Field(ge=-180, le=180)] | None = None

    @model_validator(mode="after")
    def _goes_together(self) -> "Site":
        together: tuple[tuple[str, ...], ...] = (
            ("epsg", "eastings", "northings"),
            ("latitude_deg", "longitude_deg"),
        )
        for keys in together:
            missing = [key for key in keys if getattr(self, key) is None]
            if missing and len(missing) < len(keys):
                raise ValueError(f"{', '.join(missing)}: missing; {', '.join(keys)} are given together or not at all")
        return self


class Optimise(DesignTable):
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
