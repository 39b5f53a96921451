"""The inverse map of the rotary axes as formulas: two pairs of angles for a tool axis.

With w1 and w2 the directions of the rotary axes and s the spindle, the tool axis u = R1 R2 s has along w1 what R2 s has
there, for R1 does not change it:

    w1.u = (w1.w2)(w2.s) + |w1 x w2| |w2 x s| cos(q2 + delta),   delta: the angle about w2 from w1 to s.

That gives the second angle twice; the first one turns R2 s onto u.
"""

import math
from collections.abc import Callable
from functools import partial

import numpy as np

from trunnion.arrays import Floats
from trunnion.formulas.chain import TOOL_AXIS, Chain, Parameter
from trunnion.formulas.steps import Steps
from trunnion.formulas.symbols import (
    Expression,
    Triple,
    cardinal,
    cross,
    dot,
    float_of,
    function,
    number,
    symbol,
    sympy,
)
from trunnion.messages import Wording
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class Tilt:
    """How the second rotary axis follows from the tool axis: q2 = +-acos(cosine) - delta.

    sense       1 or -1: w1 is taken with this sign, so that at zero the spindle leans towards it as seen along w2
    cosine      of q2 + delta
    delta       degrees, in [-90, 90]
    between     angle between w1, with its sign, and w2, degrees
    of_spindle  angle between w2 and the spindle, degrees
    parameters  numbers in the cosine and in delta that are not exact
    """

    sense: int
    cosine: Expression
    delta: float
    between: float
    of_spindle: float
    parameters: tuple[Parameter, ...]

    def second_angles(self, branch: int, phi: Floats) -> Floats:
        """Return the second angle of a solution, 0 or 1, where the arc cosine is ``phi``; degrees."""
        return (phi if branch == 0 else -phi) - self.delta


def tilt_of(chain: Chain) -> Tilt:
    """Return how the second angle follows from the tool axis."""
    first, second = chain.rotary
    sp, values = sympy(), chain.values
    w1, w2, s = (
        np.array([float_of(part, values) for part in each])
        for each in (first.direction, second.direction, chain.spindle)
    )
    lean = float(np.cross(np.cross(w2, w1), w2) @ s)
    turn = float(np.cross(w2, w1) @ s)
    sense = int(math.copysign(1.0, lean if abs(lean) > 1e-9 else turn))
    delta = round(math.degrees(math.atan2(sense * turn, sense * lean)), 9) + 0.0
    along = sense * dot(first.direction, _tool_axis())
    one, two = dot(first.direction, second.direction), dot(second.direction, chain.spindle)
    fixed = sp.expand(sense * one * two)
    greatest = sp.sqrt(sp.expand((1 - one**2) * (1 - two**2)))
    noted = list[Parameter]()
    if fixed.free_symbols or greatest.free_symbols:
        kept = Wording("kinematics", "no_turn_changes", axis=first.axis.name)
        most = Wording("kinematics", "turn_changes_most", axis=first.axis.name)
        noted.append(Parameter("kappa", kept, float_of(fixed, values), ""))
        noted.append(Parameter("nu", most, float_of(greatest, values), ""))
        fixed, greatest = symbol("kappa"), symbol("nu")
    if delta != round(delta):
        meaning = Wording("kinematics", "angle_about", axis=second.axis.name, other=first.axis.name)
        noted.append(Parameter("delta", meaning, math.degrees(math.atan2(sense * turn, sense * lean)), "deg"))
    cosine = (along - fixed) / greatest
    if not cosine.free_symbols & {symbol("nu"), symbol("kappa")}:
        cosine = sp.expand(cosine)
    return Tilt(sense, cosine, delta, _angle(sense * w1, w2), _angle(w2, s), tuple(noted))


def rotary_formulas(chain: Chain, tilt: Tilt, branch: int) -> Steps:
    """Return the formulas of both rotary axes of one solution, 0 or 1."""
    steps = Steps(chain.definitions)
    second = chain.rotary[1]
    steps.say(str(second.variable), _second_angle(tilt, branch))
    spindle = steps.turn(second.turn, chain.spindle, "v")
    _say_first_angle(steps, chain, spindle, partial(sign_along, chain, tilt, branch))
    return steps


