"""Formulas against the maps that programs are made and proven with, at random poses."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Annotated, Any, Final, TypeAlias

import numpy as np

from trunnion.arrays import Floats
from trunnion.formulas.chain import LENGTH, TIP, TOOL_AXIS, Chain
from trunnion.formulas.rotary import Tilt
from trunnion.formulas.steps import Steps
from trunnion.formulas.symbols import Expression, symbol, sympy
from trunnion.machines import Machine, forward, inverse, slide_positions
from trunnion.records import dataclass
from trunnion.results import Figure

#: The most that a formula may be off, mm and degrees.
TOLERANCE: Final = 1e-9

#: Set-ups with a workpiece zero and a tool length of their own, as far as these are not given, and poses of each.
_SETUPS, _POSES = 5, 100

#: Poses nearer to where both solutions meet are left out (3 degrees): an arc cosine loses digits there.
_APART: Final = 0.05

#: Poses in which the box of the linear axes' directions is flatter are left out.
_FLAT: Final = 0.05

#: Travel of an axis that states none, mm and degrees, and the range of what is not known of a set-up, mm.
_TRAVEL, _TURN, _AWAY = 500.0, 180.0, 300.0

#: Ends of travel that are farther count as not stated, mm and degrees: a millionth of a turn has no digits there.
_FARTHEST: Final = 20000.0


#: A function of named numbers, or columns of them.
_Columns: TypeAlias = Callable[[Mapping[str, Any]], Floats]


@dataclass(frozen=True, slots=True)
class Agreement:
    """The largest differences between formulas and the maps of the product.

    poses         that were tried: random positions within travel
    forward_mm    of the tip
    tool_axis     of the tool axis, a part of a unit vector
    rotary_deg    of rotary axes, both solutions
    linear_mm     of linear axes, both solutions
    words_mm      of words without TCP; null where there are none
    largest       of all of these
    tolerance     the most that it may be
    """

    poses: int
    forward_mm: Annotated[float, Figure(unit="mm")]
    tool_axis: float
    rotary_deg: Annotated[float, Figure(unit="deg")]
    linear_mm: Annotated[float, Figure(unit="mm")]
    words_mm: Annotated[float | None, Figure(unit="mm")]
    tolerance: float = TOLERANCE

    @property
    @Figure()
    def largest(self) -> float:
        """The largest of all differences."""
        found = (self.forward_mm, self.tool_axis, self.rotary_deg, self.linear_mm, self.words_mm or 0.0)
        return float(np.max(found))  # NaN stays NaN

    @property
    @Figure()
    def passed(self) -> bool:
        """Whether it is within the tolerance; what cannot be computed is not."""
        return self.largest <= self.tolerance


@dataclass(frozen=True, slots=True, eq=False)
class MapFormulas:
    """All formulas of a machine.

    forward  of tip and tool axis
    rotary   of the rotary axes, for each solution; none where the tool axis never changes
    linear   of the linear axes
    words    without TCP; None where there are none
    flat     what is zero where the linear axes lie in a plane; None if that cannot be
    """

    forward: Steps
    rotary: tuple[Steps, ...]
    linear: Steps
    words: Steps | None
    flat: Expression | None


def agreement(chain: Chain, tilt: Tilt | None, formulas: MapFormulas) -> Agreement:
    """Return how far formulas are from forward and inverse."""
    random, largest, count = np.random.default_rng(20), np.zeros(5), 0
    evaluated = _Evaluated(chain, tilt, formulas)
    for _ in range(_SETUPS):
        machine, given = _set_up(chain, random)
        joints = evaluated.poses(random, given)
        count += len(joints)
        largest = np.maximum(largest, evaluated.differences(machine, given, joints))
    tip, axis, turn, slide, word = largest.tolist()
    return Agreement(count, tip, axis, turn, slide, None if formulas.words is None else word)


def evaluator(expressions: Sequence[Expression], names: Sequence[str]) -> _Columns:
    """Return a function of named numbers, or columns of them, that gives (n, expressions)."""
    own = {
        "cos": lambda angle: np.cos(np.radians(angle)),
        "sin": lambda angle: np.sin(np.radians(angle)),
        "acos": lambda value: np.degrees(np.arccos(np.clip(value, -1.0, 1.0))),
        "asin": lambda value: np.degrees(np.arcsin(np.clip(value, -1.0, 1.0))),
        "atan2": lambda y, x: np.degrees(np.arctan2(y, x)),
    }
    symbols = [symbol(name) for name in names]
    found = sympy().lambdify(symbols, list(expressions), modules=[own, "numpy"], cse=True)

    def values(given: Mapping[str, Any]) -> Floats:
        columns = np.broadcast_arrays(*found(*(given[name] for name in names)), *(given[name] for name in names))
        return np.stack(columns[: len(expressions)], axis=-1).astype(np.float64)

    return values


class _Evaluated:
    """Formulas as functions of columns."""

    def __init__(self, chain: Chain, tilt: Tilt | None, formulas: MapFormulas) -> None:
        self._chain, self._tilt = chain, tilt
        self._axes = [str(joint.variable) for joint in chain.joints]
        self._rotary = [str(joint.variable) for joint in chain.rotary]
        self._linear = [str(joint.variable) for joint in chain.linear]
        self._known = [each.name for each in chain.parameters]
        self._forward = self._function(formulas.forward, (*TIP, *TOOL_AXIS), self._axes)
        self._angles = [self._function(each, self._rotary, TOOL_AXIS) for each in formulas.rotary] or [self._at_zero]
        self._slides = self._function(formulas.linear, self._linear, (*TIP, *self._rotary))
        self._words: _Columns | None = None
        if formulas.words is not None:
            self._words = self._function(formulas.words, self._linear, (*TIP, *self._rotary))
        self._flat: _Columns | None = None
        if formulas.flat is not None:
            flat = Steps(chain.definitions)
            flat.say("flat", formulas.flat)
            self._flat = self._function(flat, ("flat",), self._rotary)

    def _function(self, steps: Steps, wanted: Sequence[str], names: Sequence[str]) -> _Columns:
        whole = steps.substituted()
        return evaluator([whole[name] for name in wanted], [*names, *self._known])

    def _at_zero(self, given: Mapping[str, Any]) -> Floats:
        """Return the rotary axes where no tool axis asks for them, as the inverse has them."""
        return np.zeros((len(given[TIP[0]]), len(self._rotary)))

    def poses(self, random: np.random.Generator, given: dict[str, float]) -> Floats:
        """Return random axis values (n, 5) within travel."""
        axes = self._chain.machine.axes
        ends = [_ends(axis.low, axis.high, _TURN if axis.is_rotary else _TRAVEL) for axis in axes]
        kept = self._apart(random, ends, given)
        if len(kept) == _POSES:
            return kept
        # All that the travel has is near a pole, or where the linear axes cannot follow.
        whole = [
            (-_TURN, _TURN) if axis.is_rotary and not axis.is_missing else end
            for axis, end in zip(axes, ends, strict=True)
        ]
        return self._apart(random, whole, given)

    def _apart(
        self, random: np.random.Generator, ends: Sequence[tuple[float, float]], given: dict[str, float]
    ) -> Floats:
        """Return random axis values (n, 5) between ends, those left out at which digits are lost."""
        low, high = np.array(ends).T
        rotary, kept = list(self._chain.machine.own_rotary), np.empty((0, 5))
        for _ in range(100):
            rows = random.uniform(low, high, (4 * _POSES, 5))
            sound = np.ones(len(rows), np.bool_)
            if self._flat is not None:
                flat = self._flat(dict(zip(self._rotary, rows[:, rotary].T, strict=True)) | given)
                sound &= np.abs(flat[:, 0]) > _FLAT
            if self._tilt is not None:
                sound &= np.abs(np.sin(np.radians(rows[:, rotary[1]] + self._tilt.delta))) > _APART
            kept = np.concatenate([kept, rows[sound]])
            if len(kept) >= _POSES:
                break
        return kept[:_POSES]

    def differences(self, machine: Machine, given: dict[str, float], joints: Floats) -> Floats:
        """Return the largest differences (5,): tip, tool axis, rotary axes, linear axes, words."""
        length = given[LENGTH]
        tip, axis = forward(machine, joints, length)
        own = [column for column, _ in machine.own_columns]
        columns = dict(zip(self._axes, joints.T[own], strict=True))
        found = self._forward(columns | given)
        off_tip, off_axis = np.abs(found[:, :3] - tip).max(), np.abs(found[:, 3:] - axis).max()
        there = inverse(machine, tip, axis, length)
        offset = slide_positions(machine, np.zeros((1, 3)), np.zeros((1, 2)), length)[:, list(machine.linear)]
        points = dict(zip((*TIP, *TOOL_AXIS), np.concatenate([tip, axis], axis=1).T, strict=True)) | given
        off_turn, off_slide, off_word = 0.0, 0.0, 0.0
        for branch, angles in enumerate(self._angles):
            turns = angles(points)
            here = points | dict(zip(self._rotary, turns.T, strict=True))
            gap = turns - there.joints[branch][:, list(machine.own_rotary)]
            slides = there.joints[branch][:, list(machine.linear)]
            off_turn = np.maximum(off_turn, np.abs((gap + 180.0) % 360.0 - 180.0).max(initial=0.0))
            off_slide = np.maximum(off_slide, np.abs(self._slides(here) - slides).max())
            if self._words is not None:
                off_word = np.maximum(off_word, np.abs(self._words(here) - (slides - offset)).max())
        return np.array([off_tip, off_axis, off_turn, off_slide, off_word])


def _set_up(chain: Chain, random: np.random.Generator) -> tuple[Machine, dict[str, float]]:
    """Return the machine with a workpiece zero and a tool length, and all parameters with their values."""
    machine, given = chain.machine, dict(chain.values)
    if machine.workpiece_zero is None:
        away = random.uniform(-_AWAY, _AWAY, 3).tolist()
        given |= {f"a_{letter}": value for letter, value in zip(TIP, away, strict=True)}
        first = chain.rotary[0].axis.point if chain.rotary else machine.spindle_point
        x, y, z = (at - part for at, part in zip(first, away, strict=True))
        machine = replace(machine, workpiece_zero=(x, y, z))
    given.setdefault(LENGTH, float(random.uniform(20.0, _AWAY)))
    return machine, given


def _ends(low: float, high: float, most: float) -> tuple[float, float]:
    """Return the ends of a travel; one that is not stated, or very far, is as far as ``most``."""
    if low > _FARTHEST or high < -_FARTHEST:
        return -most, most
    first = low if low > -_FARTHEST else min(-most, high - most)
    return first, high if high < _FARTHEST else max(most, first + most)
