"""The virtual control of a Fidia: planes of the present rotary position, and absolute centres of circles."""

import math
from collections.abc import Mapping
from typing import Final

import numpy as np

from trunnion.errors import Severity
from trunnion.machines import AngleOutput, Axis, Machine, Mount
from trunnion.messages import Wording
from trunnion.model.feed_path import FeedPath
from trunnion.model.run import ProgrammedWord
from trunnion.model.toolpath import Kind
from trunnion.readers.control import tool_orientation
from trunnion.readers.control.affine_map import AffineMap
from trunnion.readers.control.axis_word import AxisWord, PositionMode
from trunnion.readers.control.event_recorder import Note
from trunnion.readers.control.start_modes import check_start_modes, with_tcp_off
from trunnion.readers.families.fidia.cycles import ABOVE
from trunnion.readers.families.fidia.words import OFFSET_BASE, TABLE, TCP_OF_HEADS, TCP_OF_TABLES
from trunnion.readers.program.forms import read_form
from trunnion.readers.program.settings import control_of, family_of, reading_of, unit_of
from trunnion.readers.rs274.control import Rs274Control
from trunnion.readers.rs274.word_meanings import WordMeanings, read_word_meanings
from trunnion.readers.scan.letter_blocks import letter_table
from trunnion.records import dataclass

#: Words with which a block goes to a place.
_PLACE: Final = ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z

#: An axis that is off the end of its turn by less than this stands at it, degrees.
_NO_TURN: Final = 1e-6


@dataclass(frozen=True, slots=True)
class Settings:
    """How a control is set: what F refers to where rotary axes turn without TCP, the unit, and words of its own.

    peck_clearance  how far above the last depth the rapid approach of G83 ends, mm
    """

    feed_path: FeedPath
    unit: str
    peck_clearance: float
    words: WordMeanings


def settings_of(machine: Machine) -> Settings:
    """Read the settings of a machine's control; InputError if they are wrong."""
    table = reading_of(machine)
    counts = table.text("feed_without_tcp", "slides", one_of=("slides", "all_axes"))
    unit = unit_of(table)
    above = table.number("peck_clearance_mm", ABOVE, at_least=0.0)
    words = read_word_meanings(table, TABLE.is_own)
    read_form(table, family_of(machine))
    check_start_modes(table, _start_modes_of(machine))
    table.report_unread_keys()
    table.raise_problems()
    return Settings(FeedPath.AXES if counts == "all_axes" else FeedPath.SLIDES, unit, above, words)


#: How the reader takes the control to start; it has one feed mode.
_START_MODES: Final = {"distances": "G90", "plane": "G17", "compensation": "G40", "tilted plane": "G69"}


def _start_modes_of(machine: Machine) -> Mapping[str, str]:
    return with_tcp_off(machine, "TCP", _START_MODES)


def _tcp_words_of(machine: Machine) -> tuple[str, ...]:
    """Return the words that switch TCP for the rotary axes of a machine, or those that its definition states."""
    mounts = {machine.axes[column].mount for column in machine.rotary}
    known = [*(TCP_OF_TABLES if Mount.PART in mounts else ()), *(TCP_OF_HEADS if Mount.TOOL in mounts else ())]
    settings = control_of(machine).table("settings")
    stated = settings.text("tcp_on", ""), settings.text("tcp_off", "")
    return tuple(dict.fromkeys((*known, *(stated if "" not in stated and stated != TCP_OF_TABLES else ()))))