def one_axis_formulas(chain: Chain) -> Steps:
    """Return the formula of the rotary axis of a machine that has one: it turns the spindle onto the tool axis."""
    steps = Steps(chain.definitions)
    values = chain.values
    _say_first_angle(steps, chain, chain.spindle, lambda part: int(math.copysign(1.0, float_of(part, values))))
    return steps


def _say_first_angle(steps: Steps, chain: Chain, spindle: Triple, sign_of: Callable[[Expression], int]) -> None:
    """Note the angle about the first rotary axis that turns a direction onto the tool axis."""
    first = chain.rotary[0]
    place = cardinal(first.direction)
    if place is None:
        steps.say(str(first.variable), _turn_about(steps, first.direction, spindle))
        return
    axis, sign = place
    ahead = ((axis + 1) % 3, (axis + 2) % 3)
    one, two = ahead if sign > 0 else (ahead[1], ahead[0])
    u1, u2 = _tool_axis()[one], _tool_axis()[two]
    v1, v2 = spindle[one], spindle[two]
    known = sign_of(v2 if v1 == 0 else v1) if 0 in (v1, v2) else 0
    if known and v2 == 0:
        angle = function("atan2", known * u2, known * u1)
    elif known and v1 == 0:
        angle = function("atan2", -known * u1, known * u2)
    else:
        v1, v2 = _without_divisors(v1, v2)
        angle = function("atan2", u2, u1) - function("atan2", v2, v1)
    steps.say(str(first.variable), angle)


def sign_along(chain: Chain, tilt: Tilt, branch: int, expression: Expression) -> int:
    """Return the sign that a function of the second angle has all over a solution; 0 if that changes."""
    sp = sympy()
    variable = chain.rotary[1].variable
    of_degrees = {
        sp.Function("cos")(variable): sp.cos(variable * sp.pi / 180),
        sp.Function("sin")(variable): sp.sin(variable * sp.pi / 180),
    }
    plain = sp.sympify(expression).xreplace(of_degrees)
    angles = tilt.second_angles(branch, np.linspace(1.0, 179.0, 19)).tolist()
    signs = {math.copysign(1.0, float_of(plain, {**chain.values, str(variable): angle})) for angle in angles}
    return int(signs.pop()) if len(signs) == 1 else 0


def _second_angle(tilt: Tilt, branch: int) -> Expression:
    cosine, sign = tilt.cosine, 1 if branch == 0 else -1
    if tilt.delta == 0.0:
        return sign * function("acos", cosine)
    if abs(tilt.delta) == 90.0:
        sine = -function("asin", cosine) if tilt.delta > 0.0 else function("asin", cosine)
        return sine if (branch == 0) == (tilt.delta > 0.0) else 180 - sine
    exact = tilt.delta == round(tilt.delta)
    return sign * function("acos", cosine) - (number(round(tilt.delta)) if exact else symbol("delta"))


def _without_divisors(a: Expression, b: Expression) -> tuple[Expression, Expression]:
    """Return two expressions times a whole number, so that they have no divisors: their angle is the same."""
    sp = sympy()
    divisors = [sp.fraction(sp.together(each))[1] for each in (a, b)]
    if not all(each.is_Integer for each in divisors):
        return a, b
    common = sp.ilcm(*divisors)
    return sp.expand(a * common), sp.expand(b * common)


def _turn_about(steps: Steps, direction: Triple, spindle: Triple) -> Expression:
    """Return the angle about any direction that turns the spindle onto the tool axis."""
    parts = [
        part if part.is_Symbol or part.is_number else steps.say(f"v_{letter}", part)
        for letter, part in zip("xyz", spindle, strict=True)
    ]
    named, tool = (parts[0], parts[1], parts[2]), _tool_axis()
    above = dot(direction, cross(named, tool))
    return function("atan2", above, dot(named, tool) - dot(direction, named) * dot(direction, tool))


def _tool_axis() -> Triple:
    i, j, k = (symbol(name) for name in TOOL_AXIS)
    return i, j, k


def _angle(a: Floats, b: Floats) -> float:
    return math.degrees(math.atan2(float(np.linalg.norm(np.cross(a, b))), float(a @ b)))
