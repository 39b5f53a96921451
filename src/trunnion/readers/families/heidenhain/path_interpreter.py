"""Path blocks of Klartext: motions, corners, approaches and departures, and the cycles that they call."""

import math
import re
from pathlib import Path
from typing import Final

from trunnion.errors import Severity
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.readers.control.axis_word import AxisWord, PositionMode
from trunnion.readers.control.contour_control import CornerWord
from trunnion.readers.control.hole_motion import CycleExecutionError
from trunnion.readers.control.virtual_control import LINEAR, RAPID
from trunnion.readers.families.heidenhain.cycle_definitions import Definitions
from trunnion.readers.families.heidenhain.cycle_values import Cycle
from trunnion.readers.families.heidenhain.cylinder_contours import ContourBlockError
from trunnion.readers.families.heidenhain.cylinder_cycles import mill_cylinder
from trunnion.readers.families.heidenhain.flow import ActiveProgram, FlowInterpreter
from trunnion.readers.families.heidenhain.leads import LeadWords
from trunnion.readers.families.heidenhain.lexer import words
from trunnion.readers.families.heidenhain.machine_functions import MFunctions
from trunnion.readers.families.heidenhain.parameters import KlartextError
from trunnion.readers.families.heidenhain.path_blocks import (
    Block,
    check_path_words,
    circle_of,
    only,
    polar_end,
    read_block,
)
from trunnion.readers.families.heidenhain.patterns import Pattern
from trunnion.readers.families.heidenhain.words import M_CALL, M_MACHINE, M_SECOND_MACHINE, ON_CYLINDER
from trunnion.readers.program.options import DEFAULT_OPTIONS, RunOptions

#: Cutter radius compensation: left of the path, right of it, off.
_RADIUS_COMPENSATION: Final = {"R0": 0, "RL": 1, "RR": -1}

#: Approaches and departures: in polar coordinates with a P.
_LEAD: Final = re.compile(r"[ \t]*(P?)(LT|LN|CT|LCT)(?![A-Z])")

#: The sizes that each kind needs.
_LEAD_WORDS: Final = {"LT": ("LEN",), "LN": ("LEN",), "CT": ("R", "CCA"), "LCT": ("R",)}

#: Arcs of approaches turn this far at most, degrees.
_MOST_TURN: Final = 360.0


