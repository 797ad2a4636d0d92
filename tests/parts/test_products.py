"""Equal parts are one product: three congruent shells, one stud for every node, one bolt for every hole."""

import re
from dataclasses import replace

import pytest

from aag_cad.parts.forms import Hole
from aag_cad.parts.model import ClampingBar, Gridshell, Mullion, Plank, Shell, Strap, Strip, all_parts, shell_parts
from aag_cad.parts.products import part_frame, product_key, product_name


def keys(shell: Shell) -> list[str]:
    return [product_key(part) for part in shell_parts(shell)]


def a_plank(shell: Shell) -> Plank:
    return next(plank for plank in shell.planks if plank.blank.holes)


def test_the_three_shells_are_made_of_the_same_products(gridshell: Gridshell) -> None:
    """Groups of three identical planks are clamped and drilled together (paper section 3.2)."""
    first, *others = (keys(shell) for shell in gridshell.shells)
    assert all(other == first for other in others)


def test_one_stud_fits_every_node(shell: Shell) -> None:
    """The constant angle of 60 degrees makes all 88 studs one product, holes and all (paper sections 2.2 and 5)."""
    assert len({product_key(stud) for stud in shell.studs}) == 1


def test_bolts_are_one_product_for_each_thickness_that_they_clamp(gridshell: Gridshell) -> None:
    """Beams 48 mm, shoes 12 + 6, straps 12 + 3, blades 12 + 5 mm; but only two sizes are bought."""
    bolts = [*gridshell.shells[0].bolts, *gridshell.bolts]
    assert {bolt.grip for bolt in bolts} == {48.0, 18.0, 15.0, 17.0}
    assert len({product_key(bolt) for bolt in bolts}) == 4
    assert {product_name(bolt) for bolt in bolts} == {"Bolt M8 x 65", "Bolt M8 x 40"}


def test_screws_are_one_product_for_each_size(shell: Shell) -> None:
    timber = {screw.mark for screw in shell.screws if "-K-" in screw.mark}
    assert len({product_key(screw) for screw in shell.screws if screw.mark in timber}) == 1
    assert len({product_key(s) for s in shell.screws}) == len({(s.diameter, s.length) for s in shell.screws})


def test_rods_and_concrete_blocks_are_each_one_product(shell: Shell) -> None:
    """All feet stand at one height; shoes are mirror images in pairs, bent to the slope of their geodesic."""
    assert len({product_key(rod) for rod in shell.rods}) == 1
    assert len({product_key(footing) for footing in shell.footings}) == 1
    assert len({product_key(shoe) for shoe in shell.shoes}) <= 14


def test_blades_are_the_same_seven_products_on_every_ridge(gridshell: Gridshell) -> None:
    ridges = ["R12", "R23", "R31"]
    first, *others = ([product_key(b) for b in gridshell.blades if b.mark.startswith(ridge)] for ridge in ridges)
    assert len(first) == 7
    assert all(other == first for other in others)


def test_blocks_of_beams_differ_at_most_by_the_side_of_their_bolt(shell: Shell) -> None:
    assert len({product_key(block) for block in shell.blocks if "-K-" in block.mark}) <= 2


def test_every_plank_of_a_shell_is_a_product_of_its_own(shell: Shell) -> None:
    """Left and right are mirror images and so are geodesics 1 and 14: none of them can take another's place."""
    assert len({product_key(plank) for plank in shell.planks}) == len(shell.planks)


def test_the_key_does_not_depend_on_mark_place_or_joint(shell: Shell) -> None:
    plank, stud = a_plank(shell), shell.studs[0]
    assert product_key(replace(plank, mark="S2-A1-01-L", beam="S2-A1-01", joints=())) == product_key(plank)
    assert product_key(replace(stud, mark="S3-N-001", frame=shell.studs[5].frame)) == product_key(stud)
    renamed = tuple(replace(hole, joint="S2-N-001") for hole in plank.blank.holes)
    assert product_key(replace(plank, blank=replace(plank.blank, holes=renamed))) == product_key(plank)


@pytest.mark.parametrize("change", ["station", "offset", "diameter"])
def test_a_hole_moved_by_a_hundredth_of_a_millimetre_makes_another_product(shell: Shell, change: str) -> None:
    plank = a_plank(shell)
    first: Hole = plank.blank.holes[0]
    moved = replace(first, **{change: getattr(first, change) + 0.01})
    other = replace(plank, blank=replace(plank.blank, holes=(moved, *plank.blank.holes[1:])))
    assert product_key(other) != product_key(plank)


def test_a_hole_left_out_a_longer_blank_or_another_section_makes_another_product(shell: Shell) -> None:
    plank = a_plank(shell)
    blank = plank.blank
    others = [
        replace(blank, holes=blank.holes[1:]),
        replace(blank, length=blank.length + 0.01),
        replace(blank, section=replace(blank.section, thickness=12.5)),
    ]
    assert len({product_key(replace(plank, blank=other)) for other in (blank, *others)}) == 4


def test_rounding_and_the_sign_of_zero_make_no_new_product(shell: Shell) -> None:
    """An angle of -1e-12 and one of +1e-12 are the same hole."""
    stud = shell.studs[0]
    hole = stud.holes[0]
    one, other = (replace(stud, holes=(replace(hole, angle=angle),)) for angle in (1e-12, -1e-12))
    assert product_key(one) == product_key(other)


def test_parts_of_different_kinds_never_share_a_product(gridshell: Gridshell) -> None:
    kinds: dict[str, set[str]] = {}
    for part in shell_parts(gridshell.shells[0]):
        kinds.setdefault(product_key(part), set()).add(type(part).__name__)
    assert all(len(names) == 1 for names in kinds.values())


def test_keys_are_sixteen_hexadecimal_digits(shell: Shell) -> None:
    assert all(len(key) == 16 and int(key, 16) >= 0 for key in keys(shell))


def test_names_of_products_name_the_thing_and_not_the_shell(gridshell: Gridshell) -> None:
    shell = gridshell.shells[1]
    assert product_name(shell.planks[0]) == "Plank A1-01-L"
    assert product_name(next(plank for plank in shell.planks if plank.family == "G")) == "Plank G-01"
    assert product_name(shell.studs[0]) == "Hexagon stud 24 x 220"
    assert product_name(shell.blocks[0]) == "Coupling block 120 x 100 x 24"
    assert product_name(shell.bolts[0]) == "Bolt M8 x 65"
    assert product_name(shell.screws[0]) == "Screw 6 x 60"
    assert product_name(shell.shoes[0]) == "Shoe 90 x 6"
    assert product_name(shell.footings[0]) == "Concrete block 400 x 380 x 300"
    assert re.fullmatch(r"Threaded rod M16 x \d{3}(\.\d+)?", product_name(shell.rods[0]))
    assert re.fullmatch(r"Strap \d{3} x 50 x 3", product_name(shell.straps[0]))
    assert product_name(gridshell.blades[0]) == "Ridge blade 100 x 5"
    assert product_name(gridshell.bolts[0]) == "Bolt M8 x 40"


def test_what_is_bent_is_drawn_in_its_shell_and_hardware_in_its_own_frame(gridshell: Gridshell) -> None:
    for part in all_parts(gridshell):
        bent = isinstance(part, Plank | Strap | Mullion | ClampingBar | Strip)
        assert (part_frame(part) is None) == bent
        assert bent or part_frame(part) == getattr(part, "frame", None)
