"""The virtual control of a Fanuc: its frames, its tilted planes, and the rotary positioning by G53.1."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np

from trunnion.arrays import Codes, Floats
from trunnion.errors import Severity
from trunnion.machines import AngleOutput, Axis, Machine, Mount
from trunnion.messages import Wording, phrase
from trunnion.model.axis_positions import PLAIN
from trunnion.model.diagnostics import Diagnostic
from trunnion.model.run import Comment, ProgrammedWord, Run
from trunnion.model.toolpath import Kind
from trunnion.readers.control import tool_orientation
from trunnion.readers.control.affine_map import AffineMap, rotation_about, rotation_matrix
from trunnion.readers.control.axis_word import AxisWord, PositionMode, RotaryTarget
from trunnion.readers.control.event_recorder import Note
from trunnion.readers.families.fanuc.settings import Settings, start_modes_of
from trunnion.readers.rs274.block import Block
from trunnion.readers.rs274.control import Rs274Control
from trunnion.readers.scan.letter_blocks import letter_table


class FanucControl(Rs274Control):
    """A Fanuc on a machine. Work offsets that the program does not set are the machine's workpiece zero.

    settings  how the control is set
    system    number of the work offset in force: 1 to 6 for G54 to G59, more for G54.1
    preset    the shift of G92, (3,) mm
    local     the shift of G52, (3,) mm
    rotation  G68 as one map
    vectors   G43.5: words I J K of lines are vectors
    length_ended_at  line of the G28 or H0 that has taken the tool length off, 0 if a G word has set it since
    length_ended_by  the word that did
    plane_of_pose  the tilted plane is that of the rotary position
    """

    # A reset, and with it the end of a program, keeps units and stroke limits in any case (docs/reader-fanuc.md).
    kept_modes = frozenset({"units", "limits"})
    doubtful_modes = frozenset({"distances", "plane", "feed", "compensation", "offset", "length"})

    def __init__(self, machine: Machine, note: Note, settings: Settings, *, shortest: bool | None = None) -> None:
        self.compensation_style = settings.compensation_style
        super().__init__(machine, note, shortest=shortest)
        self.settings = settings
        self.own_words = settings.words
        self.start_modes = start_modes_of(settings.words)
        self.reset_by = f"whether a reset ends it depends on {settings.kept_by}"
        self._letter_tables = {
            (whole_feeds, vectors, turning): self._make_table(whole_feeds, vectors, turning)
            for whole_feeds in (True, False)
            for vectors in (True, False)
            for turning in (True, False)
        }
        self.system = 1
        self._offset_values: dict[int, Floats] = {}
        self.preset = np.zeros(3)
        self.local = np.zeros(3)
        self.rotation = AffineMap()
        # G51.1: the position about which an axis is mirrored, mm, by axis.
        self.mirrored: dict[int, float] = {}
        self._rotated_in_space = False
        self.vectors = False
        self.plane_of_pose = False
        self.length_ended_at, self.length_ended_by = 0, ""
        self.count_in(settings.unit)
        # The first block with a number without a point of which nobody says how it counts, and how many there are.
        self._first_whole: Diagnostic | None = None
        self._whole_blocks = 0
        # Of two axes in one table or one head the one that carries the other decides, on mixed machines the table.
        self.deciding_axis = 1 if all(machine.axes[k].mount is Mount.PART for k in machine.rotary) else 0

    def takes_shortest_path(self, axis: Axis) -> bool:
        """Return True, as on axes that are set to roll over, except for axes whose output has all turns."""
        return axis.output is not AngleOutput.NONE

    def _make_table(self, whole_feeds: bool, vectors: bool, turning: bool) -> Codes:
        """Return a letter table; ``whole_feeds`` if a whole number after F counts as it is."""
        # Rotary words are no plain words where the tool axis is a vector, or where they must not turn axes.
        plain = () if vectors or not turning else self.rotary_names
        need_point = (
            "" if self.settings.calculator else f"XYZ{''.join(self.rotary_names)}IJK" + ("" if whole_feeds else "F")
        )
        return letter_table(plain, gaps=True, need_point=need_point, vector="IJK" if vectors else "")

    @property
    def letter_table(self) -> Codes:
        """The letter table for the present modes."""
        whole_feeds = self.modal.feed_mode.current in (93, 94) and self.length_unit == 1.0
        whole_feeds = whole_feeds and not self.settings.whole_feeds_count
        return self._letter_tables[whole_feeds, self.vectors, not self.plane_of_pose]

    def scale(self, block: Block, *, angles: str, plain: Collection[str]) -> None:
        """Scale the numbers of a block without a point, and count it if no definition says how these count."""
        mode, inches = self.modal.feed_mode.current, self.length_unit != 1.0
        changed = self.settings.scale(block, mode, inches, angles=angles, plain=plain)
        if changed is None or self.settings.states_numbers:
            return
        self._whole_blocks += 1
        if self._first_whole is None:
            taken = Wording("NC224", "number_without_point", word=changed[0], value=changed[1])
            self._first_whole = Diagnostic(self.line, taken, Severity.WARNING, str(self.modal.file.current))

    def finish(self, files: Sequence[str], comments: list[Comment], diagnostics: Sequence[Diagnostic]) -> Run:
        """Return the run, with a warning if numbers without a point count in increments that nobody has stated."""
        if (first := self._first_whole) is not None:
            said, count = first.wording, self._whole_blocks
            said = said if count == 1 else said.within("first_of_kind", count=count)
            diagnostics = [*diagnostics, replace(first, wording=said, file=files[int(first.file)])]
        return super().finish(files, comments, diagnostics)

    def change_tool(self) -> None:
        """Change to the selected tool; some controls switch the spindle and coolant off with it."""
        super().change_tool()
        if not self.settings.tool_change_stops:
            return
        if self.modal.spindle.current:
            self.add_event("spindle", "off")
        flowing = next((each.value for each in reversed(self.events) if each.kind == "coolant"), "off")
        if flowing != "off":
            self.add_event("coolant", "off")

    # Frames

    @property
    def zero(self) -> Floats:
        """The workpiece zero in slide positions, (3,) mm."""
        return self._zero_slides

    def offset_of(self, system: int) -> Floats:
        """Return a work offset in slide positions, (3,) mm."""
        return self._offset_values.get(system, self.zero)

    def set_values(self, system: int, values: Floats) -> None:
        """Set a work offset, 1 for G54: its slides (3,), mm, machine frame."""
        self._offset_values[system] = values
        self.update_frame()

    @property
    def _shift(self) -> Floats:
        return np.asarray(self.offset_of(self.system) - self.zero + self.preset + self.local)

    def left_on(self) -> Wording | None:
        """Return the mirror image, rotation or unused shift that the end of the program leaves on; None if nothing.

        The plane of the rotary position (G254 of a Haas) ends with M2 and M30.
        """
        if self.mirrored:
            return phrase("left_word", word="G51.1")
        if not self.rotation.is_identity:
            return phrase("left_word", word="G68")
        return next((phrase("left_word", word=word) for word in self.shifts_on if self.unused_shift), None)

    @property
    def shifts_on(self) -> list[str]:
        """The words whose shift of all work offsets is on."""
        return [word for word, shift in (("G52", self.local), ("G92", self.preset)) if shift.any()]

    def mirror(self, axes: Mapping[int, float | None]) -> None:
        """G51.1, G50.1: mirror axes about a position, mm, or no longer (None)."""
        kept = {axis: place for axis, place in self.mirrored.items() if axis not in axes}
        self.mirrored = kept | {axis: place for axis, place in axes.items() if place is not None}
        self.update_frame()

    def judge_mirror(self) -> None:
        """Note what is not simulated together with a mirror image."""
        rotated = self.tilted or self.tcp or not self.rotation.is_identity
        if self.mirrored and (rotated or self.plane_axis in self.mirrored or self.modal.compensation.current):
            self.note(Wording("NC220", "mirror_with_others"), Severity.ERROR)

    def update_frame(self) -> None:
        """Put offsets, rotations and mirror images into effect; the axes stay."""
        if self.mirrored:
            signs, places = np.ones(3), np.zeros(3)
            for axis, place in self.mirrored.items():
                signs[axis], places[axis] = -1.0, 2.0 * place
            mirror = AffineMap(np.diag(signs), places)
            self.judge_mirror()
            self.set_program_frame(AffineMap(np.eye(3), self._shift).compose(mirror), keep_base=False)
        elif self.tilted:
            # The plane is fixed in the work offset that was in force when it was tilted.
            self.set_program_frame(self.rotation, keep_base=False)
        else:
            base = AffineMap(np.eye(3), self._shift)
            self.set_program_frame(base.compose(self.rotation), keep_base=False)

    def rotate(self, centre: Floats, direction: Floats, angle: float) -> None:
        """G68: rotate by an angle, degrees, about an axis through a point, mm, both (3,), on top of a G68 in force."""
        if abs(abs(float(direction[self.plane_axis])) - 1.0) > 1e-12:
            self._report_length("G68")
            self._rotated_in_space = True
        linear = _rotation(direction, angle)
        self.rotation = self.rotation.compose(AffineMap(linear, centre - linear @ centre))
        self.update_frame()

    def tilt(self, origin: Floats, euler: tuple[float, float, float]) -> None:
        """G68.2: tilt the plane by its origin (3,), mm, and Euler angles Z, X, Z, degrees, in the work offset."""
        self._report_length("G68.2")
        if self.tilted:
            self.note(Wording("NC351", "g68_2_while_plane_tilted"), Severity.WARNING)
        first, second, third = euler
        linear = rotation_matrix(2, first) @ rotation_matrix(0, second) @ rotation_matrix(2, third)
        self.rotation = AffineMap()
        self.set_plane(AffineMap(linear, self._shift + origin))
        self.add_event("tilt", "G68.2")
        if AffineMap(linear, origin).is_identity:
            self.add_event("level")
        if np.allclose(linear[:, 2], (0.0, 0.0, 1.0), rtol=0.0, atol=1e-9):
            self.preconditions.meet("G53.1")
        else:
            self.preconditions.require("G53.1", Wording("NC351", "plane_before_turn"))

    def end_length(self, word: str) -> None:
        """Take the tool length off by a word that is no G word of lengths."""
        if self.length_active:
            self.length_ended_at, self.length_ended_by = self.line, word
        self.set_mode("length", word, self.length_active, False)
        self.set_length(False)

    def _report_length(self, word: str) -> None:
        """Report a word that switches a plane inside a tool length: the length must be switched inside the plane."""
        if self.length_active and not self.plane_of_pose:
            self.note(Wording("NC340", "tool_length_force_alarm_ps0049", word=word), Severity.ERROR)

    def cancel_rotation(self) -> None:
        """G69: cancel rotations and the tilted plane; one that follows the rotary position stays."""
        if self.tilted or self._rotated_in_space:
            self._report_length("G69")
        self.rotation = AffineMap()
        self._rotated_in_space = False
        self.preconditions.meet("G53.1")
        if self.tilted and not self.plane_of_pose:
            self.set_plane(None)
            self.add_event("tilt", "")
        self.update_frame()

    def take_plane_of_pose(self) -> None:
        """Take the plane normal to the tool as it stands, about the zero of the work offset."""
        if self.tcp:
            self.note(Wording("NC340", "plane_rotary_position_while_tcp"), Severity.ERROR)
        self.resolve_rows()
        first, second = (float(self.current_joints[column]) for column in self.machine.rotary)
        self.rotation = AffineMap()
        self.set_plane(AffineMap(tool_orientation.tool_frame(self.machine, (first, second)), self._shift))
        self.plane_of_pose = True

    def leave_plane_of_pose(self) -> None:
        """End the plane of the rotary position."""
        if self.plane_of_pose:
            self.plane_of_pose = False
            self.set_plane(None)
            self.update_frame()

    def align_with_plane(self) -> None:
        """G53.1: turn the rotary axes so that the tool is normal to the plane, with the least rotation."""
        if not self.tilted:
            self.note(Wording("NC351", "g53_1_without_plane_g68"), Severity.ERROR)
            return
        self.preconditions.meet("G53.1")
        self.resolve_rows()
        pairs = tool_orientation.solutions(self.machine, self.frame.linear[:, 2], self.current_joints)
        inside = [
            tool_orientation.nearest_in_travel(self.machine, pair, self.current_joints)
            for pair in pairs
            if tool_orientation.is_in_travel(self.machine, pair)
        ]
        if not inside:
            self.note(Wording("NC350", "g53_1_no_rotary_position"), Severity.ERROR)
            return
        current, first = self.current_joints[list(self.machine.rotary)], self.deciding_axis
        rotations = [np.round(np.abs(np.array(pair) - current), 6).tolist() for pair in inside]
        _, best = min(zip(rotations, inside, strict=True), key=lambda item: (item[0][first], item[0][1 - first]))
        self.add_event("tilt", "G53.1")
        target = RotaryTarget(best, PLAIN, int(ProgrammedWord.FIRST | ProgrammedWord.SECOND))
        self.move_axes(Kind.RAPID, self.current_joints[self._slides].copy(), target)

    # Positions of the machine

    def go_to_machine(self, goal: dict[str, float]) -> None:
        """Move to positions of axes, mm and degrees."""
        axes: dict[str, AxisWord] = {
            name: (value / self.length_unit if name in "XYZ" else value, PositionMode.ABSOLUTE)
            for name, value in goal.items()
        }
        self.move(axes, None, machine_frame=True)


def _rotation(direction: Floats, angle: float) -> Floats:
    """Return the rotation about a unit vector, (3, 3), exact about X, Y and Z."""
    axis = int(np.argmax(np.abs(direction)))
    if abs(abs(direction[axis]) - 1.0) < 1e-12:
        return rotation_matrix(axis, float(np.sign(direction[axis])) * angle)
    return rotation_about(direction, angle)
