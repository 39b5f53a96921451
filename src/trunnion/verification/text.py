"""A verification as lines of text for a terminal."""

from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from trunnion.messages import LIBRARY, Wording, Words, phrase
from trunnion.model.toolpath import Kind
from trunnion.verification.results import Check, Place, State, Verification, durations, moving_seconds
from trunnion.wording import format_duration

#: Places that are told of each check.
_MOST_PLACES: Final = 5


def check_lines(verification: Verification, words: Words = LIBRARY) -> Iterator[str]:
    """One line for each check; one for all of which nothing is known but what is missing."""
    alike: dict[str, list[str]] = {}
    for check in verification.checks:
        if check.state is State.NOT_CHECKED and not check.summary:
            alike.setdefault(check.told, []).append(check.key)
    for check in verification.checks:
        keys = alike.get(check.told, []) if check.state is State.NOT_CHECKED else []
        if len(keys) < 2:
            yield check.line(words)
        elif check.key == keys[0]:
            yield f"{', '.join(keys)}: {check.state.said(words)}, {check.said(words)}"


def stand_lines(asked: Sequence[Check], words: Words = LIBRARY) -> Iterator[str]:
    """One line for values that nobody has measured, and the checks that stand on them."""
    checks: dict[Wording, list[str]] = {}
    for check in asked:
        for value in check.stands_on:
            checks.setdefault(value, []).append(check.key)
    alike: dict[tuple[str, ...], list[Wording]] = {}
    for value, keys in checks.items():
        alike.setdefault(tuple(keys), []).append(value)
    for on_them, values in alike.items():
        yield f"{', '.join(on_them)}: {phrase('stands_on', values=tuple(values)).text('what', words)}"


def place_lines(verification: Verification, words: Words = LIBRARY, *, failed_only: bool = False) -> Iterator[str]:
    """Yield the worst places of each check, failed checks first: ``nc:line (N…), cl:line: text [check]``.

    Lines say where those of checks that passed, and of those that were not made, begin.
    """
    heads = {State.OK: "places_passed", State.NOT_CHECKED: "places_not_checked"}
    order = [State.FAIL, *heads]
    for check in sorted(verification.checks, key=lambda check: order.index(check.state)):
        if check.passed and failed_only:
            continue
        if check.places and check.state in heads:
            yield Wording("all", heads.pop(check.state)).text("what", words)
        for place in check.places[:_MOST_PLACES]:
            yield f"{place_line(verification.program, place, words)} [{check.key}]"


def place_line(program: str, place: Place, words: Words = LIBRARY) -> str:
    """One place, in the form that editors can jump to."""
    number = f" (N{place.number})" if place.number >= 0 else ""
    cl = f", {place.cl_file}:{place.cl_line}" if place.cl_line else ""
    return f"{place.nc_file or program}:{place.nc_line}{number}{cl}: {place.said.text('what', words)}"


def time_lines(verification: Verification, words: Words = LIBRARY) -> Iterator[str]:
    """Yield the time of the program and of each operation, if times were asked for."""
    seconds, known = durations(verification)
    if len(seconds):
        cuts = moving_seconds(verification)[verification.run.kind != Kind.RAPID]
        whole, cutting = (format_duration(float(rows.sum())) for rows in (seconds, cuts))
        unknown = int(np.count_nonzero(~known))
        line = Wording("all", "time", time=whole, cuts=cutting)
        yield (line.within("without_motions", count=unknown) if unknown else line).text("what", words)
        for operation in verification.operations:
            own = seconds[operation.first : operation.end]
            took = format_duration(float(own.sum()))
            line = Wording("all", "time_of_operation", time=took, operation=operation.name)
            yield line.text("what", words)


def failures(verification: Verification) -> list[Check]:
    """Return the checks that failed."""
    return [check for check in verification.checks if not check.passed]
