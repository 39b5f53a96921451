"""The states of two programs that are compared besides their paths."""

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.machines import forward
from trunnion.messages import Wording
from trunnion.model.run import Orientation, Run
from trunnion.model.toolpath import Kind
from trunnion.verification.comparison.moving_rows import MovingRows
from trunnion.verification.comparison.registers import compared_registers
from trunnion.verification.comparison.said_modes import said_modes
from trunnion.verification.comparison.stated_axes import stated_axes
from trunnion.verification.comparison.states import ComparedState

#: Feeds and speeds are the same within this, mm/min and rev/min: programs print no more digits.
_FEED: Final = 0.005
_RPM: Final = 0.5

#: The last digit of most positions, mm; and how far one distance may be off whose ends are printed so.
_DIGIT: Final = 1e-4
_ROUNDED: Final = math.sqrt(3.0) * _DIGIT

#: Tool axes that are no farther apart, as the length of a vector, are the same: 0.001 degrees.
_BENT: Final = 1.75e-5

#: How many times farther apart tips may be between the ends of motions than at them: without TCP points are set so
#: densely that the tip leaves its line by some micrometres.
_BETWEEN: Final = 10.0

#: Where in a motion the tip is looked at.
_PARTS: Final = (0.25, 0.5, 0.75)

_WAYS: Final = {
    int(Orientation.ANGLES): "by_angles",
    int(Orientation.GREAT_CIRCLE): "on_great_circle",
}


def compared_states(
    one: MovingRows, two: MovingRows, *, path: bool, most_feeds: tuple[float, float], tolerance: float
) -> list[ComparedState]:
    """Return what is compared in the rows of two programs.

    path        only what says where the tool is
    most_feeds  the largest F of either control, mm/min
    tolerance   how far tips may be apart at the ends of motions, mm
    """
    between = _tips_between(one.run, two.run, _BETWEEN * tolerance)
    states = [_frames(one, two), between, *_orientations(one.run, two.run)]
    states += compared_registers(one.run, two.run, path=path)
    if path:
        return states
    tools = ComparedState(
        _everywhere,
        lambda a, b: np.asarray(one.tool[a] == two.tool[b]),
        lambda a, b: (one.tool[a], two.tool[b]),
        lambda a, b: Wording("comparison", "tools", one=one.tool_name(a), two=two.tool_name(b)),
    )
    coolants = ComparedState(
        _everywhere,
        lambda a, b: np.asarray(one.coolant[a] == two.coolant[b]),
        lambda a, b: (one.coolant[a], two.coolant[b]),
        lambda _a, _b: Wording("comparison", "coolants"),
    )
    states += [*said_modes(one.run, two.run), *stated_axes(one.run, two.run)]
    return [*states, _feeds(one, two, most_feeds), _spindles(one, two), tools, coolants]


def _everywhere(a: Ints, _b: Ints) -> Flags:
    return np.ones(len(a), np.bool_)


def _frames(one: MovingRows, two: MovingRows) -> ComparedState:
    """Whether rows are in machine coordinates that nothing relates to the workpiece."""
    return ComparedState(
        _everywhere,
        lambda a, b: np.asarray(one.in_machine(a) == two.in_machine(b)),
        lambda a, b: (one.in_machine(a), two.in_machine(b)),
        lambda _a, _b: Wording("comparison", "frames"),
    )


def _orientations(one: Run, two: Run) -> Iterator[ComparedState]:
    """Yield how the tool axis moves between points under TCP: rotary axes evenly, or the axis on a great circle.

    On two machines the ways differ anyhow, as their rotary axes do.
    """
    if one.machine.key != two.machine.key:
        return

    def counts(a: Ints, b: Ints) -> Flags:
        found = np.asarray(one.orientation[a] != two.orientation[b])
        at = np.flatnonzero(found)
        found[at] = _bends(one, a[at]) & _bends(two, b[at])
        return found

    def said(a: int, b: int) -> Wording:
        ways = [Wording("comparison", _WAYS[int(way)]) for way in (one.orientation[a], two.orientation[b])]
        return Wording("comparison", "orientations", one=ways[0], two=ways[1])

    yield ComparedState(
        counts, lambda a, _b: np.zeros(len(a), np.bool_), lambda a, b: (one.orientation[a], two.orientation[b]), said
    )


