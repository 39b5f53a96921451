"""The first leg of the way from home to a tilted plane, on machines whose head tilts the tool.

In:     a program, a motion of it in a plane, and the point to which the approach leads.
Out:    where the first leg ends, mm, in coordinates of the plane.

Where a table tilts the part, X and Y of the plane lead across the tool, and Z along it: the tool stays as high as home.
Where a head tilts the tool, that first leg may lead below the part, beyond the travel of an axis. There the linear axes
go in an order of their own: first to the point across the spindle, with the axis along it at home. Each leg is straight
between positions that lie within the travel, so that it is within the travel, too.
"""

from collections.abc import Iterator
from functools import cached_property
from itertools import combinations, pairwise
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines import Machine, Mount, forward, slide_positions
from trunnion.model.motion import Motion
from trunnion.output.coordinates.extents import cut_box
from trunnion.output.program import Program

#: The axis along the spindle ends this much nearer to the part than home, mm, which may be the end of its travel: the
#: zero that is measured at the machine is never exactly the stated one.
_FROM_HOME: Final = 5.0

#: Smaller angles are none, degrees.
_STILL: Final = 1e-6

#: Places on a leg that are looked at.
_PLACES: Final = 101


def tilts_tool(machine: Machine, motion: Motion) -> bool:
    """Whether a head tilts the tool for a motion in a plane, so that it is not along an axis any more."""
    if motion.plane is None:
        return False
    columns = [k for k, column in enumerate(machine.rotary) if machine.axes[column].mount is Mount.TOOL]
    return bool(columns) and bool((np.abs(motion.rotary[0, columns]) > _STILL).any())


def height_at_home(machine: Machine, tip: Floats, rotary: Floats) -> float | None:
    """Return how high along the tool the tip is over a point (3,) with the axis along the spindle near home, mm: at
    least half way there. None where that is not known, or where a head has turned the tool from it, by ``rotary`` (2,)
    degrees.
    """
    tilts = any(
        machine.axes[k].mount is Mount.TOOL and abs(a) > _STILL for k, a in zip(machine.rotary, rotary, strict=True)
    )
    if machine.workpiece_zero is None or machine.tool_length is None or tilts:
        return None
    end = slide_positions(machine, tip[None], rotary[None])
    if np.isnan(end).any():
        return None
    along = max(machine.linear, key=lambda k: abs(float(np.dot(machine.axes[k].direction, machine.spindle_direction))))
    way = machine.home[along] - end[0, along]
    end[0, along] += way - np.sign(way) * min(_FROM_HOME, abs(way) / 2.0)
    place, axis = forward(machine, end)[:2]
    return float(place[0] @ axis[0])


class ApproachLegs:
    """Knows where the first legs of a program end."""

    def __init__(self, program: Program) -> None:
        self._program = program
        axes, spindle = program.machine.axes, program.machine.spindle_direction
        # Column of the linear axis along the spindle, all axes at zero.
        self._along = max(program.machine.linear, key=lambda k: abs(float(np.dot(axes[k].direction, spindle))))

    def first(self, motion: Motion, point: Floats) -> Floats | None:
        """Return where the first leg ends, (3,) mm in the plane; None: X and Y of the plane first.

        point  (3,) mm in the plane
        """
        machine = self._program.called_machine_of(motion)
        if motion.plane is None or not (tilts_tool(machine, motion) and self.is_placed(motion) and self.goes_home):
            return None
        turn, origin = motion.plane.matrix(), np.array(motion.plane.origin)
        target = slide_positions(machine, (turn @ point + origin)[None], motion.rotary[:1])[0]
        if np.isnan(target).any():
            return None
        home = target.copy()
        home[list(machine.linear)] = machine.home[list(machine.linear)]
        ends = list(self._ends(home, target, from_home=motion.starts_operation))
        end = next((each for each in ends if self._is_clear(machine, home, each, target)), ends[0])
        return np.asarray(turn.T @ (forward(machine, end[None])[0][0] - origin))

    def is_placed(self, motion: Motion) -> bool:
        """Whether it is known where home is in the workpiece."""
        machine = self._program.machine_of(motion)
        return machine.workpiece_zero is not None and machine.tool_length is not None

    @cached_property
    def goes_home(self) -> bool:
        """Whether the templates retract to the home position: a word for it does not say how far it goes."""
        home = f"home_{self._program.machine.axes[self._along].name.lower()}"
        return any(
            name == home for template in self._program.control.templates.values() for name, _ in template.fields()
        )

    @cached_property
    def _box(self) -> tuple[Floats, Floats] | None:
        return cut_box(self._program.motions)

    def _ends(self, home: Floats, target: Floats, *, from_home: bool) -> Iterator[Floats]:
        """Yield ends of first legs, (5,) axis values, the best first: which axes are at the point, others at home.

        from_home  all axes come from home; else only that along the spindle does
        """
        across = [column for column in self._program.machine.linear if column != self._along]
        orders: list[tuple[int, ...]] = [tuple(across)]
        if from_home:
            orders += [(column,) for column in across]
            orders += [(self._along, *rest) for count in (1, 0) for rest in combinations(across, count)]
        for order in orders:
            end = home.copy()
            end[list(order)] = target[list(order)]
            if self._along not in order:
                end[self._along] += np.clip((target - home)[self._along], -_FROM_HOME, _FROM_HOME)
            yield end

    def _is_clear(self, machine: Machine, *stations: Floats) -> bool:
        """Whether the tip stays out of the box around all cuts on its way, if the way does not end within it."""
        if self._box is None:
            return True
        shares = np.linspace(0.0, 1.0, _PLACES)[:, None]
        way = np.concatenate([a + shares * (b - a) for a, b in pairwise(stations)])
        tips = forward(machine, way)[0]
        inside = np.asarray(((tips > self._box[0]) & (tips < self._box[1])).all(axis=1))
        return bool(inside[-1]) or not inside.any()
