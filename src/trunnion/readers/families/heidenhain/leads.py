"""Approaches to a contour and departures from it: APPR and DEP."""

import math
from collections.abc import Mapping
from functools import partial
from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import Severity
from trunnion.messages import Wording
from trunnion.readers.control import arcs, contours
from trunnion.readers.control.axis_word import AxisWord
from trunnion.readers.control.contours import ContourError, Element, Lead
from trunnion.readers.control.row_recorder import within_limits
from trunnion.readers.families.heidenhain.plane_control import PlaneControl
from trunnion.readers.families.heidenhain.settings import approaches_without_side

#: Leads that are on the side of radius compensation.
_ON_A_SIDE: Final = frozenset({"LN", "CT"})


class LeadWords(NamedTuple):
    """The words of an APPR or DEP block.

    word    as it is written, for messages
    kind    LT, LN, CT or LCT
    length  LEN; radius: R; mm
    angle   CCA, degrees
    rapid   FMAX
    """

    word: str
    kind: str
    length: float
    radius: float
    angle: float
    rapid: bool


class LeadControl(PlaneControl):
    """Executes approaches and departures."""

    def approach(self, axes: Mapping[str, AxisWord], lead: LeadWords, feed_before: float) -> None:
        """APPR: move to the first contour point once the first element is known.

        feed_before  of the last motion; NaN: it went at rapid
        """
        self.end_contour()
        self.preconditions.report_motion()
        self._note_compensation_plane()
        start = self.programmed_position.copy()
        point, _ = self._end_position(axes)
        if not within_limits(point):
            self.note(Wording("NC310", "too_far"), Severity.ERROR)
            return
        self.programmed_position = point
        act = partial(self._make_approach, lead, start, feed_before, self.programmed_feed)
        self.await_element(act, partial(self._miss_element, lead, start))

    def _miss_element(self, lead: LeadWords, start: Floats) -> None:
        self.programmed_position = start
        self.note(Wording("NC324", "no_element_behind", word=lead.word), Severity.ERROR)

    def _make_approach(self, lead: LeadWords, start: Floats, feed_before: float, feed: float, element: Element) -> None:
        """Add the approach to the start of an element; a feed before of NaN is rapid."""
        point, plane = element.start, self.plane_axis
        self.programmed_position = start
        try:
            self._check_element(element)
            forward = element.direction(point)
            made = self._lead(lead, point, -forward, start)
        except ContourError as error:
            self.add_lead(point, feed=feed, rapid=lead.rapid)
            raise ContourError(error.wording.within("lead_not_made", word=lead.word)) from None
        beside = made.point.copy()
        if lead.kind == "LCT":
            self.add_lead(beside, feed=feed, rapid=lead.rapid)
        else:
            beside[plane] = start[plane]
            rapid = math.isnan(feed_before)
            for end in (beside, made.point):
                self.add_lead(end, feed=feed if rapid else feed_before, rapid=rapid)
        arc = None if made.arc is None else arcs.Arc(point, made.arc.centre, -made.arc.normal, made.arc.radius)
        self.add_lead(point, arc, feed=feed, rapid=lead.rapid)

    def depart(self, axes: Mapping[str, AxisWord], lead: LeadWords) -> None:
        """DEP: leave the contour, and end radius compensation."""
        element = None if self.awaits_element else self.last_element()
        target, _ = self._end_position(axes)
        if not within_limits(target):
            self.note(Wording("NC310", "too_far"), Severity.ERROR)
            return
        try:
            if element is None:
                raise ContourError(Wording("NC324", "no_element_before", word=lead.word))
            self._check_element(element)
            made = self._lead(lead, element.end, element.direction(element.end), target)
        except ContourError as error:
            self.note(error.wording.within("lead_not_made", word=lead.word), Severity.ERROR)
            made = None
        self.modal.compensation.set(self.row, 0)
        feed = self.programmed_feed
        if made is not None:
            self.add_lead(made.point, made.arc, feed=feed, rapid=lead.rapid)
            if lead.kind != "LCT":
                target = np.where(np.arange(3) == self.plane_axis, target, made.point)
        self.add_lead(target, feed=feed, rapid=lead.rapid)

    def _check_element(self, element: Element) -> None:
        if not element.lies_in(self.plane_axis):
            raise ContourError(Wording("NC324", "out_of_plane"))
        if element.turns:
            raise ContourError(Wording("NC324", "axes_turn"))

    def _lead(self, lead: LeadWords, point: Floats, away: Floats, target: Floats) -> Lead:
        """Return the way off a contour point; an approach goes it the other way round.

        away     (3,) the direction of the contour there, away from the elements that are cut
        target   (3,) where the departure ends, or where the approach begins
        """
        departs, compensation = lead.word.startswith("DEP"), int(self.modal.compensation.current)
        side = compensation or (0 if departs or not approaches_without_side(self.machine) else -1)
        if lead.kind in _ON_A_SIDE and not side:
            raise ContourError(Wording("NC324", "no_side"))
        if lead.rapid and lead.kind in ("CT", "LCT"):
            raise ContourError(Wording("NC324", "at_rapid"))
        # Left of the contour is right of the way back along it.
        turn = arcs.normal_of(self.plane_axis, clockwise=(side < 0) == departs)
        match lead.kind:
            case "LT":
                return contours.lead_line(point, away, lead.length)
            case "LN":
                return contours.lead_line(point, np.cross(turn, away), lead.length)
            case "CT":
                turn = turn * math.copysign(1.0, lead.radius)
                return contours.lead_arc(point, away, abs(lead.radius), lead.angle, turn)
        made = contours.lead_to(point, away, lead.radius, target.copy(), self.plane_axis)
        assert made.arc is not None
        if compensation and float(made.arc.normal @ turn) < 0.0:
            raise ContourError(Wording("NC324", "other_side"))
        return made
