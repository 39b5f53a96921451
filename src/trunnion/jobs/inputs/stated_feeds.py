"""The setting ``missing_feed``: feeds of cuts and holes whose CL file states none, and pitches of taps."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.errors import InputError, setting_problem
from trunnion.jobs.inputs.stated_by_operation import check_operations, stated_values, value_twice
from trunnion.messages import Wording
from trunnion.model.toolpath import CycleOff, CycleOn, Event, Kind, Operation, Toolpath
from trunnion.records import dataclass

_KEY: Final = "missing_feed"

#: What stands behind a feed per revolution, as in CL files; a feed per minute has nothing behind it.
_PER_REVOLUTION: Final = "MMPR"
_PER_MINUTE: Final = "MMPM"

#: The feeds that it takes, mm/min.
_BOUNDS: Final = (1e-3, 99_999.0)

#: The greatest that it takes per revolution, mm: metric threads have pitches up to 8, and no cutter bears more.
_MOST_PER_REVOLUTION: Final = 10.0


@dataclass(frozen=True, slots=True)
class _Stated:
    """What is stated of an operation: a feed, mm/min, and one per revolution; None: nothing is."""

    per_minute: float | None = None
    per_rev: float | None = None


def with_stated_feeds(toolpaths: Iterable[Toolpath], settings: Mapping[str, str]) -> list[Toolpath]:
    """Give cuts and holes without a feed those that the setting states; one that the CL file states stays.

    Raises ``InputError`` for an operation that is not there, or that lacks no feed.
    """
    feeds, found = _stated_feeds(settings), [*toolpaths]
    if not feeds:
        return found
    check_operations(_KEY, feeds, found)
    lacking = {each.name for path in found for each in path.operations if _lacks(each)}
    if has_all := sorted({*feeds} - {"", *lacking}):
        said = [setting_problem(_KEY, Wording("ARG230", "states_own_feeds", operation=name)) for name in has_all]
        raise InputError(said)
    others = feeds.get("", _Stated())
    return [
        replace(path, operations=tuple(_fed(each, feeds.get(each.name, others), others) for each in path.operations))
        for path in found
    ]


def _stated_feeds(settings: Mapping[str, str]) -> dict[str, _Stated]:
    """Return the feeds that the setting states, by operation: of one, a feed per minute and a pitch of its taps."""
    found: dict[str, _Stated] = {}
    for name, (feed, per_rev) in stated_values(_KEY, settings, _feed):
        before = found.get(name, _Stated())
        if (before.per_rev if per_rev else before.per_minute) is not None or (not name and name in found):
            raise value_twice(_KEY, settings)
        found[name] = replace(before, per_rev=feed) if per_rev else replace(before, per_minute=feed)
    return found


def _feed(text: str) -> tuple[float, bool] | None:
    """Return a feed, and whether it is per revolution.

    Raises ``InputError`` for one per revolution that no tool bears, as of a feed per minute that ends in MMPR.
    """
    per_rev = text.endswith(_PER_REVOLUTION)
    try:
        feed = float(text.removesuffix(_PER_REVOLUTION))
    except ValueError:
        return None
    if per_rev and feed > _MOST_PER_REVOLUTION:
        raise InputError(
            setting_problem(_KEY, Wording("ARG220", "beyond_revolution", value=text, most=_MOST_PER_REVOLUTION))
        )
    return (feed, per_rev) if _BOUNDS[0] <= feed <= _BOUNDS[1] else None


def _lacks(operation: Operation) -> bool:
    moves = operation.moves
    lacks = (moves.kind != Kind.RAPID) & ~(moves.feed > 0.0)
    return bool(lacks.any()) or any(_lacks_own(operation, event) for event in operation.events)


def _lacks_own(operation: Operation, event: Event) -> bool:
    """Whether an event is a cycle without a feed of its own; a thread wants one, other holes have that of motion."""
    if not isinstance(event, CycleOn) or {_PER_MINUTE, _PER_REVOLUTION} & {word for word, _ in event.values}:
        return False
    row = min(event.row, len(operation.moves) - 1)
    return _is_tap(event) or not (row >= 0 and operation.moves.feed[row] > 0.0)


def _fed(operation: Operation, stated: _Stated, others: _Stated) -> Operation:
    """Return an operation whose cuts and holes have the feeds that are stated of it.

    Where a tap takes its pitch, that is no feed of anything else: what else lacks one takes the one per minute, of the
    operation or of all ``others``.
    """
    if not _lacks(operation):
        return operation
    taps = any(_lacks_own(operation, each) and _is_tap(each) for each in operation.events)
    per_minute, per_rev = stated.per_minute, stated.per_rev
    if per_minute is None and taps:
        per_minute = others.per_minute
    of_cuts = (per_rev, True) if per_minute is None and not taps else (per_minute, False)
    of_taps = (per_rev, True)
    events = [
        _with_own(event, *(of_taps if _is_tap(event) else of_cuts)) if _lacks_own(operation, event) else event
        for event in operation.events
    ]
    moves, of_tap = operation.moves, np.zeros(len(operation.moves), np.bool_)
    for event in operation.events:
        if isinstance(event, CycleOn | CycleOff):
            of_tap[event.row :] = _is_tap(event)
    lacks = (moves.kind != Kind.RAPID) & ~(moves.feed > 0.0)
    for rows, (feed, unit) in ((lacks & of_tap, of_taps), (lacks & ~of_tap, of_cuts)):
        if feed is not None:
            fed, units = np.where(rows, feed, moves.feed), np.where(rows, unit, moves.per_rev)
            moves = replace(moves, feed=fed, per_rev=units)
    return replace(operation, moves=moves, events=tuple(events))


def _is_tap(event: Event) -> bool:
    return isinstance(event, CycleOn) and "TAP" in event.mode


def _with_own(event: Event, feed: float | None, per_rev: bool) -> Event:
    """Return a cycle with a feed of its own; a feed per minute of a tap would be a pitch that changes with speed."""
    if feed is None or not isinstance(event, CycleOn):
        return event
    return replace(event, values=(*event.values, (_PER_REVOLUTION if per_rev else _PER_MINUTE, (feed,))))
