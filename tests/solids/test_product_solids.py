"""Every distinct product of the vault has one valid solid, and equal parts share it."""

import pytest
from solid_figures import signed_volume

from aag_cad.parts.mesh import product_mesh
from aag_cad.parts.model import Gridshell, Part, all_parts, ridge_parts, shell_parts
from aag_cad.parts.products import product_key
from aag_cad.parts.quantities import volume
from aag_cad.solids.products import product_solid, product_solids


def test_there_is_one_solid_for_each_product_and_the_shells_share_them(gridshell: Gridshell) -> None:
    solids = product_solids(gridshell)
    assert set(solids) == {product_key(part) for part in all_parts(gridshell)}
    assert len(solids) <= len(shell_parts(gridshell.shells[0])) + len(ridge_parts(gridshell)) / len(gridshell.shells)


def test_solids_and_meshes_of_the_parts_tell_of_the_same_timber(gridshell: Gridshell) -> None:
    # Two ways from the same model: the mesh has chords of 120 mm and no holes, so it may differ by a few per mille.
    for part in gridshell.shells[0].planks[::9]:
        drilled = sum(0.7854 * hole.diameter**2 * part.blank.section.thickness for hole in part.blank.holes)
        assert signed_volume(product_solid(part)) + drilled == pytest.approx(product_mesh(part).volume, rel=2e-3)


def test_all_planks_of_a_shell_enclose_their_timber(gridshell: Gridshell) -> None:
    for plank in gridshell.shells[0].planks[::7]:
        section, holes = plank.blank.section, plank.blank.holes
        drilled = sum(3.141592653589793 * hole.diameter**2 / 4.0 for hole in holes)
        expected = (section.width * plank.blank.length - drilled) * section.thickness
        assert signed_volume(product_solid(plank)) == pytest.approx(expected, rel=1e-6)


def test_steel_and_concrete_of_feet_and_ridge_enclose_their_volume(gridshell: Gridshell) -> None:
    """Sharp mitres keep section x length, round holes pass square: nothing but the kernel's tolerance is left."""
    shell = gridshell.shells[0]
    parts: tuple[Part, ...] = (*shell.shoes[::5], *gridshell.blades[:3], *shell.rods[:1], *shell.footings[:1])
    for part in parts:
        assert signed_volume(product_solid(part)) == pytest.approx(volume(part), rel=1e-6), part.mark
    for strap in shell.straps[::5]:
        assert signed_volume(product_solid(strap)) == pytest.approx(volume(strap), rel=1e-5), strap.mark
