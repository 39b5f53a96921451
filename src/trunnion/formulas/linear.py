"""The inverse map of the linear axes as formulas, the rotary axes being known; and the words without TCP."""

from itertools import takewhile
from typing import Final

from trunnion.formulas.chain import TIP, Chain, Joint
from trunnion.formulas.steps import Steps
from trunnion.formulas.symbols import (
    Expression,
    Triple,
    cardinal,
    cross,
    dot,
    minus,
    number,
    plus,
    size_of,
    symbol,
    sympy,
    turned,
)

#: Symbols of a work offset that stands within a formula.
_LONGEST_OFFSET: Final = 6


def linear_formulas(chain: Chain) -> Steps:
    """Return the formulas of the positions of the linear axes.

    From the workpiece zero to the tip, what is below the linear axes is turned back, and what is above them is turned.
    """
    steps = Steps(chain.definitions)
    below, rest = _below(chain), chain.tool
    x, y, z = (symbol(name) for name in TIP)
    point: Triple = (x, y, z)
    for k, joint in enumerate(below, 1):
        point = steps.turn_back(joint.turn, minus(point, joint.offset), f"p_{k}")
    above = [joint for joint in chain.joints if joint.axis.is_rotary and joint not in below]
    for k, joint in enumerate(reversed(above), 1):
        rest = plus(steps.turn(joint.turn, rest, f"r_{k}"), joint.offset)
    way, columns = minus(point, rest), _columns(chain)
    places = [cardinal(column) for column in columns]
    if None not in places:
        found = [place[1] * way[place[0]] for place in places if place is not None]
    else:
        found = _along(steps, columns, way)
    for joint, value in zip(chain.linear, found, strict=True):
        steps.say(str(joint.variable), value)
    return steps


def words_without_tcp(chain: Chain) -> Steps | None:
    """Return what a program without TCP has in place of positions; None where its work offset cannot be set.

    Its words count from where the linear axes are with the tip at the workpiece zero and the rotary axes at zero.
    """
    if sorted(joint.axis.name for joint in chain.linear) != ["X", "Y", "Z"]:
        return None
    steps = linear_formulas(chain)
    names = [str(joint.variable) for joint in chain.linear]
    whole, at_zero = steps.substituted(), _at_zero(chain)
    words = Steps(chain.definitions, [each for each in steps.found if each[0] not in names])
    sp = sympy()
    for name, value in steps.found:
        if name not in names:
            continue
        offset = sp.expand(whole[name].xreplace(at_zero))
        offset = sp.together(offset) if size_of(offset) > _LONGEST_OFFSET else offset
        if offset.has(sp.zoo, sp.nan, sp.oo):
            return None
        words.say(name, value - (words.say(f"{name}_0", offset) if size_of(offset) > _LONGEST_OFFSET else offset))
    return words


def dependence(chain: Chain) -> Expression | None:
    """Return what is zero where the linear axes lie in a plane; None if no rotary axis is between them."""
    determinant = _determinant(_columns(chain))
    turning = {joint.variable for joint in chain.rotary} | {symbol(name) for name, _ in chain.definitions}
    return determinant if determinant.free_symbols & turning else None


def _at_zero(chain: Chain) -> dict[Expression, Expression]:
    sp = sympy()
    found = {symbol(name): number(0) for name in TIP}
    for joint in chain.rotary:
        found[sp.Function("cos")(joint.variable)] = number(1)
        found[sp.Function("sin")(joint.variable)] = number(0)
    return found


def _below(chain: Chain) -> list[Joint]:
    """Return the rotary axes between the workpiece and the first linear axis."""
    return list(takewhile(lambda joint: joint.axis.is_rotary, chain.joints))


def _columns(chain: Chain) -> tuple[Triple, Triple, Triple]:
    """Return the directions of the linear axes, each turned by the rotary axes between the first one and it."""
    found, turns = list[Triple](), list[Joint]()
    for joint in chain.joints[len(_below(chain)) :]:
        if joint.axis.is_rotary:
            turns.append(joint)
            continue
        direction = joint.direction
        for turn in reversed(turns):
            direction = turned(turn.turn, direction)
        found.append(direction)
    return found[0], found[1], found[2]


def _along(steps: Steps, columns: tuple[Triple, Triple, Triple], way: Triple) -> list[Expression]:
    """Return the parts of a way along three directions (Cramer's rule)."""
    named = [
        steps.say(f"d_{letter}", part) if part.is_Add or part.is_Mul else part
        for letter, part in zip(TIP, way, strict=True)
    ]
    determinant = _determinant(columns)
    if determinant.free_symbols:
        determinant = steps.say("det", determinant)
    found = []
    for k in range(3):
        x, y, z = (_without_sine_squares(part) for part in cross(columns[(k + 1) % 3], columns[(k + 2) % 3]))
        part = dot((x, y, z), (named[0], named[1], named[2])) / determinant
        found.append(part if determinant.free_symbols else sympy().expand(part))
    return found


def _determinant(columns: tuple[Triple, Triple, Triple]) -> Expression:
    return sympy().factor_terms(_without_sine_squares(dot(columns[0], cross(columns[1], columns[2]))))


def _without_sine_squares(expression: Expression) -> Expression:
    """Return an expression in which squares of sines are those of cosines."""
    sp = sympy()
    found = sp.expand(expression)
    for each in sorted(found.atoms(sp.Function("sin")), key=str):
        found = sp.expand(found.subs(each**2, 1 - sp.Function("cos")(*each.args) ** 2))
    return found
