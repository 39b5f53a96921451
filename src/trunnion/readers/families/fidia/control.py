"""The virtual control of a Fidia: planes of the present rotary position, and absolute centres."""

import math

from trunnion.arrays import Codes
from trunnion.errors import Severity
from trunnion.machines import AngleOutput, Axis, Machine
from trunnion.model.feed_path import FeedPath
from trunnion.model.run import ProgrammedWord
from trunnion.model.toolpath import Kind
from trunnion.readers.control import tool_orientation
from trunnion.readers.control.affine_map import AffineMap
from trunnion.readers.control.axis_word import AxisWord, PositionMode
from trunnion.readers.control.row_buffer import StepColumnBuilder
from trunnion.readers.control.row_recorder import Note
from trunnion.readers.control.virtual_control import RAPID
from trunnion.readers.program.settings import reading_of
from trunnion.readers.rs274.control import Rs274Control
from trunnion.readers.scan.letter_blocks import letter_table


def feed_path_of(machine: Machine) -> FeedPath:
    """What F counts where rotary axes turn without TCP: no source says so, but the machine's definition may."""
    table = reading_of(machine)
    counters = table.text("feed_without_tcp", "slides", one_of=("slides", "all_axes"))
    table.report_unread_keys()
    table.raise_problems()
    return FeedPath.AXES if counters == "all_axes" else FeedPath.SLIDES


class FidiaControl(Rs274Control):
    """A Fidia at work on a machine. Work offsets are the machine's workpiece zero."""

    relative_centres = False

    def __init__(
        self, machine: Machine, note: Note, file: StepColumnBuilder[int], *, shortest: bool | None = None
    ) -> None:
        super().__init__(machine, note, file, shortest=shortest)
        self.table = letter_table((self.rotary_names[0], self.rotary_names[1]), gaps=True)
        self.feed_path.set(0, int(feed_path_of(machine)))

    def takes_shortest_path(self, axis: Axis) -> bool:
        """Always (unconfirmed); but for axes whose values are written as they wind."""
        return axis.output is not AngleOutput.NONE

    @property
    def plain_table(self) -> Codes:
        """What bytes mean to the scan kernel."""
        return self.table

    def take_plane(self) -> None:
        """G154: the plane on which the tool now stands, about the work offset's zero."""
        self.resolve_rows()
        first, second = (float(self.current_joints[column]) for column in self.machine.rotary)
        self.set_plane(AffineMap(tool_orientation.tool_frame(self.machine, (first, second))))

    def turn_axes(self, axes: dict[str, AxisWord], *, feed_written: bool) -> None:
        """Turn rotary axes in a plane, without TCP: the slides stand still, the plane stays where it was taken."""
        rotary, turn_rule, bits = self.rotary_words(axes)
        bits |= int(ProgrammedWord.FEED) if feed_written else 0
        kind = Kind.RAPID if self.kind == RAPID else Kind.LINEAR
        self.resolve_rows()
        self.move_axes(kind, self.current_joints[self._slides].copy(), rotary, turn_rule, bits)

    def retract(self) -> None:
        """M242: Z goes to the end of its travel; no motion where the machine's definition does not know it."""
        self.add_event("retract", "M242")
        axis = self.machine.axis("Z")
        top = axis.high if axis.sense > 0.0 else axis.low
        if not math.isfinite(top):
            return
        if self.tcp:
            self.note("M242 while TCP is on: the slide Z goes up", Severity.WARNING)
        self.resolve_rows()
        slides = self.current_joints[self._slides].copy()
        slides[2] = top
        self.machine_rows.set(self.row, True)
        self.move_axes(Kind.RAPID, slides, [math.nan, math.nan], 0, int(ProgrammedWord.Z))
        self.machine_rows.set(self.row, False)

    def go_to_machine(self, axes: dict[str, AxisWord], *, feed_written: bool) -> None:
        """G290: positions of the machine's axes."""
        words = {name: (word[0], PositionMode.ABSOLUTE) for name, word in axes.items()}
        self.move(words, None, machine_frame=True, feed_written=feed_written)
