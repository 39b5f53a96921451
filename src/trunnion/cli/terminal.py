"""What a command tells on stderr while it works: warnings, decisions, checks, and a progress bar."""

import os
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import BinaryIO

from trunnion.cli.printing import tell, tell_problem
from trunnion.cli.progress import progress
from trunnion.cli.wording import in_words, part, problem_lines, said, spoken
from trunnion.errors import InputError, Problem, Severity
from trunnion.files import EarlierJob, resolve_output
from trunnion.jobs.observer import Observer
from trunnion.messages import Wording, Words
from trunnion.model.motion import Plan
from trunnion.model.toolpath import Toolpath
from trunnion.verification import Verification, check_lines, place_lines, stand_lines, time_lines

#: Warnings about a program that is converted which are printed one by one.
_MOST_PRINTED = 20


class Terminal(Observer):
    """Prints what happens while a program is posted.

    explain   print the decisions of the planner
    recorded  the planner records its decisions
    """

    def __init__(self, *, explain: bool = False, recorded: bool = False) -> None:
        self._explain, self._recorded = explain, recorded
        self._explained = False
        self._untold: list[str] = []

    @property
    def words(self) -> Words:  # type: ignore[override]
        """The language of the command, and its options."""
        return spoken()

    def setup(self, name: str) -> None:
        """Print whose set-up the next lines are about, where there are several."""
        if name:
            tell(said("setup", name=name))

    def read(self, toolpaths: Sequence[Toolpath]) -> None:
        """Say as what the toolpaths of a file or an archive were read, where one is more than NX's CLSF in mm."""
        for toolpath in toolpaths:
            units = "mm" if toolpath.unit == 1.0 else "inch"
            shown = units if toolpath.states_unit else part("units_not_stated", units=units)
            line = f"{toolpath.file}: {said('read_as', dialect=toolpath.recognized_by, units=shown)}"
            if toolpath.dialect != "clsf" or shown != "mm" or len(toolpaths) > 1:
                tell(line)
            else:
                self._untold.append(line)

    def problems(self, problems: Sequence[Problem]) -> None:
        """Print problems, one a line; of a flood of errors the first of each kind."""
        for line in problem_lines(problems):
            tell_problem(line)

    def planned(self, plan: Plan) -> None:
        """Print the decisions of the planner."""
        self._explained = self._recorded and bool(plan.decisions)
        if self._explain:
            tell(*(f"{each.file}:{each.line}: {each.operation}: {in_words(each.said)}" for each in plan.decisions))

    def verified(self, verification: Verification) -> None:
        """Print one line a check, the places of failed checks, and times; before them what was read in mm, where the
        program counts in inches.
        """
        if self._untold and bool(verification.run.inches.any()):
            tell(*self._untold)
        self._untold = []
        tell(*verification_lines(verification, failed_only=True))
        if not self._explained and _exceeds_rotary_speed(verification):
            tell(f"{verification.program}: {said('rotary_axis_behind')}")

    def progress(self, stage: str, total: int, unit: str) -> AbstractContextManager[Callable[[int], None]]:
        """Show a progress bar."""
        return progress(stage, total, unit)


def verification_lines(verification: Verification, *, failed_only: bool = False) -> Iterator[str]:
    """Yield one line a check, the worst places, times, and what the answer stands on."""
    words = spoken()
    yield from check_lines(verification, words)
    yield from place_lines(verification, words, failed_only=failed_only)
    yield from time_lines(verification, words)
    yield from stand_lines(verification.checks, words)
    yield verification.standing.line(words)


class ConversionTerminal(Terminal):
    """Prints what happens while a program is converted: of long lists of warnings about it only the first."""

    def __init__(self) -> None:
        super().__init__()
        self._is_planned = False

    def problems(self, problems: Sequence[Problem]) -> None:
        """Print problems, one a line."""
        most = len(problems) if self._is_planned else _MOST_PRINTED
        super().problems(problems[:most])
        if len(problems) > most:
            tell(said("and_more", count=len(problems) - most))

    def planned(self, plan: Plan) -> None:
        """From here on warnings are about the plan."""
        self._is_planned = True
        super().planned(plan)


def output_place(output: str) -> str | BinaryIO:
    """Where a result goes: a file, or stdout for ``-``."""
    if output != "-":
        return output
    sys.stdout.flush()
    return sys.stdout.buffer


def warn_of_old(names: Iterable[str]) -> None:
    """Say of programs and papers that are there that they are not those of a post that has just failed."""
    old = [name for name in names if name != "-" and Path(name).is_file()]
    if old:
        tell(f"{', '.join(old)}: {Severity.WARNING.said(spoken())}: {said('from_before')}")


def check_unnamed(target: str, *, alone: bool = True) -> None:
    """Refuse a default name that is one of somebody else's file.

    target  the file
    alone   there are no others, so that it can be named as the output

    Raises ``InputError`` if it would be replaced, although nobody has named it.
    """
    place = resolve_output(target)
    if place.is_stream or not place.path.exists():
        return
    earlier = EarlierJob(place.path)
    if earlier.wrote(place.path) or earlier.has_edited(place.path):  # of edited ones the job decides
        return
    raise InputError(
        Problem(
            target,
            0,
            Wording("FIL250", "not_as_written", target=target)
            if alone
            else Wording("FIL250", "not_as_written_among_others"),
        )
    )


def output_folder(output: str | None) -> Path | None:
    """Return the folder that takes results under the names of what they are made from; None: the output is one file.

    Raises ``InputError`` if it is written as a folder, and there is none.
    """
    if output is None:
        return Path()
    if output not in ("", "-") and Path(output).is_dir():
        return Path(output)
    if output.endswith(("/", os.sep)):
        raise InputError(Problem(output, 0, Wording("FIL220", "no_folder_for_results")))
    return None


def _exceeds_rotary_speed(verification: Verification) -> bool:
    """Whether a rotary axis would have to be faster than it can."""
    names = {axis.name for axis in verification.machine.own_axes if axis.is_rotary}
    speeds = (check for check in verification.checks if check.key == "speed")
    return any(place.wording.parameter("axis") in names for check in speeds for place in check.places)