class FidiaControl(Rs274Control):
    """A Fidia on a machine. Work offsets are the machine's workpiece zero."""

    relative_centres = False

    doubtful_modes = frozenset({"units", "distances", "plane", "compensation", "offset"})
    reset_by = "no source says what the end of a program sets back"

    def __init__(self, machine: Machine, note: Note, *, shortest: bool | None = None) -> None:
        super().__init__(machine, note, shortest=shortest)
        self.usual_modes["offset"] = OFFSET_BASE + 1
        self.start_modes = _start_modes_of(machine)
        self.tcp_words = _tcp_words_of(machine)
        self.letter_table = letter_table(self.rotary_names, gaps=True)
        self.settings = settings_of(machine)
        self.own_words = self.settings.words
        self.modal.feed_path.set(0, int(self.settings.feed_path))
        self.count_in(self.settings.unit)

    def takes_shortest_path(self, axis: Axis) -> bool:
        """Return True (unconfirmed), except for axes whose output has all turns."""
        return axis.output is not AngleOutput.NONE

    def resolve_rows(self) -> None:
        """Determine the axis positions after the rows so far; note each cut that passes the end of a displayed turn."""
        first, before, c = self.columns.resolved, self.current_joints.copy(), self.columns
        super().resolve_rows()
        if first == c.n or not self.tip_programmed:
            return
        rows = slice(first, c.n)
        cuts = (c.kind[rows] != Kind.RAPID) & ((c.programmed[rows] & int(_PLACE)) != 0)
        for which, column in enumerate(self.machine.rotary):
            axis = self.machine.axes[column]
            if not axis.endless or not self.takes_shortest_path(axis):
                continue
            start = -180.0 if axis.output is AngleOutput.SYMMETRIC else 0.0
            turns = np.floor((np.append(before[column], c.rotary[rows, which]) - start + _NO_TURN) / 360.0)
            for row in np.flatnonzero(cuts & (np.diff(turns) != 0.0)).tolist():
                self._note_at(first + row, Wording("NC342", "end_of_turn_in_cut", axis=axis.name))

    def _note_at(self, row: int, wording: Wording) -> None:
        here, self.line = self.line, int(self.columns.line[row - self.columns.base])
        self.note(wording, Severity.WARNING)
        self.line = here

    def change_tool(self) -> None:
        """Change to the selected tool, whose length counts from the next G55 on."""
        super().change_tool()
        if self.tool_in_spindle.strip("0"):
            self.preconditions.require("G55", Wording("NC361", "tool_before_g55"))

    def take_plane(self) -> None:
        """G154: the plane normal to the tool as it stands, about the zero of the work offset."""
        self.resolve_rows()
        first, second = (float(self.current_joints[column]) for column in self.machine.rotary)
        self.set_plane(AffineMap(tool_orientation.tool_frame(self.machine, (first, second))))

    def turn_axes(self, axes: dict[str, AxisWord], *, feed_written: bool) -> None:
        """Turn rotary axes in a plane without TCP: the slides stand still, and the plane stays as it is."""
        rotary = self.rotary_target(axes)
        self.resolve_rows()
        bits = int(ProgrammedWord.FEED) if feed_written else 0
        self.move_axes(self._line_kind, self.current_joints[self._slides].copy(), rotary, bits)

    def retract(self) -> None:
        """M242: Z moves to the end of its travel; no motion if the machine's definition does not give the travel."""
        self.add_event("retract", "M242")
        if self.tcp:
            self.note(Wording("NC341", "m242_while_tcp"), Severity.ERROR)
        axis = self.machine.axis("Z")
        top = axis.high if axis.sense > 0.0 else axis.low
        if not math.isfinite(top):
            return
        self.resolve_rows()
        slides = self.current_joints[self._slides].copy()
        slides[2] = top
        self.modal.machine_frame.set(self.row, True)
        self.move_axes(Kind.RAPID, slides, bits=int(ProgrammedWord.Z))
        self.modal.machine_frame.set(self.row, False)

    def go_to_machine(self, axes: dict[str, AxisWord], *, feed_written: bool) -> None:
        """G290: move to positions of the machine axes."""
        words = {name: (word[0], PositionMode.ABSOLUTE) for name, word in axes.items()}
        self.move(words, None, machine_frame=True, feed_written=feed_written)
