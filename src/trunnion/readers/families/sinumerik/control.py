"""The virtual control of a Sinumerik: its circles, frames along the tool, swivelled planes and tool length.

The tool length, if it is known, is that of the control's tool offset. Without TRAORI an edge (D1) adds it to the slide
normal to the working plane, wherever the tool points; D0 removes it.
"""

import math
from collections.abc import Mapping, Sequence
from functools import cached_property, partial
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.compensation.styles import CIRCLES, MEETINGS, UNKNOWN_STYLE
from trunnion.errors import Severity
from trunnion.machines import AngleOutput, Axis, Machine, forward
from trunnion.messages import Wording
from trunnion.model.mode_words import TOOL_AXIS
from trunnion.model.run import NO_OFFSET, Orientation
from trunnion.model.spindle_work import SpindleWork
from trunnion.model.toolpath import Kind
from trunnion.readers.control import arcs, tool_orientation
from trunnion.readers.control.affine_map import AffineMap
from trunnion.readers.control.axis_word import AxisWord, PositionMode
from trunnion.readers.control.event_recorder import Note
from trunnion.readers.control.hole_motion import HoleMotion
from trunnion.readers.control.row_recorder import MAX_POSITION
from trunnion.readers.control.start_modes import ANGLES, VECTOR_FRAME, VECTORS
from trunnion.readers.control.virtual_control import LINEAR, Circle, VirtualControl
from trunnion.readers.families.sinumerik.settings import START_MODES, WITH_LENGTH, Settings, settings_of
from trunnion.readers.families.sinumerik.words import BOTTLENECKS, WITHIN_COMPENSATION
from trunnion.readers.scan.letter_blocks import letter_table

#: Motions in force besides rapid and lines: G2, G3, CIP.
CLOCKWISE: Final = 2
COUNTER_CLOCKWISE: Final = 3
THROUGH: Final = 4

#: POLY, in whose blocks axes without a polynomial move evenly.
POLYNOMIAL: Final = 5

#: CT, a circle that goes on in the direction of the last motion.
TANGENT: Final = 6


