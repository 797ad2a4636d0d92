"""Which parts are put together with which coupled beam."""

from aag_cad.parts.model import Shell


def beam_of_parts(shell: Shell) -> dict[str, str]:
    """Return the mark of the coupled beam for each part that is put together with it: planks, blocks and their bolts.

    What a joint of one single beam holds belongs to that beam; what ties two beams, and every screw, to the shell.
    """
    home = {plank.mark: plank.beam for plank in shell.planks if plank.beam}
    with_beam = {block.mark for block in shell.blocks} | {bolt.mark for bolt in shell.bolts}
    found = dict(home)
    for joint in shell.joints:
        beams = {home[mark] for mark in joint.members if mark in home}
        if len(beams) == 1:
            beam = next(iter(beams))
            found.update({mark: beam for mark in (*joint.members, *joint.fasteners) if mark in with_beam})
    return found
