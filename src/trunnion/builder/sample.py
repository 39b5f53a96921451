"""A sample program of a definition: CL files posted and proven, as ``trunnion post`` does it, and what has changed.

In:     a machine, a CL file of the user's or the shipped one.
Out:    the program's lines, the answers of the proof, and what is refused, as JSON has it.
"""

import difflib
import io
import re
from collections.abc import Sequence
from importlib.resources import files
from typing import Any, Final

from trunnion.cl import read_cl
from trunnion.errors import Problem, TrunnionError
from trunnion.jobs.post.posting import post
from trunnion.jobs.post.result import ProofFailedError
from trunnion.machines import Machine, inverse
from trunnion.messages import LIBRARY, Words
from trunnion.records import dataclass
from trunnion.results import to_data
from trunnion.verification import Check
from trunnion.viewer.shown import checks_data, problem_text

#: So many lines are shown; the proof is always that of the whole program.
_MOST_LINES: Final = 20_000

#: Programs of more lines are not compared line by line: it takes the square of them.
_MOST_COMPARED: Final = 3_000

#: How a refusal ends.
_NOTHING_WRITTEN: Final = "CTL940"

#: A block number, after the block-skip sign, with a letter or, as Klartext has it, without.
_BLOCK_NUMBER: Final = re.compile(r"^(/?)[A-Z:]?[0-9]+ ")


class _NamedBytes(io.BytesIO):
    """A CL file in memory; messages say its name."""

    def __init__(self, data: bytes, name: str) -> None:
        super().__init__(data)
        self.name = name


def shipped_sample() -> bytes:
    """Return a CL file with a contour, holes, and a wall that is cut with five axes."""
    return files("trunnion.builder").joinpath("sample.cls").read_bytes()


def sample_of(machine: Machine) -> bytes:
    """Return the operations of the shipped CL file whose tool axes a machine reaches: all, with two rotary axes."""
    operations = re.split(rb"^(?=TOOL PATH/)", shipped_sample(), flags=re.MULTILINE)
    if len(machine.own_rotary) == 2:
        return b"".join(operations)
    return b"".join(text for text in operations if text and _reaches(machine, text))


def _reaches(machine: Machine, text: bytes) -> bool:
    moves = [operation.moves for operation in read_cl(_NamedBytes(text, "sample.cls")).operations]
    return all(bool(inverse(machine, each.tip, each.axis).reachable.all()) for each in moves)


@dataclass(frozen=True, slots=True)
class _Sample:
    """A sample program, what its proof says, and what differs from an earlier one.

    standing what the proof says of it
    lines    as many of ``all`` as are shown
    changed  numbers of those that are new, from 0
    removed  how many are gone
    """

    checks: Sequence[dict[str, Any]]
    problems: Sequence[dict[str, str | int]]
    passed: bool = False
    standing: str = ""
    lines: Sequence[str] = ()
    all: int = 0
    changed: Sequence[int] = ()
    removed: int = 0


def sample_data(
    machine: Machine, cl: bytes | None, name: str, before: Sequence[str], words: Words = LIBRARY
) -> dict[str, Any]:
    """Post and prove a CL file, and mark what differs from an earlier program; return it as JSON has it.

    machine  the machine
    cl       the CL file; None: what the machine reaches of the shipped one
    name     of the CL file, for messages
    before   lines of the earlier program; none: nothing is marked
    words    of who looks
    """
    try:
        result = post(_NamedBytes(sample_of(machine) if cl is None else cl, name or "sample.cls"), machine=machine)
    except ProofFailedError as error:
        return without_program(error.result.problems, error.result.checks, words)
    except TrunnionError as error:
        return without_program(error.problems, (), words)
    lines = (result.text or "").splitlines()
    changed, removed = _changes(before, lines)
    shown, checks = lines[:_MOST_LINES], checks_data(result.checks, words)
    standing = result.standing.line(words) if result.standing else ""
    found: dict[str, Any] = to_data(
        _Sample(checks, _told(result.problems, words), result.passed, standing, shown, len(lines), changed, removed)
    )
    return found


def without_program(
    problems: Sequence[Problem] = (), checks: Sequence[Check] = (), words: Words = LIBRARY
) -> dict[str, Any]:
    """Return the answer where there is no program: the CL file cannot be posted, or it fails its proof."""
    told = [each for each in problems if each.code != _NOTHING_WRITTEN]
    found: dict[str, Any] = to_data(_Sample(checks_data(checks, words), _told(told, words)))
    return found


def _told(problems: Sequence[Problem], words: Words) -> list[dict[str, str | int]]:
    """Return problems as the page lists them: how severe they are, their lines in the CL file, and what they say."""
    return [
        {
            "severity": str(each.severity),
            "line": each.line,
            "text": " ".join(filter(None, (each.argument, problem_text(each, words)))),
        }
        for each in problems
    ]


def _changes(before: Sequence[str], now: Sequence[str]) -> tuple[list[int], int]:
    """Numbers of the lines that the earlier program did not have, and how many lines of it are gone.

    Block numbers are left out of it: one more line changes all that follow.
    """
    if not before or max(len(before), len(now)) > _MOST_COMPARED:
        return [], 0
    old, new = ([_BLOCK_NUMBER.sub(r"\1", line) for line in lines] for lines in (before, now))
    found = difflib.SequenceMatcher(None, old, new, autojunk=False).get_opcodes()
    changed = [line for kind, _, _, first, end in found if kind in ("replace", "insert") for line in range(first, end)]
    removed = sum(end - first for kind, first, end, _, _ in found if kind in ("replace", "delete"))
    return changed, removed
