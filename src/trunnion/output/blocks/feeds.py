"""F in motion blocks, and the words that tell what it means."""

from typing import Final

import numpy as np

from trunnion.arrays import Flags
from trunnion.controls.family_writer import FamilyWriter
from trunnion.controls.words import ABSENT
from trunnion.model.toolpath import Moves
from trunnion.output.blocks.block_table import BlockTable
from trunnion.output.blocks.block_writer import BlockWriter
from trunnion.output.coordinates.axis_coordinates import AxisCoordinates, feed_rule, feed_words
from trunnion.output.program import Program

#: The modal words F, by what it means: mm per minute, and mm per revolution.
FEED_WORDS: Final = ("feed", "feed_per_rev")


class FeedWords:
    """Writes feeds, and knows the feed mode that is active.

    rapid_feed  F of rapids on machines where rapids are lines at a high feed, as a count; ABSENT: rapids have no F.
                A cut at that very feed gets the next lower one, which is no rapid
    """

    def __init__(self, program: Program, writer: BlockWriter) -> None:
        self._codes = program.control.codes
        self._family: FamilyWriter = program.control.family
        self._rule_without_tcp = feed_rule(program.control, program.effective_settings())
        self._writer = writer
        self._mode = ABSENT
        rapid_feed = program.effective_setting("rapid_feed")
        self.rapid_feed = writer.to_count("feed", float(rapid_feed)) if rapid_feed else ABSENT

    def forget_mode(self) -> None:
        """Write F at the next feed, whatever was active."""
        self._mode = ABSENT

    def use_mode(self, code: int) -> int:
        """Return the code of a feed mode that is active from here on; where it changes, F is written again."""
        if code != self._mode:
            self._writer.forget(*FEED_WORDS)
        self._mode = code
        return code

    def count(self, feed: float, per_rev: bool) -> tuple[str, int]:
        """Return the word of a feed, mm/min or mm/rev, and its count."""
        word = FEED_WORDS[per_rev and FEED_WORDS[1] in self._family.WORDS]
        count = self._writer.to_count(word, feed)
        return word, count - 1 if word == "feed" and count == self.rapid_feed else count

    def add_words(self, table: BlockTable, moves: Moves, rows: slice, rapid: Flags) -> None:
        """Put F, the feed mode and the motion words of a family into a table; ``rapid``: the rows that are rapids."""
        per_rev = moves.per_rev[rows]
        for word, absent in zip(FEED_WORDS, (rapid | per_rev, rapid | ~per_rev), strict=True):
            if word == "feed" or per_rev.any():
                feed = np.where(absent, np.nan, moves.feed[rows])
                table.columns[word] = self._writer.word(word).format.counts(feed)
        if self.rapid_feed != ABSENT:
            counts = table.columns["feed"]
            counts[counts == self.rapid_feed] -= 1  # a cut at that feed would be read as a rapid
        table.columns["feed"][rapid] = self.rapid_feed
        table.columns |= self._family.row_words(rapid, per_rev, self._codes)

    def add_words_without_tcp(
        self, table: BlockTable, motion: AxisCoordinates, moves: Moves, rows: slice, rapid: Flags
    ) -> None:
        """Change F in blocks without TCP in which rotary axes turn, so that the tip keeps its feed."""
        turning = motion.rotary_moves[rows] & ~rapid
        rule = self._rule_without_tcp
        key = "inverse_feed" if rule == "inverse_time" else "feed"
        number_format = self._writer.word(key).format
        value, _, _ = feed_words(motion.select(rows), moves.feed[rows], rule, number_format)
        count = number_format.counts(np.where(turning, value, np.nan))
        if rule == "inverse_time":
            table.columns["feed"][turning] = ABSENT
            table.columns["feed_mode"][turning] = self._codes["feed_inverse_time"]
            table.columns[key] = count
        else:
            count[turning & (count == self.rapid_feed)] += 1  # that feed would make the block a rapid
            table.columns[key][turning] = count[turning]

    def force_at_mode_changes(self, table: BlockTable, rapid: Flags) -> None:
        """Write F in every row in which its meaning changes, even if the number stays the same."""
        cuts = np.flatnonzero(~rapid)
        if not len(cuts) or "feed_mode" not in table.columns:
            return
        modes = table.columns["feed_mode"][cuts]
        changes = np.zeros(len(rapid), np.bool_)
        changes[cuts] = modes != np.concatenate(([self._mode], modes[:-1]))
        for word in FEED_WORDS:
            table.force(word, changes)
        self._mode = int(modes[-1])
