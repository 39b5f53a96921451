"""How motion blocks orient the tool: by rotary words, or by the tool axis as a vector."""

from collections.abc import Sequence

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.controls.vocabulary import ORIENT_BY_AXES_WORD, ORIENT_BY_VECTOR_WORD, TOOL_VECTOR_WORDS
from trunnion.controls.words import ABSENT, Word, round_to_counts
from trunnion.model.motion import MachiningMode, Motion
from trunnion.output.blocks.block_table import BlockTable
from trunnion.output.blocks.block_writer import BlockWriter
from trunnion.output.coordinates.rotary_angles import rotary_counts
from trunnion.output.coordinates.tool_vectors import first_row_at_other_pose, nearest_pose_is_planned, tool_vectors_at
from trunnion.output.program import Program


class OrientationWords:
    """Writes rotary words and tool vectors, and knows by which of them the control orients the tool.

    uses_vectors  tool vectors are written in the present motion
    """

    def __init__(self, program: Program, writer: BlockWriter, words: Sequence[Word]) -> None:
        self.uses_vectors = False
        self._machine = program.machine
        self._control = program.control
        self._settings = program.settings
        self._rotary = program.rotary_words()
        self._writer = writer
        self._has_switch = any(word.key == ORIENT_BY_VECTOR_WORD for word in words)
        self._by_vector = ABSENT  # 1: the control orients by vectors; 0: by rotary axes; ABSENT: not known
        self._state_after: dict[str, int] = {}

    def begin_motion(self, motion: Motion, words: Sequence[Word]) -> None:
        """Decide whether a motion is written with tool vectors; ``words`` are those of its blocks."""
        self._by_vector = 1
        self.uses_vectors = motion.mode is MachiningMode.TCP and self._control.uses_tool_vectors(self._settings)
        if self.uses_vectors and self._control.vectors_exclude_angles:
            self.uses_vectors = first_row_at_other_pose(self._machine, motion, words) < 0

    def begin_file(self) -> None:
        """Forget how the control orients the tool: the next block starts a file."""
        self._by_vector = ABSENT

    def assume_position(self, rotary: Floats) -> None:
        """Take it that templates have moved the rotary axes to ``rotary`` (2,), degrees."""
        for word in self._rotary:
            self._writer.remember(word.key, int(self._rotary_counts(word.key, word.axis, rotary[[word.column]])[0]))
        if self.uses_vectors:
            for key, count in self._vector_counts(rotary[None]).items():
                self._writer.remember(key, int(count[0]))

    def add_words(self, table: BlockTable, motion: Motion, rows: slice, contact: Flags) -> None:
        """Put the words that orient the tool into a table of some rows.

        In a tilted plane there are none: the rotary axes rest. In rows with ``contact`` a vector is always written,
        for the surface normal needs it.
        """
        self._state_after = {}
        if motion.plane is None:
            for word in self._rotary:
                table.columns[word.key] = self._rotary_counts(word.key, word.axis, motion.rotary[rows, word.column])
        if self.uses_vectors:
            self._add_vectors(table, motion, rows, contact)

    def remember_state(self) -> None:
        """Take it that the orientation after the last row is known, by whichever words it was written."""
        for word, count in self._state_after.items():
            self._writer.remember(word, count)

    def _add_vectors(self, table: BlockTable, motion: Motion, rows: slice, contact: Flags) -> None:
        """Add tool vectors, and keep rotary words where the control would choose another pose for the vector.

        Where the orientation changes, all components or both rotary words are written; elsewhere neither.
        """
        rotary = motion.rotary[rows]
        vectors = self._vector_counts(rotary)
        by_vector = self._leads_to_plan(vectors, motion, rows)
        words = vectors | {word.key: table.columns[word.key] for word in self._rotary}
        changes = np.zeros(len(rotary), np.bool_)
        for key, column in words.items():
            changes |= column != np.concatenate(([self._writer.last_count(key)], column[:-1]))
        self._state_after = {key: int(column[-1]) for key, column in words.items()}
        by_vector |= ~changes  # the tool is already oriented so
        written = changes | contact
        for key, column in words.items():
            here = written & (by_vector if key in TOOL_VECTOR_WORDS else ~by_vector)
            table.columns[key] = np.where(here, column, ABSENT)
            table.force(key, here)
        if self._has_switch and written.any():
            self._add_switches(table, np.flatnonzero(written), by_vector)

    def _add_switches(self, table: BlockTable, rows: Ints, by_vector: Flags) -> None:
        """Switch between vectors and rotary axes where ``rows`` orient the tool otherwise than the row before."""
        wanted = by_vector[rows].astype(np.int64)
        switches = rows[wanted != np.concatenate(([self._by_vector], wanted[:-1]))]
        table.column(ORIENT_BY_VECTOR_WORD)[switches[by_vector[switches]]] = 0
        table.column(ORIENT_BY_AXES_WORD)[switches[~by_vector[switches]]] = 0
        self._by_vector = int(wanted[-1])

    def _leads_to_plan(self, vectors: dict[str, Ints], motion: Motion, rows: slice) -> Flags:
        """(n,) bool: for the vector as it is printed, the control takes the planned rotary position."""
        rotary = motion.rotary[rows]
        if self._control.vectors_exclude_angles:
            return np.ones(len(rotary), np.bool_)
        printed = np.column_stack(list(vectors.values())) / np.float64(10 ** self._decimals(TOOL_VECTOR_WORDS[0]))
        first = max(rows.start - 1, 0)
        before = np.concatenate((motion.rotary[first : first + 1], rotary[:-1]))
        half_digit = 0.5 * 10.0 ** -self._decimals("primary")
        return nearest_pose_is_planned(self._machine, printed, rotary, before, half_digit)

    def _vector_counts(self, rotary: Floats) -> dict[str, Ints]:
        """Return the tool axes at rotary positions (n, 2), as counts of the vector words."""
        decimals = self._decimals(TOOL_VECTOR_WORDS[0])
        vectors = tool_vectors_at(self._machine, rotary)
        columns = [round_to_counts(np.ascontiguousarray(vectors[:, k]), decimals) for k in range(3)]
        return dict(zip(TOOL_VECTOR_WORDS, columns, strict=True))

    def _rotary_counts(self, key: str, axis: int, angle: Floats) -> Ints:
        return rotary_counts(self._machine, axis, angle, self._decimals(key))

    def _decimals(self, key: str) -> int:
        return self._writer.word(key).format.decimals
