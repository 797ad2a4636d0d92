"""The index of a gridshell: everything by its mark, found once and kept no longer than what it is of."""

import gc
import weakref
from dataclasses import replace

from aag_cad.parts.index import index_of
from aag_cad.parts.model import Gridshell, all_joints, all_parts, shell_parts


def test_every_part_and_joint_stands_under_its_mark_in_the_order_of_the_model(gridshell: Gridshell) -> None:
    index = index_of(gridshell)
    assert list(index.parts.values()) == list(all_parts(gridshell))
    assert list(index.joints.values()) == list(all_joints(gridshell))
    assert all(mark == part.mark for mark, part in index.parts.items())
    for shell in gridshell.shells:
        assert list(index_of(shell).parts.values()) == list(shell_parts(shell))
        assert list(index_of(shell).blocks.values()) == list(shell.blocks)


def test_the_index_of_a_gridshell_knows_the_bolts_of_its_ridges_too(gridshell: Gridshell) -> None:
    of_shells = {bolt.mark for shell in gridshell.shells for bolt in shell.bolts}
    assert index_of(gridshell).bolts.keys() - of_shells == {bolt.mark for bolt in gridshell.bolts} != set()


def test_stations_units_and_joints_are_those_that_the_planks_and_joints_name(gridshell: Gridshell) -> None:
    index = index_of(gridshell)
    for plank in (plank for shell in gridshell.shells for plank in shell.planks):
        assert all(plank.mark in index.joints[place.joint].members for place in plank.joints)
        assert all(index.stations[plank.mark, place.joint] == place.station for place in plank.joints)
        assert index.unit_of[plank.mark] in (plank.beam, plank.mark)
        assert (index.unit_of[plank.mark] in index.beams) == plank.upright


def test_an_index_is_made_once_for_an_object_and_goes_with_it(gridshell: Gridshell) -> None:
    shell = replace(gridshell.shells[0])
    kept = weakref.ref(index_of(shell))
    assert kept() is index_of(shell)
    assert kept() is not index_of(replace(shell))
    del shell
    gc.collect()
    assert kept() is None
