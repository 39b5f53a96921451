"""The virtual control: the motions that programmed words ask for.

It knows no text and no language. The interpreter of a family passes on what a block programs, and the control records
rows. What only one family does is in that family's control, which extends this one.
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Hashable, Mapping, Sequence
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.compensation.styles import UNKNOWN_STYLE
from trunnion.errors import Severity
from trunnion.machines import AngleOutput, Axis, Machine, forward
from trunnion.messages import Wording
from trunnion.model import axis_positions
from trunnion.model.run import ProgrammedWord
from trunnion.model.spindle_work import SpindleWork
from trunnion.model.splines import Spline, SplineRows
from trunnion.model.toolpath import Kind
from trunnion.readers.control import arcs
from trunnion.readers.control.affine_map import affine_matrix
from trunnion.readers.control.axis_word import NO_ROTARY, AxisWord, PositionMode, RotaryTarget
from trunnion.readers.control.contour_control import ContourControl
from trunnion.readers.control.event_recorder import Note
from trunnion.readers.control.hole_motion import HoleMotion
from trunnion.readers.control.preconditions import Preconditions
from trunnion.readers.control.row_recorder import ScannedRows, within_limits
from trunnion.readers.scan.buffers import ScanSettings

#: Motions in force: G0 and G1.
RAPID: Final = 0
LINEAR: Final = 1

#: How far tool axis and drilling axis may differ without a warning, as the length of their difference.
MAX_DRILLING_AXIS_ERROR: Final = 2e-4

#: Makes the circle of a block from its start and end, programmed positions; None: it is a line. Raises ``ArcError``.
Circle = Callable[[Floats, Floats], arcs.Arc | None]


#: G93: F is one over the minutes of a block.
_INVERSE_TIME: Final = 93


class VirtualControl(ContourControl, ABC):
    """A control that executes motions on a machine.

    preconditions  what the program must say before the tool moves at the part
    motion         the motion in force: ``RAPID``, ``LINEAR`` or one of the circles of the family
    shortest       how endless rotary axes reach plain words: True by the shorter way, False not so, None as the control
    compensation_style    how it compensates in a plane, a key of ``compensation.styles.STYLES``; 0: not known
    compensates_in_space  radius compensation is across the tool, by a word for it (G41.2, CUT3DC)
    rotary_names   letters of the rotary axes that the machine has
    """

    compensation_style = UNKNOWN_STYLE

    def __init__(self, machine: Machine, note: Note, *, shortest: bool | None = None) -> None:
        super().__init__(machine, note)
        self.modal.compensation_style.set(0, self.compensation_style)
        self.preconditions = Preconditions(self._fault_at)
        self.motion = LINEAR
        self.shortest = shortest
        self.compensates_in_space = False
        # Where the last drilling cycle was judged: it is called for each hole of a block.
        self._drilled_line = 0
        self.rotary_names = tuple(machine.axes[column].name.upper() for column in machine.own_rotary)

    def _fault_at(self, fault: Wording, line: int) -> None:
        """Note an error at a line of the program, or at the present one for 0."""
        here, self.line = self.line, line or self.line
        self.note(fault, Severity.ERROR)
        self.line = here

    def require_known_zero(self, word: str, key: str) -> None:
        """Let nothing move in an offset that a block writes over a workpiece zero that nobody has given."""
        if self.machine.workpiece_zero is None:
            self.preconditions.require(key, Wording("NC352", "offset_over_unknown_zero", word=word), self.line)

    def start_with(self, modes: Mapping[str, Hashable]) -> None:
        """Start with modes that the definition states, by their names in ``start_modes``."""
        self.start_modes = {name: word for name, word in self.start_modes.items() if name not in modes}
        self.usual_modes |= modes
        self.absolute = bool(modes.get("distances", self.absolute))
        plane = modes.get("plane", self.plane_axis)
        assert isinstance(plane, int)
        self._plane_axis = plane  # the program has not chosen it

    # Scans

    def scan_settings(self) -> ScanSettings:
        """Return what programmed numbers mean now."""
        return ScanSettings(
            self.length_unit, self.unit_of_feed, self.default_turn_rules, self.position_map, self.vector_map
        )

    @property
    def unit_of_feed(self) -> float:
        """Millimetres of the length in F; 1 with inverse time, which counts no length."""
        return 1.0 if self.modal.feed_mode.current == _INVERSE_TIME else self.feed_unit

    def execute_scanned(self, count: int, settings: ScanSettings) -> ScannedRows:
        """Execute the first ``count`` blocks of ``words``, which begin at ``line``."""
        self._note_compensation_plane()
        scanned = super().execute_scanned(count, settings)
        self.motion = int(self.words.kind[count - 1])
        for axis in range(3):
            if scanned.words >> axis & 1:
                self._increment_base.pop(axis, None)
        return scanned

    # Radius compensation

    def compensates_across_tool(self) -> bool:
        """Whether radius compensation works across the tool wherever that points, and not in the working plane."""
        return self.compensates_in_space

    def _note_compensation_plane(self) -> None:
        """Record the plane in which radius compensation offsets the next motions, if it is on."""
        if not self.modal.compensation.current:
            return
        if self.compensates_across_tool():
            self.set_compensation_plane(None)
            return
        linear = self.position_map[:, :3]
        u, v = (linear[:, (self.plane_axis + k) % 3] for k in (1, 2))
        if not self.tip_programmed:
            slides = self._slides_to_tip()[:, :3]
            u, v = slides @ u, slides @ v
        normal = np.cross(u, v)
        length = float(np.linalg.norm(normal))
        self.set_compensation_plane(normal / length if length > 1e-12 else None)

    # Rotary words

    @property
    def default_turn_rules(self) -> int:
        """The turn rules of plain rotary words, as two nibbles."""
        return self.turn_rule(0, PositionMode.MODAL) | self.turn_rule(1, PositionMode.MODAL) << 4

    def turn_rule(self, which: int, mode: PositionMode) -> int:
        """Return the turn rule of a word for the first (0) or second (1) rotary axis."""
        axis = self.machine.axes[self.machine.rotary[which]]
        if mode in (PositionMode.SHORTEST, PositionMode.POSITIVE, PositionMode.NEGATIVE):
            if not axis.endless:
                self.note(Wording("NC213", "turns_of_axis_with_ends", mode=mode, axis=axis.name), Severity.WARNING)
                return axis_positions.PLAIN
            return {
                PositionMode.SHORTEST: axis_positions.SHORTEST,
                PositionMode.POSITIVE: axis_positions.POSITIVE_DIRECTION,
                PositionMode.NEGATIVE: axis_positions.NEGATIVE_DIRECTION,
            }[mode]
        if not axis.endless:
            return axis_positions.PLAIN
        if self.shortest or (self.shortest is None and self.takes_shortest_path(axis)):
            return axis_positions.SHORTEST
        return axis_positions.PLAIN if axis.output is AngleOutput.NONE else axis_positions.SAME_TURN

    @abstractmethod
    def takes_shortest_path(self, axis: Axis) -> bool:
        """Whether plain words for an endless rotary axis take the shorter way now.

        Otherwise the axis stays within its turn, or takes the number as it is if its output has all turns.
        """

    def rotary_target(self, axes: Mapping[str, AxisWord]) -> RotaryTarget:
        """Return what the rotary words of a block amount to."""
        values = [math.nan, math.nan]
        rules = bits = 0
        for which, name in enumerate(self.rotary_names):
            if name not in axes:
                continue
            value, mode = axes[name]
            rule = self.turn_rule(which, mode)
            self._judge_turn(which, value, mode)
            if self._is_incremental(mode):
                self.resolve_rows()
                value += float(self.current_joints[self.machine.rotary[which]])
                rule = axis_positions.PLAIN
            values[which] = value
            rules |= rule << (4 * which)
            bits |= int(ProgrammedWord.FIRST) << which
        return RotaryTarget((values[0], values[1]), rules, bits)

    def _judge_turn(self, which: int, value: float, mode: PositionMode) -> None:
        """Note a position beyond one turn of an endless axis that a word takes by a way of its own: an alarm."""
        axis = self.machine.axes[self.machine.rotary[which]]
        if not axis.endless or mode not in (PositionMode.SHORTEST, PositionMode.POSITIVE, PositionMode.NEGATIVE):
            return
        start = -180.0 if axis.output is AngleOutput.SYMMETRIC else 0.0
        if not start <= value < start + 360.0:
            self.note(
                Wording("NC215", "beyond_turn", axis=axis.name, value=value, start=start, end=start + 360.0),
                Severity.ERROR,
            )

    def rotary_position(self, values: Sequence[float]) -> RotaryTarget:
        """Return the target of a positioning of both rotary axes that the control itself makes."""
        bits = int(ProgrammedWord.FIRST | ProgrammedWord.SECOND)
        return RotaryTarget((values[0], values[1]), self.default_turn_rules, bits)

    # Motion

    def move(
        self,
        axes: Mapping[str, AxisWord],
        vector: Floats | None,
        *,
        circle: Circle | None = None,
        machine_frame: bool = False,
        feed_written: bool = False,
    ) -> None:
        """Execute the motion of a block.

        axes     X, Y, Z and rotary axes by name, in the units of the program
        vector   (3,) programmed tool axis
        circle   of a block that is one
        """
        bits = int(ProgrammedWord.FEED) if feed_written else 0
        if machine_frame:
            self._machine_move(axes, bits, circle is not None)
            return
        if circle is not None or vector is not None or axes.keys() & {"X", "Y", "Z"}:
            self.preconditions.report_motion()
        self._note_compensation_plane()
        end, written = self._end_position(axes)
        arc = None
        if circle is not None and within_limits(end):
            try:
                arc = circle(self.programmed_position.copy(), end)
                end = end if arc is None else arc.end
                gap = 0.0 if arc is None else arcs.gap_of_turn(self.programmed_position, arc)
                if gap:
                    self.note(Wording("NC323", "end_beside_start", gap=gap), Severity.WARNING)
            except arcs.ArcError as error:
                self.note(error.wording.within("taken_as_line"), Severity.ERROR)
        rotary = self.rotary_target(axes)
        if vector is not None and rotary.bits:
            self.note(Wording("NC216", "rotary_words_vector_block_vector"), Severity.ERROR)
            rotary = NO_ROTARY
        self.add_element(self._line_kind, end, arc, rotary, bits | written, vector)

    def _end_position(self, axes: Mapping[str, AxisWord]) -> tuple[Floats, int]:
        """Return the programmed end of a block, (3,) mm, and the bits of the words X, Y and Z."""
        end = self.programmed_position.copy()
        bits = 0
        for axis, name in enumerate("XYZ"):
            if name in axes:
                value, mode = axes[name]
                value *= self.length_unit
                end[axis] = self._increment_base.get(axis, end[axis]) + value if self._is_incremental(mode) else value
                self._increment_base.pop(axis, None)
                bits |= 1 << axis
        return end, bits

    def _is_incremental(self, mode: PositionMode) -> bool:
        return mode is PositionMode.INCREMENTAL or (mode is PositionMode.MODAL and not self.absolute)

    @property
    def _line_kind(self) -> Kind:
        return Kind.RAPID if self.motion == RAPID else Kind.LINEAR

    def _machine_move(self, axes: Mapping[str, AxisWord], bits: int, circle: bool) -> None:
        """Move to positions of the machine axes, regardless of frames and TCP."""
        if self.tcp:
            self.note(Wording("NC341", "machine_positions_while_tcp_taken"), Severity.WARNING)
        if circle:
            self.note(Wording("NC320", "circle_machine_positions_taken_straight"), Severity.ERROR)
        self.resolve_rows()
        slides = self.current_joints[self._slides].copy()
        steps = 0
        for axis, name in enumerate("XYZ"):
            if name in axes:
                value, mode = axes[name]
                is_step = self._is_incremental(mode)
                slides[axis] = value * self.length_unit + (slides[axis] if is_step else 0.0)
                bits |= 1 << axis
                steps |= is_step << axis
        tcp, self.tcp = self.tcp, False
        rotary = self.rotary_target(axes)
        self.tcp = tcp
        self.modal.machine_frame.set(self.row, True)
        self.modal.machine_steps.set(self.row, steps)
        self.move_axes(self._line_kind, slides, rotary, bits)
        self.modal.machine_frame.set(self.row, False)
        self.modal.machine_steps.set(self.row, 0)

    def move_axes(self, kind: Kind, slides: Floats, rotary: RotaryTarget = NO_ROTARY, bits: int = 0) -> None:
        """Add a row of slide positions (X, Y, Z) and rotary values, whatever X Y Z mean now, and resolve it.

        bits   ``ProgrammedWord`` bits of the words besides rotary ones
        """
        self.end_contour()
        self.resolve_rows()
        tip_programmed, position_map = self.tip_programmed, self.position_map
        self.tip_programmed, self.position_map = False, affine_matrix(np.eye(3), np.zeros(3))
        self.add_row(kind, slides, rotary, bits)
        self.resolve_rows()
        self.tip_programmed, self.position_map = tip_programmed, position_map
        self._increment_base.clear()
        self.programmed_position = self._position_of_axes()

    def go_home(self) -> None:
        """Move the slides to the home position of the machine, as a subprogram of the builder does."""
        self.modal.machine_frame.set(self.row, True)
        bits = int(ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z)
        self.move_axes(Kind.RAPID, self.machine.home[self._slides].copy(), bits=bits)
        self.modal.machine_frame.set(self.row, False)

    def move_along_spline(self, spline: Spline, points: Floats, bits: int) -> None:
        """Execute a spline in programmed positions, mm, whose ``points`` (k, 3) behind its start stand for it.

        ``bits`` are the ``ProgrammedWord`` bits of its words.
        """
        self.end_contour()
        self.preconditions.report_motion()
        for axis in range(3):
            self._increment_base.pop(axis, None)
        slides = None if self.tip_programmed else self._slides_to_tip()
        first = self.row
        if not self.add_lines(points, bits):
            return
        poles = np.array([self._mapped(pole) for pole in spline.poles])
        if slides is not None:
            poles = poles @ slides[:, :3].T + slides[:, 3]
        self.add_spline(SplineRows(first, self.row - 1, spline._replace(poles=poles)))

    # Drilling

    def drill(self, motions: Sequence[HoleMotion], work: SpindleWork | None = None) -> None:
        """Execute the motions of a drilling cycle at the present position; ``work``: the cycle drives the spindle."""
        self.end_contour()
        self.preconditions.report_motion()
        if self.line != self._drilled_line:
            self.judge_within_compensation("a drilling cycle", self.drills_within_compensation)
            self._drilled_line = self.line
        hole = self.programmed_position.copy()
        feed, first_row = self.programmed_feed, self.row
        if work is None and not all(motion.rapid for motion in motions):
            self.add_event("hole")
        u, v = (self.plane_axis + 1) % 3, (self.plane_axis + 2) % 3
        for motion in motions:
            end = hole.copy()
            height = self.programmed_position[self.plane_axis]
            end[self.plane_axis] = height if motion.height is None else motion.height * self.length_unit
            end[u] += motion.lateral[0] * self.length_unit
            end[v] += motion.lateral[1] * self.length_unit
            if motion.feed is not None:
                self.programmed_feed = -motion.feed * feed if motion.feed < 0.0 else motion.feed
            if motion.turns:
                self._add_helix(hole, end, motion.turns)
            else:
                self.add_row(Kind.RAPID if motion.rapid else Kind.LINEAR, end)
            self.programmed_feed = feed
            if motion.dwell:
                self.add_event("dwell", motion.dwell)
        self._check_drilling_axis(self.row - first_row)
        if work is not None:
            self.add_spindle_hole(first_row, work)

    def _add_helix(self, hole: Floats, end: Floats, turns: int) -> None:
        """Add whole turns about a hole to a point above or below the present one; positive counter-clockwise."""
        start = self.programmed_position.copy()
        arc = arcs.by_centre(start, end, hole, self.plane_axis, turns < 0, abs(turns) - 1)
        placed, row = self._arc_in_workpiece(arc, axes_turn=False), self.row
        if self.add_row(Kind.LINEAR if placed is None else Kind.ARC, end) and placed is not None:
            self.add_arc(row, *placed, arc.turns)

    def _check_drilling_axis(self, rows: int) -> None:
        """Warn if the tool does not point along the drilling axis."""
        self.resolve_rows()
        along = self.position_map[:, self.plane_axis]
        along = along / np.linalg.norm(along)
        if not self.tip_programmed:
            return
        axis = forward(self.machine, self.current_joints[None])[1][0]
        if rows and float(np.linalg.norm(axis - along)) > MAX_DRILLING_AXIS_ERROR:
            self.note(Wording("NC382", "cycle_drills_along_axis_frame"), Severity.WARNING)
