"""The forward map as formulas: tip and tool axis, from the tool back to the workpiece."""

from functools import reduce

from trunnion.formulas.chain import TIP, TOOL_AXIS, Chain, Joint
from trunnion.formulas.steps import Steps
from trunnion.formulas.symbols import Expression, Rows, Triple, number, plus, product, symbol, times
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class FrameStep:
    """The way from one frame to the next.

    name    of the frame: that of its axis, or ``tool``
    before  name of the frame before it
    matrix  (4, 4): the frame in the one before it
    """

    name: str
    before: str
    matrix: tuple[tuple[Expression, ...], ...]


def frame_steps(chain: Chain) -> tuple[FrameStep, ...]:
    """Return the homogeneous matrix of each axis, and of the tool, from the workpiece to the tool."""
    before, steps = "workpiece", list[FrameStep]()
    for joint in chain.joints:
        steps.append(FrameStep(joint.axis.name, before, _homogeneous(*_step(joint))))
        before = joint.axis.name
    return (*steps, FrameStep("tool", before, _homogeneous(_unit(), chain.tool)))


def whole_matrix(chain: Chain) -> FrameStep:
    """Return the matrix from the workpiece to the tool; where the tip is has its own formulas."""
    turns = [joint.turn for joint in chain.rotary]
    x, y, z = (symbol(name) for name in TIP)
    return FrameStep("tool", "workpiece", _homogeneous(reduce(product, turns) if turns else _unit(), (x, y, z)))


def forward_formulas(chain: Chain) -> Steps:
    """Return the formulas of the tip ``x y z`` and of the tool axis ``i j k``."""
    steps = Steps(chain.definitions)
    point, direction = chain.tool, chain.spindle
    count = len(chain.rotary)
    for joint in reversed(chain.joints):
        if not joint.axis.is_rotary:
            point = plus(point, times(joint.direction, joint.variable))
            continue
        point = plus(steps.turn(joint.turn, point, f"r_{count}"), joint.offset)
        direction = steps.turn(joint.turn, direction, f"v_{count}")
        count -= 1
    for name, part in zip((*TIP, *TOOL_AXIS), (*point, *direction), strict=True):
        steps.say(name, part)
    return steps


def _step(joint: Joint) -> tuple[Rows, Triple]:
    if joint.axis.is_rotary:
        return joint.matrix, joint.offset
    return _unit(), times(joint.direction, joint.variable)


def _unit() -> Rows:
    zero, one = number(0), number(1)
    return (one, zero, zero), (zero, one, zero), (zero, zero, one)


def _homogeneous(rows: Rows, origin: Triple) -> tuple[tuple[Expression, ...], ...]:
    upper = tuple((*row, part) for row, part in zip(rows, origin, strict=True))
    return (*upper, (*_unit()[0][1:], number(0), number(1)))
