"""The part of virtual controls that languages of the RS274 kind share: circles, and the tool length along Z."""

from collections.abc import Hashable, Mapping
from functools import partial
from typing import Final

from trunnion.arrays import Floats
from trunnion.errors import Severity
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.readers.control import arcs
from trunnion.readers.control.event_recorder import Note
from trunnion.readers.control.row_recorder import MAX_POSITION
from trunnion.readers.control.start_modes import CENTRES
from trunnion.readers.control.virtual_control import LINEAR, RAPID, Circle, VirtualControl
from trunnion.readers.rs274 import arc_vectors
from trunnion.readers.rs274.word_meanings import NO_WORDS, WordMeanings

#: Motions in force besides rapid and lines: G2 and G3.
CLOCKWISE: Final = 2
COUNTER_CLOCKWISE: Final = 3

#: Circles with more turns are mistakes of the program.
MAX_TURNS: Final = 1000


class Rs274Control(VirtualControl):
    """A control whose circles have a centre I J K or a radius R."""

    #: Words that the control has in place of the family's.
    own_words: WordMeanings = NO_WORDS

    #: Whether I J K count from the start of the circle; else they are absolute.
    relative_centres = True

    #: What these are then: from the start to the centre, or what the definition states instead.
    arc_vectors = ""

    #: Whether the tool length counts along Z.
    length_active = False

    def __init__(self, machine: Machine, note: Note, *, shortest: bool | None = None) -> None:
        super().__init__(machine, note, shortest=shortest)
        self.motion = RAPID  # that of the interpreter: G80 and cycles bring it back

    #: Whether the control counts in inches when no program runs.
    usual_inches = False

    def count_in(self, unit: str) -> None:
        """Count in a unit that the definition of the control states: ``mm`` or ``inch``; empty: it states none."""
        self.usual_inches = unit == "inch"
        if unit:
            self.set_units(unit == "inch", True)

    def start_with(self, modes: Mapping[str, Hashable]) -> None:
        """Start with modes that the definition states."""
        super().start_with(modes)
        if CENTRES in modes:
            self.relative_centres = bool(modes[CENTRES])

    def usual(self, name: str) -> Hashable:
        """Return the value of a mode with which any program may end."""
        return self.usual_inches if name == "units" else super().usual(name)

    def left_on(self) -> Wording | None:
        """Return what the end of the program leaves on, so that the next one begins with it; None if nothing."""
        return None

    @property
    def _length_axis(self) -> int:
        return 2 if self.length_active else -1

    def set_length(self, on: bool) -> None:
        """Switch the tool length; it counts along Z if it is known."""
        if on == self.length_active:
            return
        if not self.machine.tool_length:
            self.length_active = on
        else:
            with self.frame_change():
                self.length_active = on
        self.record_length()

    def circle(self, words: Mapping[str, float], turns: int = 0) -> Circle | None:
        """Return the circle of a block in the motion in force; None if that is a line.

        words   I, J, K and R, in the units of the program
        turns   whole turns besides
        """
        if self.motion <= LINEAR:
            return None
        return partial(self._arc, words, turns)

    def _arc(self, words: Mapping[str, float], turns: int, start: Floats, end: Floats) -> arcs.Arc:
        if not 0 <= turns < MAX_TURNS:
            raise arcs.ArcError(Wording("NC320", "too_many_turns_of_circle", turns=turns))
        if any(abs(value) * self.length_unit > MAX_POSITION for value in words.values()):
            raise arcs.ArcError(Wording("NC320", "circle_numbers_no_machine"))
        clockwise = self.motion == CLOCKWISE
        given = {axis: words[name] * self.length_unit for axis, name in enumerate("IJK") if name in words}
        if self.plane_axis in given:
            severity = Severity.ERROR if given.pop(self.plane_axis) else Severity.WARNING
            self.note(Wording("NC213", "no_word_of_circle", word="IJK"[self.plane_axis]), severity)
        if "R" in words:
            if given:
                self.note(Wording("NC216", "r_centre_block_r_counts"), Severity.ERROR)
            return arcs.by_radius(start, end, words["R"] * self.length_unit, self.plane_axis, clockwise, turns)
        if not given:
            raise arcs.ArcError(Wording("NC320", "circle_no_centre"))
        if not self.relative_centres and len(given) < 2:
            raise arcs.ArcError(Wording("NC320", "circle_needs_both_words_centre"))
        if self.relative_centres:
            normal = arcs.normal_of(self.plane_axis, clockwise)
            centre = arc_vectors.centre_of(start, end, normal, given, self.arc_vectors)
        else:
            centre = start.copy()
            centre[list(given)] = list(given.values())
        self.check_radii(start, end, centre)
        return arcs.by_centre(start, end, centre, self.plane_axis, clockwise, turns)

    def check_radii(self, start: Floats, end: Floats, centre: Floats) -> None:
        """Raise ``arcs.ArcError`` if the radii at start and end differ more than this control allows."""