class SinumerikControl(VirtualControl):
    """A Sinumerik on a machine.

    tool_frame  between TOROT or TOFRAME and the words that end them: Z of the frame is along the tool. Settings of the
                control decide where X and Y point, and whether it is a frame of its own, which TRANS does not delete.
    """

    compensation_style = CIRCLES
    no_offset = NO_OFFSET
    doubtful_modes = frozenset({"offset"})
    reset_by = "whether the end of a program ends it depends on machine data 20150 and 20152"
    knows_units = True
    start_modes = START_MODES

    def __init__(self, machine: Machine, note: Note, *, shortest: bool | None = None) -> None:
        self._machine_vectors = False
        self.tool_frame = False
        self._offset_is_lost = False
        self._programmed_ends, self._smooths = "off", False
        # The word in force of each group that counts within radius compensation.
        self._compensation_modes: dict[str, str] = {}
        super().__init__(machine, note, shortest=shortest)
        if self._settings.unit:  # as G700 and G710 do: feeds count in it too
            self.set_units(self._settings.unit == "inch", True)
        self.letter_table = letter_table(self.rotary_names, comment=";", assign="=")

    def add_exact_stop(self, mode: str) -> None:
        """Record a G code of exact stops, which counts until ``smooth`` switches, or another one."""
        if mode != "block":
            self._programmed_ends, self._smooths = mode, False
        super().add_exact_stop(mode)

    def smooth(self, on: bool) -> None:
        """Switch continuous path on, as CYCLE832 does, or go back to the G code that the program had before it."""
        if on != self._smooths and self._programmed_ends != "off":
            super().add_exact_stop("off" if on else self._programmed_ends)
        self._smooths = on

    def lose_offset(self) -> None:
        """Record that TRAORI clears the work offset that is selected; the coordinates stay those of the program."""
        if self.modal.work_offset.current not in (0, NO_OFFSET) and not self._offset_is_lost:
            self._offset_is_lost = True
            self.add_event("offset", "TRAORI")

    def regain_offset(self, code: int) -> None:
        """Record that the program selects a work offset again after ``lose_offset``."""
        if self._offset_is_lost:
            self._offset_is_lost = False
            self.add_event("offset", float(code))

    def takes_shortest_path(self, axis: Axis) -> bool:
        """With TRAORI, except for axes whose output has all turns."""
        return self.tcp and axis.output is not AngleOutput.NONE

    def _vector_map(self, frame: AffineMap) -> Floats:
        return np.eye(3) if self._machine_vectors else super()._vector_map(frame)

    @property
    def _length_axis(self) -> int:
        if self.modal.edge.current <= 0:
            return -1
        return 2 if self._settings.length_along_z else self.plane_axis

    def set_edge(self, edge: int) -> None:
        """Select the edge (D word) whose offsets hold."""
        if not self.machine.tool_length or (edge > 0) == (self.modal.edge.current > 0):
            self.modal.edge.set(self.row, edge)
        else:
            with self.frame_change():
                self.modal.edge.set(self.row, edge)
        self.record_length()

    def compensate(self, side: int) -> None:
        """Switch radius compensation: 1 left of the path, -1 right of it, 0 off."""
        self.modal.compensation.set(self.row, side)
        if side:
            for word in self._compensation_modes.values():
                self._report_compensation_mode(word)

    def modify_compensation(self, word: str) -> None:
        """Execute a word that counts within radius compensation."""
        self._compensation_modes[WITHIN_COMPENSATION[word][0]] = word
        if word in ("NORM", "KONT", "G450", "G451", "DISC"):
            self._set_style()
        if self.modal.compensation.current:
            self._report_compensation_mode(word)

    def _set_style(self) -> None:
        """Note how corners are rounded; KONT, which may go round the first point, and DISC are not simulated."""
        modes = self._compensation_modes
        style = MEETINGS if modes.get("outer") == "G451" else CIRCLES
        known = modes.get("approach") != "KONT" and modes.get("outer") != "DISC"
        self.modal.compensation_style.set(self.row, style if known else UNKNOWN_STYLE)

    def _report_compensation_mode(self, word: str) -> None:
        if effect := WITHIN_COMPENSATION[word][1]:
            self.note(
                Wording("NC220", "within_radius_compensation_not_simulated", word=word, effect=effect), Severity.ERROR
            )
        elif word == BOTTLENECKS:
            self.note(Wording("NC221", "bottlenecks", word=word), Severity.WARNING)

    def set_working_plane(self, plane: int) -> None:
        """Select the working plane (G17, G18, G19) by its normal axis."""
        if not self.machine.tool_length or plane == self.plane_axis:
            self.plane_axis = plane
        else:
            with self.frame_change():
                self.plane_axis = plane
        self.record_length()

    def set_orientation(self, orientation: Orientation) -> None:
        """Set how the tool axis moves within blocks (ORIAXES, ORIVECT), whether angles or vectors program it."""
        for mode in (ANGLES, VECTORS):
            self.said_from.setdefault(mode, self.row)
        super().set_orientation(orientation)

    def set_machine_vectors(self, on: bool) -> None:
        """Select whether vectors are in the machine frame (ORIMKS) or the workpiece frame (ORIWKS)."""
        self.resolve_rows()
        self.said_from.setdefault(VECTOR_FRAME, self.row)
        self.say_mode(TOOL_AXIS, "ORIMKS" if on else "ORIWKS")
        self._machine_vectors = on
        self._update_maps()

    # Positions of the machine

    def _machine_move(self, axes: Mapping[str, AxisWord], bits: int, circle: bool) -> None:
        """Move to positions of the machine axes; machine data say whether the length of an edge in force counts."""
        axis, edge = self._length_axis, int(self.modal.edge.current)
        along = "XYZ"[axis]
        if axis >= 0 and along in axes:
            value, mode = axes[along]
            if not self._settings.machine_positions:
                self.note(Wording("NC224", "machine_position_with_length", axis=along, edge=edge), Severity.ERROR)
            elif self._settings.machine_positions == WITH_LENGTH and not self._is_incremental(mode):
                value += float(self._length_offset[axis]) / self.length_unit
                axes = {**axes, along: (value, mode)}
        super()._machine_move(axes, bits, circle)

    # Circles

    def circle(self, params: Mapping[str, AxisWord], axes: Mapping[str, AxisWord]) -> Circle | None:
        """Return the circle of a block in the motion in force; None if that is a line.

        params   I, J, K, I1, J1, K1, CR, AR, TURN
        axes     as in ``move``
        """
        if self.motion <= LINEAR or self.motion == POLYNOMIAL:
            return None
        in_plane = any(name in axes for axis, name in enumerate("XYZ") if axis != self.plane_axis)
        return partial(self._arc, params, in_plane)

    def _arc(self, params: Mapping[str, AxisWord], in_plane: bool, start: Floats, end: Floats) -> arcs.Arc | None:
        turns = int(params.get("TURN", (0.0, PositionMode.MODAL))[0])
        if not 0 <= turns < 1000:
            raise arcs.ArcError(Wording("NC320", "bad_turns", turns=turns))
        if any(abs(value) * self.length_unit > MAX_POSITION for value, _ in params.values()):
            raise arcs.ArcError(Wording("NC320", "circle_numbers_no_machine"))
        if self.motion == TANGENT:
            for word in sorted(params.keys() - {"TURN"}):
                self.note(Wording("NC213", "unused_word", word=word), Severity.ERROR)
            return arcs.tangential(start, end, self.end_direction(), self.plane_axis, turns)
        if self.motion != THROUGH:
            return self._plane_arc(params, in_plane, turns, start, end)
        through = end.copy()
        for axis, name in enumerate(("I1", "J1", "K1")):
            value, how = params.get(name, (0.0, PositionMode.INCREMENTAL))
            value *= self.length_unit
            through[axis] = start[axis] + value if self._is_incremental(how) else value
        return arcs.by_points(start, through, end, turns)

    def _plane_arc(
        self, params: Mapping[str, AxisWord], in_plane: bool, turns: int, start: Floats, end: Floats
    ) -> arcs.Arc:
        clockwise = self.motion == CLOCKWISE
        centre = None
        for axis, name in enumerate("IJK"):
            if name not in params:
                continue
            if axis == self.plane_axis:
                severity = Severity.ERROR if params[name][0] else Severity.WARNING
                self.note(Wording("NC213", "no_word_of_circle", word=name), severity)
                continue
            centre = start.copy() if centre is None else centre
            value, how = params[name]
            value *= self.length_unit
            centre[axis] = value if how is PositionMode.ABSOLUTE else start[axis] + value
        if "CR" in params:
            radius = params["CR"][0] * self.length_unit
            if centre is not None:
                self.note(Wording("NC216", "cr_centre_block_cr_counts"), Severity.ERROR)
            return arcs.by_radius(start, end, radius, self.plane_axis, clockwise, turns)
        if "AR" in params:
            angle = params["AR"][0]
            if centre is None:
                return arcs.by_angle(start, end, angle, self.plane_axis, clockwise, turns)
            arc = arcs.by_angle_and_centre(start, centre, angle, self.plane_axis, clockwise, turns)
            arc.end[self.plane_axis] = end[self.plane_axis]
            return arc
        if centre is None:
            raise arcs.ArcError(Wording("NC320", "circle_no_centre" if in_plane else "circle_neither_end_nor_centre"))
        return arcs.by_centre(start, end, centre, self.plane_axis, clockwise, turns)

    def end_at_angle(self, axes: Mapping[str, AxisWord], angle: float) -> dict[str, AxisWord]:
        """Return the axes of a line with the coordinate of the plane that follows from its angle, degrees.

        The angle counts from the first axis of the plane. Raises ``arcs.ArcError`` where it makes no line.
        """
        names = ["XYZ"[(self.plane_axis + k) % 3] for k in (1, 2)]
        given = [name for name in names if name in axes]
        if len(given) != 1:
            raise arcs.ArcError(Wording("NC220", "angle_of_contour", angle=angle))
        name, other = given[0], names[1 - names.index(given[0])]
        way = dict(zip(names, (math.cos(math.radians(angle)), math.sin(math.radians(angle))), strict=True))
        if self.motion > LINEAR or abs(way[name]) < arcs.SAME_POINT:
            raise arcs.ArcError(Wording("NC220", "angle_without_line", angle=angle))
        value, how = axes[name]
        step = value if self._is_incremental(how) else value - self._start_of(name)
        if step / way[name] < 0.0:
            raise arcs.ArcError(Wording("NC220", "angle_leads_away", angle=angle, axis=name))
        return {**axes, other: (self._start_of(other) + step / way[name] * way[other], PositionMode.ABSOLUTE)}

    def _start_of(self, name: str) -> float:
        """Return the programmed position of an axis in the unit of the program."""
        return float(self.programmed_position["XYZ".index(name)]) / self.length_unit

    # Frames along the tool

    @cached_property
    def _settings(self) -> Settings:
        return settings_of(self.machine)

    def turn_frame(self, word: str) -> None:
        """TOROT (the zero stays), TOFRAME (the zero becomes that of the work offset), and the words that end them."""
        program = self.program_frame
        if word.endswith("OF"):
            if self.tool_frame:
                self.set_program_frame(AffineMap(shift=program.shift), keep_base=False)
                self.add_event("frame", "")
            self.tool_frame = False
            return
        if not self.tcp or self.tilted or (not self.tool_frame and not np.array_equal(program.linear, np.eye(3))):
            self.note(Wording("NC340", "without_traori_top_turned_frame", word=word), Severity.ERROR)
            return
        self.set_program_frame(
            self._along_tool(program.shift if word.startswith("TOROT") else np.zeros(3)), keep_base=False
        )
        self.tool_frame = True
        self.add_event("frame", word)

    def _along_tool(self, zero: Floats) -> AffineMap:
        """Return the frame at a zero with Z along the tool and X in the XZ plane of the work offset."""
        self.resolve_rows()
        z = forward(self.machine, self.current_joints[None])[1][0]
        x = np.array([z[2], 0.0, -z[0]])
        length = float(np.linalg.norm(x))
        x = np.array([1.0, 0.0, 0.0]) if length < 1e-9 else x / length
        return AffineMap(np.column_stack((x, np.cross(z, x), z)), zero)

    def drill(self, motions: Sequence[HoleMotion], work: SpindleWork | None = None) -> None:
        """Execute a drilling cycle at the present position; along the tool if the machine's definition sets that."""
        turns = self.tcp and not (self.tilted or self.tool_frame) and self._settings.cycles_along_tool
        program = self.program_frame
        if turns:
            self.set_program_frame(self._along_tool(program.shift), keep_base=False)
        if (turns or self.tool_frame) and any(any(motion.lateral) for motion in motions):
            self.note(Wording("NC224", "cycle_lifts_off_along_x"), Severity.ERROR)
        super().drill(motions, work)
        if turns:
            self.set_program_frame(program, keep_base=False)

    def leave_spindle(self, sense: int) -> None:
        """Let a cycle leave the spindle turning in a sense (1, -1), or standing (0)."""
        if sense != int(self.modal.spindle.current):
            self.modal.spindle.set(self.row, sense)
            self.add_event("spindle", {1: "clockwise", -1: "counter-clockwise", 0: "off"}[sense])

    # CYCLE800

    def swivel(self, frame: AffineMap, *, add: bool, direction: float, direct: tuple[float, float] | None) -> None:
        """CYCLE800: swivel the plane, and move the rotary axes to it.

        add         define the plane in the plane and frames in force, instead of replacing them
        direction   -1 or 1: the solution with the lower or higher value of the second rotary axis; 0: do not move
        direct      rotary values given in the cycle, which determine the plane
        """
        self.resolve_rows()
        outer = self.frame if add else AffineMap()
        rotary: tuple[float, float] | None = direct
        if direct is not None:
            frame = AffineMap(tool_orientation.tool_frame(self.machine, direct) @ frame.linear, frame.shift)
        total = outer.compose(frame)
        if rotary is None and direction:
            rotary = self._rotary_solution(total.linear[:, 2], direction)
        if rotary is not None:
            self.move_axes(Kind.RAPID, self.current_joints[self._slides].copy(), self.rotary_position(rotary))
        self.set_plane(total)
        if total.is_identity:
            self.add_event("level")

    def _rotary_solution(self, normal: Floats, direction: float) -> tuple[float, float] | None:
        """Return rotary values whose tool axis is ``normal``, with the second axis on the side of ``direction``."""
        pairs = tool_orientation.solutions(self.machine, normal, self.current_joints)
        if not pairs:
            self.note(Wording("NC350", "cycle800_no_rotary_position_stands"), Severity.ERROR)
            return None
        inside = [pair for pair in pairs if tool_orientation.is_in_travel(self.machine, pair)]
        if not inside:
            self.note(Wording("NC350", "cycle800_no_rotary_position_inside"), Severity.ERROR)
            return None
        chosen = sorted(pairs, key=lambda pair: pair[1], reverse=direction > 0)[0]
        if chosen not in inside:
            self.note(Wording("NC350", "cycle800_solution_dir_asks_outside"), Severity.ERROR)
            chosen = inside[0]
        target = tool_orientation.nearest_in_travel(self.machine, chosen, self.current_joints)
        if tool_orientation.is_other_solution(self.machine, target, self.current_joints, normal):
            self.note(Wording("NC350", "cycle800_turns_tool_stands_plane"), Severity.ERROR)
        return target
