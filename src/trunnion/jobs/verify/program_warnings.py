"""Warnings of what was found of a program and every user should know, although it proves nothing wrong.

In:     a program that was run, and the words that the definition of its control states as its own; its proof.
Out:    a warning for each word of the machine's builder that the definition does not declare, where it stands first,
        for each block at which the program waits or stops, or passes the end of a turn by a way that no source
        confirms, for each word that is known and not simulated (M118), and for each mode and each work offset
        that it leaves to the next program; one for positions that count from a place of the machine's builder (M92);
        and one for the axis whose rapid speed is far too low for its feeds.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from typing import Final

from trunnion.controls import Control
from trunnion.errors import Problem, Severity, warning
from trunnion.messages import Wording
from trunnion.model.run import Diagnostic, Run
from trunnion.verification import Verification

_OF_BUILDER: Final = "NC225"
_WAITS: Final = "NC226"
_END_OF_TURN: Final = "NC342"
_LEFT_ON: Final = "NC351"

#: Kinds of which a program has few, told as they were noted.
_FEW: Final = ("NC114", "NC161", "NC228")

#: Warnings of a kind that are told one by one; a program with more words is hardly one for this machine.
_MOST_TOLD: Final = 20

#: Where an axis needs more of its rapid speed than this, the tool goes at less than two thirds of its feed.
_SLOWS: Final = 1.5

#: Words that are known and not simulated; radius compensation, which the checks judge, has the same code.
_NOT_SIMULATED: Final = ("NC221", "not_simulated")

#: Positions that count from a place which only the machine knows: the first block of each is told.
_PLACES_OF_BUILDER: Final = ("m92_counts_set_machine_taken", "second_reference")

_KINDS: Final = (_OF_BUILDER, _WAITS, _END_OF_TURN, _LEFT_ON)


def stated_words(control: Control, settings: Mapping[str, str]) -> frozenset[str]:
    """Return the words that a definition states for coolant, and in settings such as that of rigid tapping."""
    return frozenset((*(f"M{number}" for number in control.coolant.values()), *settings.values()))


def program_warnings(run: Run, stated: frozenset[str] = frozenset()) -> list[Problem]:
    """Return the warnings of a program, but for words that are stated."""
    told: list[Problem] = []
    for code in _KINDS:
        told += _of_kind(run, code, [each for each in run.diagnostics if _is_told(each, code, stated)])
    told += [_told(each, each.wording) for code in _FEW for each in run.diagnostics if _is_told(each, code, stated)]
    noted = (each for each in run.diagnostics if (each.code, each.wording.variant) == _NOT_SIMULATED)
    return told + [_told(each, each.wording) for each in (*noted, *_places_of_builder(run))]


def _places_of_builder(run: Run) -> Iterator[Diagnostic]:
    for variant in _PLACES_OF_BUILDER:
        yield from islice((each for each in run.diagnostics if each.wording.variant == variant), 1)


def speed_warnings(found: Verification) -> list[Problem]:
    """Return the warning of the axis that the feeds ask for most, if it cannot follow them."""
    check = next((each for each in found.checks if each.key == "speed"), None)
    if check is None or not check.places or check.worst is None or check.worst <= _SLOWS:
        return []
    first = check.places[0]
    wording = Wording("NC390", "too_slow_for_feed", fault=first.wording, block=first.block_name)
    return [warning(first.nc_file or found.run.files[0], first.nc_line, wording)]


def _is_told(noted: Diagnostic, code: str, stated: frozenset[str]) -> bool:
    if noted.code != code or noted.severity is not Severity.WARNING:
        return False
    return code != _OF_BUILDER or noted.wording.parameter("word") not in stated


def _of_kind(run: Run, code: str, noted: Sequence[Diagnostic]) -> list[Problem]:
    """Return the first warnings of a kind one by one, and the others together."""
    told = [_told(each, Wording(code, "noted", noted=each.wording)) for each in noted[:_MOST_TOLD]]
    if more := len(noted) - len(told):
        line = noted[_MOST_TOLD].line
        told.append(warning(run.files[0], line, Wording(code, "more_noted", count=more)))
    return told


def _told(noted: Diagnostic, wording: Wording) -> Problem:
    return warning(noted.file, noted.line, wording)