def _tips_between(one: Run, two: Run, most: float) -> ComparedState:
    """How far the tip leaves its line in cuts that turn without TCP, where the other program holds it there, or has
    other points before.
    """

    def off(a: Ints, b: Ints) -> Floats:
        away = np.zeros(len(a))
        for run, rows in ((one, a), (two, b)):
            free = ~run.state.tcp.at(rows)
            away[free] = np.maximum(away[free], _off_line(run, rows[free]))
        return away

    def counts(a: Ints, b: Ints) -> Flags:
        cuts = (one.kind[a] == Kind.LINEAR) & (two.kind[b] == Kind.LINEAR)
        tcp, other = one.state.tcp.at(a), two.state.tcp.at(b)
        found = cuts & (tcp != other)
        free = np.flatnonzero(cuts & ~tcp & ~other)
        apart = one.positions(a[free] - 1).tip - two.positions(b[free] - 1).tip
        found[free] = np.abs(apart).max(axis=1, initial=0.0) > most
        return np.asarray(found)

    return ComparedState(
        counts,
        lambda a, b: np.asarray(off(a, b) <= most),
        lambda a, b: (one.state.tcp.at(a), two.state.tcp.at(b)),
        lambda a, b: Wording("comparison", "leaves_line", away=off(np.array([a]), np.array([b]))[0]),
    )


def _off_line(run: Run, rows: Ints) -> Floats:
    """How far the tip is from the straight line between its ends, at most, (k,) mm, where all axes move evenly."""
    before, after = run.positions(rows - 1), run.positions(rows)
    away = np.zeros(len(rows))
    for part in _PARTS:
        tip, _ = run.forward_at(rows, (1.0 - part) * before.joints + part * after.joints)
        line = after.tip - before.tip
        way = tip - before.tip
        along = np.einsum("ij,ij->i", way, line) / np.maximum(np.einsum("ij,ij->i", line, line), 1e-18)
        away = np.maximum(away, np.linalg.norm(way - along[:, None] * line, axis=1))
    return away


def _bends(run: Run, rows: Ints) -> Flags:
    """In which rows the tool axis is elsewhere half-way where rotary axes move evenly under TCP, (k,) bool."""
    before, after = run.positions(rows - 1), run.positions(rows)
    by_angles = forward(run.machine, 0.5 * (before.joints + after.joints))[1]
    on_circle = before.axis + after.axis
    length = np.maximum(np.linalg.norm(on_circle, axis=1), 1e-9)
    apart = np.linalg.norm(by_angles - on_circle / length[:, None], axis=1)
    return np.asarray((apart > _BENT) & run.state.tcp.at(rows))


def _feeds(one: MovingRows, two: MovingRows, most: tuple[float, float]) -> ComparedState:
    def same(a: Ints, b: Ints) -> Flags:
        feeds, others = one.feeds(a), two.feeds(b)
        limits = np.maximum(_FEED, 1e-4 * feeds)
        # Only one of them is printed as it is meant: the other stands on a length that has been rounded too.
        lengths = one.counted_lengths(a), two.counted_lengths(b)
        mixed = np.isnan(lengths[0]) != np.isnan(lengths[1])
        length = np.fmax(np.fmax(*lengths)[mixed], _DIGIT)
        limits[mixed] = np.maximum(limits[mixed], feeds[mixed] * _ROUNDED / length)
        near = np.abs(feeds - others) <= limits
        # As fast as the control allows, and slower than the other: rotary axes turn far while the tip hardly moves.
        near |= mixed & (one.programmed(a) >= most[0] - _FEED) & (feeds < others)
        near |= mixed & (two.programmed(b) >= most[1] - _FEED) & (others < feeds)
        return np.asarray(near)

    def said(a: int, b: int) -> Wording:
        return Wording("comparison", "feeds", one=one.feeds(np.array([a]))[0], two=two.feeds(np.array([b]))[0])

    return ComparedState(
        lambda a, b: np.asarray((one.run.kind[a] != Kind.RAPID) & (two.run.kind[b] != Kind.RAPID)),
        same,
        lambda a, b: (one.programmed_feeds(a), two.programmed_feeds(b)),
        said,
    )


def _spindles(one: MovingRows, two: MovingRows) -> ComparedState:
    def speeds(rows: MovingRows, at: Ints) -> Floats:
        """Speeds with the sign of the sense, (k,); 0 where it stands."""
        return np.asarray(np.nan_to_num(rows.run.rpm[at]) * rows.run.spindle[at])

    def same(a: Ints, b: Ints) -> Flags:
        senses = one.run.spindle[a] == two.run.spindle[b]
        return np.asarray(senses & (np.abs(speeds(one, a) - speeds(two, b)) <= _RPM))

    return ComparedState(
        _everywhere,
        same,
        lambda a, b: (speeds(one, a), speeds(two, b)),
        lambda a, b: Wording("comparison", "spindles", one=one.spindle_words(a), two=two.spindle_words(b)),
    )
