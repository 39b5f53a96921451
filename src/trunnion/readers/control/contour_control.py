"""The part of a virtual control that knows its path as a contour: elements, and what needs the one that comes next.

A corner is rounded or chamfered between two elements, and an approach joins the first one tangentially: both wait for
the next element. The rows before it are then cut short or added.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import Severity
from trunnion.machines import Machine, forward
from trunnion.messages import Wording
from trunnion.model.run import ProgrammedWord
from trunnion.model.toolpath import Kind
from trunnion.readers.control import arcs, contours
from trunnion.readers.control.affine_map import AffineMap, affine_matrix
from trunnion.readers.control.axis_word import NO_ROTARY, RotaryTarget
from trunnion.readers.control.contours import ContourError, Corner, Element
from trunnion.readers.control.event_recorder import Note
from trunnion.readers.control.row_recorder import ScannedRows, within_limits
from trunnion.readers.control.setup_control import SetupControl
from trunnion.readers.scan.buffers import MOTION_BITS, ScannedCircles, ScanSettings
from trunnion.readers.scan.circles import find_circles

#: What the feed of a corner without one of its own is that of.
FEED_BEFORE: Final = "block_before"
FEED_BEHIND: Final = "block_behind"

#: G2 in a scan.
CLOCKWISE: Final = 2

_ROTARY: Final = int(ProgrammedWord.FIRST | ProgrammedWord.SECOND | ProgrammedWord.VECTOR)


class Place(NamedTuple):
    """Where a block stands, and before which row in which coordinates it acts."""

    line: int
    block_number: int
    row: int
    position_map: Floats


class Awaited(NamedTuple):
    """What is done as soon as the next element is known; ``missing`` is done where none comes."""

    place: Place
    act: Callable[[Element], None]
    missing: Callable[[], None]


class CornerWord(NamedTuple):
    """A corner word (RND, CHF and the like).

    word        as it is written, for messages
    size        radius of a rounding; of a chamfer its length, or what it cuts off both elements; mm
    chamfer     it makes a line
    by_length   ``size`` is the length of that line
    feed        its own; None: none
    feed_of     ``FEED_BEFORE`` or ``FEED_BEHIND``: whose feed it has otherwise; empty: nobody has said
    left_out    the control makes none where an element leaves the working plane, or none follows; else it stops there
    least_turn  radians: a contour that turns by less has no corner
    modal       it is in force until it is switched off, so that nobody has asked for a corner here
    of_lines    it stands between two lines alone, tangent or not
    """

    word: str
    size: float
    chamfer: bool = False
    by_length: bool = False
    feed: float | None = None
    feed_of: str = FEED_BEFORE
    least_turn: float = 0.0
    left_out: bool = False
    modal: bool = False
    of_lines: bool = False


class ContourControl(SetupControl):
    """Knows the last element of the path, and adds elements."""

    def __init__(self, machine: Machine, note: Note) -> None:
        # Rotary positions, and the map (3, 4) from slide positions to the tip at these positions.
        self._slide_map: tuple[float, float, Floats] | None = None
        # The last element, with its place behind its row; and that before a scan, with the row and position there.
        self._last: tuple[Place, Element] | None = None
        self._scan: tuple[Place, int, Floats] | None = None
        self._found = ScannedCircles.empty()
        # How many of them the next blocks have, and their map, which holds until rotary axes turn.
        self._found_count, self._found_map = 0, arcs.ArcMap.of(np.eye(3), np.zeros(3))
        # The last circle of that scan, with its row and start.
        self._scanned_arc: tuple[int, Floats, arcs.Arc] | None = None
        self._awaited: Awaited | None = None
        # The first row that programs an axis, by axis.
        self._first_rows: dict[int, int] = {}
        super().__init__(machine, note)

    def forget_machine(self) -> None:
        """Forget the map of the slides with the tool and the zero before."""
        self._slide_map = None

    # Elements

    @property
    def _place(self) -> Place:
        return Place(self.line, self.block_number, self.row, self.position_map)

    def _is_here(self, place: Place) -> bool:
        """Whether nothing has moved since, and coordinates mean the same."""
        return place.row == self.row and place.position_map is self.position_map

    def _knows_start(self) -> bool:
        """Whether the program has said where the last row begins in the working plane."""
        for axis in (axis for axis in range(3) if axis != self.plane_axis):
            if axis not in self._first_rows:
                found = np.flatnonzero(self.columns.programmed[: self.row] & (1 << axis))
                if not len(found):
                    return False
                self._first_rows[axis] = int(found[0])
            if self._first_rows[axis] >= self.row - 1:
                return False
        return True

    def moved_in_plane_since(self, row: int) -> bool:
        """Whether a row from that one on has moved in the working plane."""
        ways = np.diff(self.columns.xyz[max(row - 1, 0) : self.row], axis=0)
        along = self.position_map[:, self.plane_axis] / np.linalg.norm(self.position_map[:, self.plane_axis])
        return bool(np.any(np.abs(ways - np.outer(ways @ along, along)) > arcs.SAME_POINT))

    def last_element(self) -> Element | None:
        """Return the element that the last row is; None if it was another motion, or its coordinates are others.

        None as well if nobody knows where it begins.
        """
        if not self._knows_start():
            return None
        if self._last is not None and self._is_here(self._last[0]):
            return self._last[1]
        if self._scan is None or not self._is_here(self._scan[0]):
            return None
        _, first, start = self._scan
        last = self.row - 1
        if self._scanned_arc is not None and self._scanned_arc[0] == last:
            return Element(self._scanned_arc[1], self._scanned_arc[2].end, self._scanned_arc[2])
        if last > first:
            start = AffineMap(self.position_map[:, :3], self.position_map[:, 3]).solve(self.columns.xyz[last - 1])
        rapid = self.columns.kind[last] == Kind.RAPID
        turns = bool(self.columns.programmed[last] & _ROTARY)
        return Element(start, self.programmed_position.copy(), rapid=bool(rapid), turns=turns)

    def find_circles(self, count: int) -> int:
        """Work out the circles of the first ``count`` blocks of ``words``.

        Returns how many blocks are before the first circle that the interpreter must judge.
        """
        kinds = self.words.kind[:count]
        self._found_count = 0
        if not count or kinds.max() <= Kind.LINEAR:
            return count
        self._found_map, keeps_circles = self._map_of_circles()
        if not keeps_circles:
            circles = (kinds > Kind.LINEAR) & (self.words.seen[:count] & MOTION_BITS != 0)
            return int(circles.argmax()) if circles.any() else count
        plain, self._found_count = find_circles(
            count,
            self.words,
            self.length_unit,
            self.plane_axis,
            self.tip_programmed,
            self.programmed_position,
            self._found,
        )
        return plain

    def execute_scanned(self, count: int, settings: ScanSettings) -> ScannedRows:
        """Execute the first ``count`` blocks of ``words``, which begin at ``line``."""
        first, start = self.row, self.programmed_position.copy()
        scanned = super().execute_scanned(count, settings)
        self._scanned_arc = None
        if self._found_count:
            self._add_circles(first)
        if self.row > first:
            self._scan = self._place, first, start
        return scanned

    def _add_circles(self, first: int) -> None:
        """Record the circles of a scan whose rows begin at one."""
        found, n = self._found, self._found_count
        starts, centres, radii = found.start[:n], found.centre[:n], found.radius[:n]
        arc_map, plane = self._found_map, self.plane_axis
        signs = np.where(self.words.kind[found.block[:n]] == CLOCKWISE, -1.0, 1.0)
        normals = signs[:, None] * arc_map.normals[:, plane]
        rows = first + found.row[:n]
        self._circles.add_scanned(rows, centres @ arc_map.linear.T + arc_map.shift, normals, radii * arc_map.scale)
        if rows[-1] == self.row - 1:
            end, normal = self.programmed_position.copy(), arcs.normal_of(plane, bool(signs[-1] < 0.0))
            last = arcs.Arc(end, centres[-1].copy(), normal, float(radii[-1]))
            self._scanned_arc = int(rows[-1]), starts[-1].copy(), last

    def add_element(
        self,
        kind: Kind,
        end: Floats,
        arc: arcs.Arc | None = None,
        rotary: RotaryTarget = NO_ROTARY,
        bits: int = 0,
        vector: Floats | None = None,
    ) -> None:
        """Add a line or circle to a programmed position, and first what has waited for it; see ``add_row``."""
        turns = vector is not None or rotary.bits != 0
        element = Element(self.programmed_position.copy(), end, arc, kind == Kind.RAPID, turns)
        if self._awaited is not None and within_limits(end):
            self._settle(element)
            element = replace(element, start=self.programmed_position.copy())
        placed = None if arc is None else self._arc_in_workpiece(arc, turns and not self.tip_programmed)
        row = self.row
        if self.add_row(kind if placed is None else Kind.ARC, end, rotary, bits, vector):
            if arc is not None and placed is not None:
                self.add_arc(row, *placed, arc.turns)
            self._last = self._place, element

    def end_direction(self) -> Floats | None:
        """Return the direction in which the last motion ended, (3,) as programmed; None if there is none."""
        element = None if self._awaited is not None else self.last_element()
        return element.direction(element.end) if element is not None and element.has_length else None

    # What waits for the next element

    @property
    def awaits_element(self) -> bool:
        """Whether a block waits for the next element."""
        return self._awaited is not None

    def await_element(self, act: Callable[[Element], None], missing: Callable[[], None]) -> None:
        """Let something be done before the next element, which is handed to it; ``missing`` where none comes."""
        self.end_contour()
        self._awaited = Awaited(self._place, act, missing)

    def end_contour(self) -> None:
        """Do what is due where no element comes that a block waits for."""
        self._settle(None)

    def forget_contour(self) -> None:
        """Let nothing wait for the next element."""
        self._awaited = None

    def _settle(self, element: Element | None) -> None:
        """Do what waits for an element, at the place of its block."""
        awaited, self._awaited = self._awaited, None
        if awaited is None:
            return
        here, feed = (self.line, self.block_number), self.programmed_feed
        self.line, self.block_number = awaited.place.line, awaited.place.block_number
        try:
            if element is not None and self._is_here(awaited.place):
                awaited.act(element)
            else:
                awaited.missing()
        except ContourError as error:
            self.note(error.wording, Severity.ERROR)
        self.programmed_feed = feed
        self.line, self.block_number = here

    # Corners

    def cut_corner(self, corner: CornerWord) -> None:
        """Round or chamfer the corner between the last element and the next one."""
        before = None if self._awaited is not None else self.last_element()
        if before is None:
            self._leave_out(corner, "no_element_before")
            return
        make = partial(self._make_corner, corner, before, self.programmed_feed, self.plane_axis)
        self.await_element(make, partial(self._leave_out, corner, "no_element_behind"))

    def _leave_out(self, word: CornerWord, variant: str) -> None:
        """Say why there is no corner to round or chamfer, if that is not usual."""
        if not word.modal:
            severity = Severity.WARNING if word.left_out else Severity.ERROR
            self.note(Wording("NC324", variant, word=word.word), severity)

    def _make_corner(self, word: CornerWord, before: Element, feed_before: float, plane: int, behind: Element) -> None:
        if plane != self.plane_axis or (word.left_out and any(self._only_across(each) for each in (before, behind))):
            self._leave_out(word, "corner_out_of_plane")
            return
        try:
            corner = self._corner(word, before, behind)
        except ContourError as error:
            raise ContourError(error.wording.within("corner_not_made", word=word.word)) from None
        if corner is None:
            return
        self.programmed_feed = self._feed_of_corner(word, feed_before)
        self.columns.xyz[self.row - 1] = self._mapped(corner.first)
        self.programmed_position = corner.first
        self._add(corner.last, corner.arc)

    def _corner(self, word: CornerWord, before: Element, behind: Element) -> Corner | None:
        """Return what takes the place of a corner; None: the contour goes on in its direction."""
        plane = self.plane_axis
        for element in (before, behind):
            if not element.lies_in(plane):
                raise ContourError(Wording("NC324", "out_of_plane"))
            if element.rapid or element.turns:
                raise ContourError(Wording("NC324", "at_rapid" if element.rapid else "axes_turn"))
        compensation = self.modal.compensation
        if compensation.current != compensation.part(self.row - 1, self.row)[0]:
            raise ContourError(Wording("NC324", "compensation_changes"))
        if word.of_lines:
            contours.check_chamfered(before, behind)
        angle = contours.corner_turn(before, behind, plane)
        if not angle or abs(angle) < word.least_turn:
            return None
        if not word.chamfer:
            return contours.rounding(before, behind, word.size, plane)
        if abs(angle) > math.pi - contours.SAME_DIRECTION:
            raise ContourError(Wording("NC324", "goes_back"))
        side = word.size / (2.0 * math.cos(0.5 * angle)) if word.by_length else word.size
        return contours.chamfer(before, behind, side)

    def _only_across(self, element: Element) -> bool:
        """Whether a line moves across the working plane alone."""
        way = element.end - element.start
        way[self.plane_axis] = 0.0
        return element.arc is None and float(np.abs(way).max()) < contours.IN_PLANE

    def _feed_of_corner(self, word: CornerWord, feed_before: float) -> float:
        if word.feed is not None:
            return word.feed
        behind = self.programmed_feed
        if not word.feed_of and feed_before != behind:
            variant = "corner_feed" if word.left_out else "corner_feed_in_no_manual"
            said = Wording("NC224", variant, word=word.word, before=feed_before, behind=behind)
            self.note(said, Severity.ERROR)
        return behind if word.feed_of == FEED_BEHIND else feed_before

    def _add(self, end: Floats, arc: arcs.Arc | None = None, kind: Kind = Kind.LINEAR) -> None:
        """Add an element that the control makes by itself; its words are those of the axes that move."""
        moves = np.abs(end - self.programmed_position) > arcs.SAME_POINT
        self.add_element(kind, end, arc, bits=int(moves @ np.array([1, 2, 4])))

    def add_lead(self, end: Floats, arc: arcs.Arc | None = None, *, feed: float, rapid: bool = False) -> None:
        """Add an element of an approach or departure, unless it has no length."""
        if float(np.linalg.norm(end - self.programmed_position)) > arcs.SAME_POINT:
            self.programmed_feed = feed
            self._add(end, arc, Kind.RAPID if rapid else Kind.LINEAR)

    # Circles in the workpiece

    def _arc_in_workpiece(self, arc: arcs.Arc, axes_turn: bool) -> tuple[Floats, Floats, float] | None:
        """Return centre, normal and radius in the workpiece frame; None, with a diagnostic, if it is no circle."""
        if axes_turn:
            self.note(Wording("NC321", "circle_of_axes_turns"), Severity.WARNING)
        arc_map, keeps_circles = self._map_of_circles()
        mapped = arc_map.map_arc(arc) if keeps_circles else arc_map.map_in_plane(arc)
        if mapped is None:
            self.note(Wording("NC320", "circle_under_unequal_scales_ellipse"), Severity.ERROR)
        return mapped

    def _map_of_circles(self) -> tuple[arcs.ArcMap, bool]:
        """Return the map of circles into the workpiece frame, and whether all of them stay circles."""
        slide_map = None if self.tip_programmed else self._slides_to_tip()
        if self._arc_map is None:
            linear, shift = self.position_map[:, :3], self.position_map[:, 3]
            if slide_map is not None:
                linear, shift = slide_map[:, :3] @ linear, slide_map[:, :3] @ shift + slide_map[:, 3]
            self._arc_map = arcs.ArcMap.of(linear, shift), self.frame.keeps_circles
        return self._arc_map

    def _slides_to_tip(self) -> Floats:
        """Return the map (3, 4) from slide positions to the tip, with the rotary axes where they are."""
        if self._rotary_unresolved:
            self.resolve_rows()
        first, second = (float(self.current_joints[column]) for column in self._rotary_columns)
        if self._slide_map is None or self._slide_map[:2] != (first, second):
            joints = np.zeros((4, 5))
            joints[:, list(self._rotary_columns)] = first, second
            for axis, column in enumerate(self._slides):
                joints[axis + 1, column] = 1.0
            tip = forward(self.machine, joints)[0]
            self._slide_map = first, second, affine_matrix((tip[1:] - tip[0]).T, tip[0])
            self._arc_map = None
        return self._slide_map[2]
