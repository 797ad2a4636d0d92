"""The whole way from a design to the files."""

from aag_cad.design import CatenoidSurface, CrpcSurface, Design, HyperboloidSurface, SplineSurface
from aag_cad.geometry.profiles import CrpcProfile, HyperboloidProfile, Profile, SplineProfile
from aag_cad.geometry.revolution import AsymptoticChart, RevolutionSurface
from aag_cad.network.build import shell_network
from aag_cad.parts.build import gridshell_from
from aag_cad.parts.model import Gridshell


def profile_of(design: Design) -> Profile:
    """Return the meridian that the design asks for."""
    match design.surface:
        case CrpcSurface() as surface:
            return CrpcProfile(surface.neck_radius, surface.ratio)
        case CatenoidSurface() as surface:
            return CrpcProfile(surface.neck_radius, 1.0)
        case HyperboloidSurface() as surface:
            return HyperboloidProfile(surface.neck_radius, surface.semi_axis)
        case SplineSurface() as surface:
            return SplineProfile(surface.points)


def chart_of(design: Design) -> AsymptoticChart:
    """Return the surface of one shell in its asymptotic chart; its axis stands outside the vault, on -x."""
    return AsymptoticChart(RevolutionSurface(profile_of(design), -design.shells.axis_distance))


def gridshell_of(design: Design) -> Gridshell:
    """Return the gridshell of a design: design -> surface -> curves -> parts."""
    return gridshell_from(design, shell_network(design, chart_of(design)))
