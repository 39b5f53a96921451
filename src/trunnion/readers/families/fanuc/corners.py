"""Corners that blocks round or chamfer at their end: ,R and ,C."""

from trunnion.errors import Severity
from trunnion.messages import Wording
from trunnion.readers.control.contour_control import CornerWord
from trunnion.readers.families.fanuc import words
from trunnion.readers.families.fanuc.control import FanucControl
from trunnion.readers.rs274.block import Block


def cut_corner(control: FanucControl, block: Block) -> None:
    """Let the corner at the end of a block, whose motion has been executed, be rounded or chamfered."""
    sizes = {word: size for word in words.CORNERS if (size := block.take(word)) is not None}
    if len(sizes) > 1:
        control.note(Wording("NC216", "several_corners", words=tuple(sizes)), Severity.ERROR)
        return
    for word, size in sizes.items():
        if size == 0.0:
            control.note(Wording("NC210", "corner_without_size", word=word), Severity.WARNING)
            return
        if not size > 0.0:
            control.note(Wording("NC210", "corner_needs_size", word=word), Severity.ERROR)
            return
        length, chamfer = size * control.length_unit, word == words.CHAMFER
        control.cut_corner(CornerWord(word, length, chamfer=chamfer, feed_of="", least_turn=words.LEAST_TURN))
