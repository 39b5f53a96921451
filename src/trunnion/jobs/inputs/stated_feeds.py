"""The setting ``missing_feed``: feeds of cuts and holes whose CL file states none."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.errors import InputError, setting_problem
from trunnion.jobs.inputs.stated_by_operation import check_operations, stated_by_operation
from trunnion.messages import Wording
from trunnion.model.toolpath import CycleOn, Event, Kind, Operation, Toolpath

_KEY: Final = "missing_feed"

#: What stands behind a feed per revolution, as in CL files; a feed per minute has nothing behind it.
_PER_REVOLUTION: Final = "MMPR"
_PER_MINUTE: Final = "MMPM"

#: The feeds that it takes, mm/min.
_BOUNDS: Final = (1e-3, 99_999.0)

#: The greatest that it takes per revolution, mm: metric threads have pitches up to 8, and no cutter bears more.
_MOST_PER_REVOLUTION: Final = 10.0


def with_stated_feeds(toolpaths: Iterable[Toolpath], settings: Mapping[str, str]) -> list[Toolpath]:
    """Give cuts and holes without a feed those that the setting states; one that the CL file states stays.

    Raises ``InputError`` for an operation that is not there, or that lacks no feed.
    """
    feeds, found = stated_by_operation(_KEY, settings, _feed), [*toolpaths]
    if not feeds:
        return found
    check_operations(_KEY, feeds, found)
    lacking = {each.name for path in found for each in path.operations if _lacks(each)}
    if has_all := sorted({*feeds} - {"", *lacking}):
        said = [setting_problem(_KEY, Wording("ARG230", "states_own_feeds", operation=name)) for name in has_all]
        raise InputError(said)
    return [
        replace(path, operations=tuple(_fed(each, feeds.get(each.name, feeds.get(""))) for each in path.operations))
        for path in found
    ]


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
    return "TAP" in event.mode or not (row >= 0 and operation.moves.feed[row] > 0.0)


def _fed(operation: Operation, stated: tuple[float, bool] | None) -> Operation:
    if stated is None or not _lacks(operation):
        return operation
    (feed, per_rev), moves = stated, operation.moves
    lacks = (moves.kind != Kind.RAPID) & ~(moves.feed > 0.0)
    word = _PER_REVOLUTION if per_rev else _PER_MINUTE
    events = [
        replace(event, values=(*event.values, (word, (feed,))))
        # A feed per minute would be a pitch that changes with the speed.
        if isinstance(event, CycleOn) and _lacks_own(operation, event) and (per_rev or "TAP" not in event.mode)
        else event
        for event in operation.events
    ]
    fed = replace(moves, feed=np.where(lacks, feed, moves.feed), per_rev=np.where(lacks, per_rev, moves.per_rev))
    return replace(operation, moves=fed, events=tuple(events))