class PathInterpreter(FlowInterpreter):
    """Executes path blocks."""

    def __init__(self, path: Path, machine: Machine, options: RunOptions = DEFAULT_OPTIONS) -> None:
        super().__init__(path, machine, options)
        self._definitions = Definitions(self.control, self._note)
        self._m_functions = MFunctions(self.control, self._note)
        # The feed of the tool call, for F AUTO.
        self._tool_feed: float | None = None
        # The side that the last R0 has left, and the row from which on a motion in the working plane ends it.
        self._side_left: tuple[int, int] = 0, 0

    # Motion

    def _paraxial_block(self, active: ActiveProgram, statement: str) -> None:
        """Execute a block of M words, or of a single axis: it needs no path function."""
        block = read_block(words(statement), active.parameters)
        if len(block.axes) > 1 or block.vectors:
            raise KlartextError(Wording("NC210", "words_without_l", names=tuple(block.axes | block.vectors)))
        self._path_words(active, "L", block)

    def _path_block(self, active: ActiveProgram, function: str, rest: str) -> None:
        self._path_words(active, function, read_block(words(rest), active.parameters))

    def _path_words(self, active: ActiveProgram, function: str, block: Block) -> None:
        control = self.control
        self._remove_missing_axes(block)
        axes = block.axes
        if function in ("LP", "CP", "CTP"):
            axes = polar_end(control, block, circle=function == "CP")
        elif block.polar:
            raise KlartextError(Wording("NC210", "no_polar_coordinates", function=function))
        if block.radius is not None and function != "CR":
            raise KlartextError(Wording("NC210", "no_radius", function=function))
        check_path_words(function, block)
        circle = circle_of(control, function, block) if function[0] == "C" else None
        vector = block.tool_axis
        feed = self._feed(block)
        self._m_functions.execute_before_motion(block)
        if feed is not None:
            control.programmed_feed = feed
        control.motion = RAPID if block.rapid else LINEAR
        self._set_compensation(block)
        in_machine = self._moves_in_machine(block)
        if vector is not None and (control.at_ends or not control.tip_programmed):
            self._note(Wording("NC340", "tx_ty_tz_need_m128"), Severity.ERROR)
        moves, row = bool(axes) or vector is not None or circle is not None, control.row
        if moves:
            feed_written = block.feed is not None and not block.rapid
            control.move(axes, vector, circle=circle, machine_frame=in_machine, feed_written=feed_written)
            if block.normal is not None and control.row > row:
                control.add_normal(block.normal)
        called = any(code == M_CALL for code, _ in block.m)
        if called or (self._m_functions.modal_call and moves and not in_machine):
            self._drill(active)
        if called:
            self._m_functions.modal_call = False
        self._m_functions.execute_after_motion(block)

    def _set_compensation(self, block: Block) -> None:
        modal = self.control.modal
        if not block.side:
            return
        side, before = _RADIUS_COMPENSATION[block.side], int(modal.compensation.current)
        if before and not side:
            self._side_left = before, self.control.row
        left, row = self._side_left
        if side and -side in (before, left) and (before or not self.control.moved_in_plane_since(row)):
            self._note(Wording("NC343", "side_without_r0", word=block.side), Severity.ERROR)
        modal.compensation.set(self.control.row, side)
        if block.side in ("RL", "RR"):
            self._note(Wording("NC221", "radius_compensation", word=block.side), Severity.WARNING)
            self.control.judge_compensation()

    def _moves_in_machine(self, block: Block) -> bool:
        """Whether a block programs positions of the machine axes (M91, M92)."""
        codes = {code for code, _ in block.m}
        if M_SECOND_MACHINE in codes:
            self._note(Wording("NC224", "m92_counts_set_machine_taken"), Severity.WARNING)
        return bool(codes & {M_MACHINE, M_SECOND_MACHINE})

    def _remove_missing_axes(self, block: Block) -> None:
        """Report the words of axes that the machine does not have, and remove them."""
        known = {"X", "Y", "Z", *self.control.rotary_names}
        if self.control.spatial_angles_active:
            known |= {"A", "B", "C"}
        for name in sorted(block.axes.keys() - known):
            self._note(Wording("NC230", "axis_word_not_executed", axis=name), Severity.ERROR)
            del block.axes[name]

    def _feed(self, block: Block) -> float | None:
        """Return the feed of a block in mm/min, None if it has none."""
        if block.feed is not None:
            return block.feed * self.control.feed_unit
        if block.feed_of_tool and self._tool_feed is None:
            raise KlartextError(Wording("NC210", "f_auto_tool_call_no"))
        return self._tool_feed if block.feed_of_tool else None

    def _pole(self, active: ActiveProgram, rest: str) -> None:
        """CC: set the pole; an error in the block leaves none."""
        control = self.control
        control.pole = None
        block = read_block(words(rest), active.parameters)
        only(block.written, "XYZ", "CC")
        pole = control.programmed_position.copy()
        for name, (value, mode) in block.axes.items():
            axis = "XYZ".index(name)
            if axis == control.plane_axis:
                raise KlartextError(Wording("NC220", "pole_outside_plane", axis=name))
            pole[axis] = value * control.length_unit + (pole[axis] if mode is PositionMode.INCREMENTAL else 0.0)
        control.pole = pole

    # Corners

    def _rounding(self, active: ActiveProgram, rest: str) -> None:
        block = read_block(words(rest), active.parameters)
        if block.radius is None or block.radius < 0.0:
            raise KlartextError(Wording("NC210", "corner_needs_size", word="RND R"))
        self._corner(block, CornerWord("RND", block.radius * self.control.length_unit))

    def _chamfer(self, active: ActiveProgram, rest: str) -> None:
        block = read_block(words(f"CHF{rest}"), active.parameters, ("CHF",))
        side = block.sizes.pop("CHF", 0.0)
        if not side > 0.0:
            raise KlartextError(Wording("NC210", "corner_needs_size", word="CHF"))
        self._corner(block, CornerWord("CHF", side * self.control.length_unit, chamfer=True, of_lines=True))

    def _corner(self, block: Block, corner: CornerWord) -> None:
        """Round or chamfer the corner: besides its size the block takes a feed alone, which counts for the corner."""
        if block.axes or block.polar or block.vectors or block.m or block.side or block.direction or block.rapid:
            raise KlartextError(Wording("NC210", "corner_takes_feed_only", word=corner.word))
        if corner.chamfer and block.radius is not None:
            raise KlartextError(Wording("NC210", "corner_takes_feed_only", word=corner.word))
        self.control.cut_corner(corner._replace(feed=self._feed(block)))

    # Approach and departure

    def _approach(self, active: ActiveProgram, rest: str) -> None:
        control = self.control
        feed_before = math.nan if control.motion == RAPID else control.programmed_feed
        axes, block, lead = self._lead_block(active, "APPR", rest)
        if not axes.keys() & {"X", "Y", "Z"} - {"XYZ"[control.plane_axis]}:
            raise KlartextError(Wording("NC210", "lead_needs_point", word=lead.word))
        self._begin_lead(block)
        self._set_compensation(block)
        control.approach(axes, lead, feed_before)
        self._m_functions.execute_after_motion(block)

    def _departure(self, active: ActiveProgram, rest: str) -> None:
        control = self.control
        axes, block, lead = self._lead_block(active, "DEP", rest)
        if block.side in ("RL", "RR"):
            raise KlartextError(Wording("NC210", "block_takes_no", block=lead.word, word=block.side))
        to_a_point = bool(axes.keys() & {"X", "Y", "Z"} - {"XYZ"[control.plane_axis]})
        if to_a_point != (lead.kind == "LCT"):
            raise KlartextError(
                Wording("NC210", "lead_needs_point" if not to_a_point else "lead_takes_no_point", word=lead.word)
            )
        self._begin_lead(block)
        control.depart(axes, lead)
        self._m_functions.execute_after_motion(block)

    def _begin_lead(self, block: Block) -> None:
        """Take over the feed and the M functions of an approach or departure."""
        feed = self._feed(block)
        self._m_functions.execute_before_motion(block)
        if feed is not None:
            self.control.programmed_feed = feed
        self.control.motion = RAPID if block.rapid else LINEAR

    def _lead_block(self, active: ActiveProgram, word: str, rest: str) -> tuple[dict[str, AxisWord], Block, LeadWords]:
        """Return the axes of an APPR or DEP block, its words and its sizes."""
        match = _LEAD.match(rest)
        if match is None:
            raise KlartextError(Wording("NC210", "lead_needs_kind", word=word))
        word, kind = f"{word} {match[1]}{match[2]}", match[2]
        block = read_block(words(rest[match.end() :]), active.parameters, ("LEN", "CCA"))
        self._remove_missing_axes(block)
        if block.axes.keys() - {"X", "Y", "Z"} or block.vectors or block.direction:
            raise KlartextError(Wording("NC220", "lead_with_rotary_axes", word=word))
        if self._moves_in_machine(block) or any(code == M_CALL for code, _ in block.m):
            raise KlartextError(Wording("NC210", "lead_in_machine", word=word))
        sizes = dict(block.sizes)
        if block.radius is not None:
            sizes["R"] = block.radius
        positive = all(value > 0.0 or (name == "R" and kind == "CT") for name, value in sizes.items())
        if sizes.keys() != set(_LEAD_WORDS[kind]) or not positive or sizes.get("CCA", 0.0) > _MOST_TURN:
            raise KlartextError(Wording("NC210", "lead_sizes", word=word, sizes=_LEAD_WORDS[kind]))
        if block.polar and not match[1]:
            raise KlartextError(Wording("NC210", "no_polar_coordinates", function=word))
        axes = polar_end(self.control, block, circle=False) if match[1] else block.axes
        unit = self.control.length_unit
        length, radius = sizes.get("LEN", 0.0) * unit, sizes.get("R", 0.0) * unit
        return axes, block, LeadWords(word, kind, length, radius, sizes.get("CCA", 0.0), block.rapid)

    def _mill_cylinder(self, active: ActiveProgram, cycle: Cycle) -> bool:
        """Execute cycle 27 or 28 with the contour of cycle 14."""
        control, here = self.control, self.control.line
        labels = self._definitions.contour_labels
        try:
            if len(labels) != 1:
                raise CycleExecutionError(Wording("NC380", "no_contour" if not labels else "several_contours"))
            cycle.take_values(active.parameters)
            contour = active.source, labels[0], active.parameters
            self._counter.count_motions(mill_cylinder(control, cycle.number, cycle.q_values, contour))
        except ContourBlockError as error:
            control.line = error.line
            self._note(error.wording, Severity.ERROR)
            control.line = here
            return False
        except CycleExecutionError as error:
            self._note(error.wording.within("cycle_not_executed"), Severity.ERROR)
            return False
        return True

    def _drill(self, active: ActiveProgram, stay: float | None = None) -> bool:
        """Execute the defined cycle at the present position; without its last motion if that leaves a height."""
        cycle = self._definitions.defined_cycle
        if cycle is not None and cycle.number in ON_CYLINDER:
            return self._mill_cylinder(active, cycle)
        try:
            motions = self._definitions.call(active.parameters)
        except CycleExecutionError as error:
            self._note(error.wording.within("cycle_not_executed"), Severity.ERROR)
            return False
        if stay is not None and motions[-1].rapid and motions[-1].height not in (None, stay):
            motions = motions[:-1]
        self._counter.count_motions(len(motions))
        self.control.drill(motions, self._definitions.spindle_work())
        return True

    def _drill_pattern(self, active: ActiveProgram, pattern: Pattern) -> None:
        """Execute the defined cycle at all positions of a pattern.

        The tool goes to the first one where it is above the second clearance, else at that; and from one to the next at
        the clearance that the pattern states.
        """
        control = self.control
        along = control.plane_axis
        first, second = "XYZ"[(along + 1) % 3], "XYZ"[(along + 2) % 3]
        control.motion = RAPID
        if float(control.programmed_position[along]) < pattern.second_clearance * control.length_unit:
            control.move({"XYZ"[along]: (pattern.second_clearance, PositionMode.ABSOLUTE)}, None)
        last = len(pattern.positions) - 1
        for k, (u, v) in enumerate(pattern.positions):
            self._counter.count_motions(1)
            control.motion = RAPID
            control.move({first: (u, PositionMode.ABSOLUTE), second: (v, PositionMode.ABSOLUTE)}, None)
            if not self._drill(active, None if pattern.at_second or k == last else pattern.clearance):
                return
