"""Corners that a Sinumerik rounds or chamfers: RND, RNDM, CHF, CHR, and their feeds FRC and FRCM."""

from collections.abc import Mapping

from trunnion.errors import Severity
from trunnion.messages import Wording
from trunnion.readers.control.contour_control import CornerWord
from trunnion.readers.control.event_recorder import Note
from trunnion.readers.families.sinumerik.control import SinumerikControl
from trunnion.readers.families.sinumerik.settings import settings_of
from trunnion.readers.families.sinumerik.words import BLOCKS_IN_CORNER


class CornerWords:
    """Executes the corner words of blocks.

    rounds   RNDM is in force
    """

    def __init__(self, control: SinumerikControl, note: Note) -> None:
        self._control = control
        self._note = note
        self._feed_of = settings_of(control.machine).corner_feed
        self._radius = self._feed = 0.0
        self._word = ""
        self._blocks_without_motion = 0

    @property
    def rounds(self) -> bool:
        """Whether every corner is rounded."""
        return self._radius > 0.0

    def begin_block(self, words: Mapping[str, float]) -> None:
        """Take over the modal words of a block, which count for the corner at its end."""
        control = self._control
        self._radius = words.get("RNDM", self._radius / control.length_unit) * control.length_unit
        self._feed = words.get("FRCM", self._feed / control.unit_of_feed) * control.unit_of_feed

    def begin_motion(self) -> None:
        """Give up a corner whose other side comes later than the control looks ahead."""
        if self._control.awaits_element and self._blocks_without_motion > BLOCKS_IN_CORNER:
            self._control.forget_contour()
            self._note(Wording("NC224", "blocks_without_motion", word=self._word), Severity.ERROR)
        self._blocks_without_motion = 0

    def end_block(self, words: Mapping[str, float], *, moved: bool) -> None:
        """Let the corner at the end of a block be rounded or chamfered."""
        sizes = {name: words[name] for name in ("RND", "CHF", "CHR") if name in words}
        if not moved:
            self._blocks_without_motion += 1
            if sizes:
                self._note(Wording("NC213", "corner_without_motion", words=tuple(sizes)), Severity.ERROR)
            return
        if len(sizes) > 1:
            self._note(Wording("NC216", "several_corners", words=tuple(sizes)), Severity.ERROR)
            return
        self._word, size = next(iter(sizes.items()), ("RNDM", self._radius / self._control.length_unit))
        if size > 0.0:
            self._cut(size * self._control.length_unit, words.get("FRC"))

    def _cut(self, size: float, feed: float | None) -> None:
        control, word = self._control, self._word
        control.cut_corner(
            CornerWord(
                word,
                size,
                chamfer=word[0] == "C",
                by_length=word == "CHF",
                feed=feed * control.unit_of_feed if feed else self._feed or None,
                feed_of=self._feed_of,
                left_out=True,
                modal=word == "RNDM",
            )
        )
