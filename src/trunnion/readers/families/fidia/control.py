"""The virtual control of a Fidia: planes of the present rotary position, and absolute centres."""

import math

from trunnion.arrays import Codes
from trunnion.errors import Severity
from trunnion.machines import Axis, Machine, Output
from trunnion.model.columns import Changes
from trunnion.model.feed_path import FeedPath
from trunnion.model.run import Written
from trunnion.model.toolpath import Kind
from trunnion.readers.common import tilt
from trunnion.readers.common.frames import Frame
from trunnion.readers.common.rows import Note
from trunnion.readers.common.scan import letters
from trunnion.readers.common.settings import reading_of
from trunnion.readers.common.virtual_control import RAPID
from trunnion.readers.common.word import How, Word
from trunnion.readers.rs274.control import Rs274Control


def feed_path_of(machine: Machine) -> FeedPath:
    """What F counts where rotary axes turn without TCP: no source says so, but the machine's definition may."""
    table = reading_of(machine)
    counts = table.text("feed_without_tcp", "slides", one_of=("slides", "all_axes"))
    table.finish()
    table.check()
    return FeedPath.AXES if counts == "all_axes" else FeedPath.SLIDES


class FidiaControl(Rs274Control):
    """A Fidia at work on a machine. Work offsets are the machine's workpiece zero."""

    relative_centres = False

    def __init__(self, machine: Machine, note: Note, file: Changes[int], *, shortest: bool | None = None) -> None:
        super().__init__(machine, note, file, shortest=shortest)
        self.table = letters((self.names[0], self.names[1]), gaps=True)
        self.feed_path.set(0, int(feed_path_of(machine)))

    def shorter(self, axis: Axis) -> bool:
        """Always (unconfirmed); but for axes whose values are written as they wind."""
        return axis.output is not Output.NONE

    @property
    def plain_table(self) -> Codes:
        """What bytes mean to the scan kernel."""
        return self.table

    def take_plane(self) -> None:
        """G154: the plane on which the tool now stands, about the work offset's zero."""
        self.settle()
        first, second = (float(self.held[column]) for column in self.machine.rotary)
        self.set_plane(Frame(tilt.tool_frame(self.machine, (first, second))))

    def turn_axes(self, axes: dict[str, Word], *, feed_written: bool) -> None:
        """Turn rotary axes in a plane, without TCP: the slides stand still, the plane stays where it was taken."""
        rotary, way, bits = self.rotary_words(axes)
        bits |= int(Written.FEED) if feed_written else 0
        kind = Kind.RAPID if self.kind == RAPID else Kind.LINEAR
        self.settle()
        self.move_axes(kind, self.held[self._slides].copy(), rotary, way, bits)

    def retract(self) -> None:
        """M242: Z goes to the end of its travel; no motion where the machine's definition does not know it."""
        self.event("retract", "M242")
        axis = self.machine.axis("Z")
        top = axis.high if axis.sense > 0.0 else axis.low
        if not math.isfinite(top):
            return
        if self.tcp:
            self.note("M242 while TCP is on: the slide Z goes up", Severity.WARNING)
        self.settle()
        slides = self.held[self._slides].copy()
        slides[2] = top
        self.machine_rows.set(self.row, True)
        self.move_axes(Kind.RAPID, slides, [math.nan, math.nan], 0, int(Written.Z))
        self.machine_rows.set(self.row, False)

    def go_to_machine(self, axes: dict[str, Word], *, feed_written: bool) -> None:
        """G290: positions of the machine's axes."""
        words = {name: (word[0], How.ABSOLUTE) for name, word in axes.items()}
        self.move(words, None, machine_frame=True, feed_written=feed_written)
