"""The datum from before a tilted plane and the one set in it, and what of them no source settles.

Confirmed, by manuals and by programs that ran: what is set before a plane carries it; what is set in a plane acts in
it; a shift that is set to zero in the plane is gone after PLANE RESET, also if it was set before the plane. Everything
else is unsettled: no position can be stated until the program sets it anew without a plane.
"""

from collections.abc import Set
from dataclasses import replace
from typing import Final

from trunnion.readers.families.heidenhain.plane_frames import Datum

#: Parts of a datum that a program sets one by one.
SHIFTS: Final = ("shift X", "shift Y", "shift Z")
MIRROR: Final = "mirror"
ROTATION: Final = "rotation"
SCALE: Final = "scale"


class PlaneDatums:
    """The datums before the plane and in it.

    base       without a plane, or from before it
    in_plane   set in the plane
    unsettled  parts of the datum in force that no source settles
    """

    def __init__(self) -> None:
        self.base = Datum()
        self.in_plane = Datum()
        self.unsettled: set[str] = set()
        # Parts that the plane's own cycles have set, and those that a plane on top of the plane has taken over.
        self._set_in_plane: set[str] = set()
        self._taken_over: set[str] = set()

    def set_base(self, datum: Datum, parts: Set[str]) -> None:
        """Set the datum without a plane; ``parts`` are those that do not count from what they were."""
        self.base = datum
        self.unsettled -= parts

    def set_in_plane(self, datum: Datum, parts: Set[str]) -> None:
        """Set ``parts`` of the datum in the plane: whether the same part from before still counts is unsettled."""
        self.in_plane = datum
        self._set_in_plane |= parts
        before = _parts_in_use(self.base)
        if parts & set(SHIFTS) and before & set(SHIFTS):
            self.unsettled |= set(SHIFTS)
        self.unsettled |= parts & before

    def enter_plane(self, *, on_top: bool) -> None:
        """Begin a plane, in place of the one in force or on top of it (PLANE RELATIV)."""
        left = _parts_in_use(self.in_plane)
        if on_top:
            self._taken_over |= left
        else:
            self.unsettled |= left
            if left & set(SHIFTS):
                self.unsettled |= set(SHIFTS)
        self.in_plane = Datum()

    def leave_plane(self) -> None:
        """End the plane: shifts that it has set to zero are gone, and what it has set otherwise is unsettled."""
        left = _parts_in_use(self.in_plane) | self._taken_over
        shift = [
            0.0 if part in self._set_in_plane else value for part, value in zip(SHIFTS, self.base.shift, strict=True)
        ]
        if left & set(SHIFTS):
            self.unsettled |= set(SHIFTS)
        else:
            self.base = replace(self.base, shift=(shift[0], shift[1], shift[2]))
            self.unsettled -= self._set_in_plane & set(SHIFTS)
            self.unsettled -= {part for part, value in zip(SHIFTS, shift, strict=True) if not value}
        self.unsettled |= left
        self.in_plane = Datum()
        self._set_in_plane.clear()
        self._taken_over.clear()


def _parts_in_use(datum: Datum) -> set[str]:
    """Return the parts of a datum that change positions."""
    parts = {part for part, value in zip(SHIFTS, datum.shift, strict=True) if value}
    parts |= {MIRROR} if any(datum.mirrored) else set()
    parts |= {ROTATION} if datum.angle else set()
    return parts | ({SCALE} if datum.scale != (1.0, 1.0, 1.0) else set())
