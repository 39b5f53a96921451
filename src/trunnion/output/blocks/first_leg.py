"""The block of the first leg of the way from home, where the tool goes to a point in two."""

from collections.abc import Mapping

from trunnion.arrays import Floats
from trunnion.model.motion import Motion
from trunnion.output.blocks.block_writer import BlockWriter
from trunnion.output.coordinates.approach_leg import ApproachLegs


class FirstLegs:
    """Writes the first legs of a program: X and Y of the point, or an order of the linear axes."""

    def __init__(self, legs: ApproachLegs, writer: BlockWriter) -> None:
        self._legs, self._writer = legs, writer

    def write(
        self,
        motion: Motion,
        point: Floats,
        block: Mapping[str, int],
        first_words: dict[str, int],
        leg: Floats | None = None,
    ) -> dict[str, int]:
        """Write the first leg to the point of a block; returns those of ``first_words`` that this block still needs.

        point        (3,) mm, in the coordinates of the blocks
        first_words  the family's words for the first motion block
        leg          (3,) mm, where the first leg ends; None: as the machine wants it
        """
        leg = self._legs.first(motion, point) if leg is None else leg
        if leg is None:
            self._writer.write_words({word: count for word, count in block.items() if word != "Z"})
            return first_words
        there, here = ({w: self._writer.to_count(w, float(p[c])) for c, w in enumerate("XYZ")} for p in (point, leg))
        if here == there:  # one leg is all
            return first_words
        self._writer.write_words({**block, **here, **first_words})  # Z counts with the tool length
        return {}
