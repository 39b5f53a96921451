"""The results of a verification, as values; text, HTML and JSON are made from them elsewhere."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field, replace
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

import numpy as np

from trunnion.arrays import Flags, Floats, Lines
from trunnion.compensation.centre_runs import CentreRun
from trunnion.errors import Problem, Severity
from trunnion.machines import Machine
from trunnion.messages import LIBRARY, Wording, Words, joined, phrase
from trunnion.model.clamping import Clamping
from trunnion.model.operation_start import OperationStart
from trunnion.model.run import Run
from trunnion.records import dataclass
from trunnion.results import NOT_DATA, BlockNumber, Figure, OptionalLine, OptionalText
from trunnion.verification.block_names import block_name
from trunnion.verification.grounds import grounds_of
from trunnion.verification.standing import Standing

if TYPE_CHECKING:  # most verifications have no recording
    from trunnion.verification.recorded.compared import RecordedComparison

#: Columns that the key of a check takes in a line: those of the longest key.
_KEY_WIDTH: Final = len("compensation")


@dataclass(frozen=True, slots=True)
class Place:
    """One place of a program.

    nc_line          line of the NC file, from 1
    nc_file          the subprogram in which that line is; empty: the program itself
    row              the row of the run, as long as that is known; -1 for none
    number           block number, -1 for none
    value            what was found there, in the unit of the check
    wording          what is said of it
    cl_file, cl_line place in a CL file; line 0 for none
    code             that of the message which it is, see ``trunnion.explanations``; empty: a finding of the check
    """

    nc_line: int
    number: BlockNumber
    value: Annotated[float, Figure(after="cl_line")]
    wording: Annotated[Wording, NOT_DATA]
    cl_file: OptionalText = ""
    cl_line: OptionalLine = 0
    nc_file: Annotated[str, Figure(none="", after="nc_line")] = ""
    row: Annotated[int, NOT_DATA] = -1
    code: Annotated[str, Figure(none="", after="text")] = ""

    @property
    @Figure(after="value")
    def text(self) -> str:
        """What is said of it, in English."""
        return self.wording.what

    @property
    def said(self) -> Wording:
        """``wording`` as it is printed: with its code, if it has one."""
        return self.wording.within("with_code", code=self.code) if self.code else self.wording

    @property
    def told(self) -> str:
        """The same in English."""
        return self.said.what

    @property
    def block_name(self) -> Wording:
        """What a programmer calls the block."""
        return block_name(self.number, self.nc_line)


@dataclass(frozen=True, slots=True)
class Coverage:
    """Which motions of a program a check has looked at.

    checked   how many of the ``motions`` that there are
    left_out  the first of the others, each with why
    """

    checked: int
    motions: int
    left_out: tuple[Place, ...] = ()

    def wordings(self) -> Iterator[Wording]:
        """Yield what is said of it."""
        yield phrase("motions_checked", checked=self.checked, motions=self.motions)
        if self.left_out:
            first = self.left_out[0]
            others = self.motions - self.checked
            if others > 1:
                yield phrase("motions_left_out_more", block=first.block_name, count=others, why=first.said)
            else:
                yield phrase("motions_left_out", block=first.block_name, why=first.said)


class State(StrEnum):
    """What a check says of a program."""

    OK = "ok"
    FAIL = "FAIL"
    NOT_CHECKED = "not checked"

    def said(self, words: Words = LIBRARY) -> str:
        """Return it as it is read."""
        return Wording("all", _STATES[self]).text("what", words)


#: What is said of each state.
_STATES: Final = {State.OK: "state_ok", State.FAIL: "state_fail", State.NOT_CHECKED: "state_not_checked"}


def _texts(wordings: Sequence[Wording]) -> list[str]:
    return [wording.what for wording in wordings]


@dataclass(frozen=True, slots=True)
class Check:
    """One question about a program, and its answer.

    key       stable name, such as ``tip`` or ``travel``; each has a section in docs/checks.md
    passed    nothing wrong was found; False: the program must not run as it is. See ``state``
    answer    the answer in one line: the worst value, where it is, and what is allowed; None: there is none
    worst     the worst value in ``unit``, None where the check does not measure
    limit     what is allowed, None where there is no limit
    places    the worst places, worst first
    missing   what nobody has stated, so that the question was not answered, or only in part
    coverage  which motions it has looked at; None: it is no question of single motions
    stands_on values of the definition that the answer stands on, though nobody has measured them
    """

    key: str
    passed: Annotated[bool, NOT_DATA]
    answer: Annotated[Wording | None, NOT_DATA]
    worst: float | None = None
    limit: float | None = None
    unit: str = ""
    places: tuple[Place, ...] = ()
    missing: Annotated[tuple[Wording, ...], Figure(take=_texts, after="state")] = ()
    coverage: Coverage | None = None
    stands_on: Annotated[tuple[Wording, ...], Figure(take=_texts, after="missing")] = ()

    @property
    @Figure(after="key")
    def title(self) -> str:
        """The question in a few words."""
        return Wording(self.key, "title").what

    @property
    @Figure(after="stands_on")
    def summary(self) -> str:
        """``answer`` in English; empty if there is none."""
        return self.answer.what if self.answer else ""

    @property
    @Figure(after="title")
    def state(self) -> State:
        """``ok`` only where the whole question was answered."""
        if not self.passed:
            return State.FAIL
        return State.NOT_CHECKED if self.missing else State.OK

    @property
    def told(self) -> str:
        """``summary`` as it is printed: behind what is missing."""
        return self.said()

    def said(self, words: Words = LIBRARY) -> str:
        """Return ``told`` in the words of who asks."""
        covered = () if self.coverage is None else tuple(self.coverage.wordings())
        wordings = (*self.missing, *filter(None, (self.answer,)), *covered)
        return joined(wordings, words)

    def line(self, words: Words = LIBRARY) -> str:
        """Return the line that the command prints: key, state, summary."""
        width = len(State.FAIL.said(words))
        return f"{self.key:<{_KEY_WIDTH}}  {self.state.said(words):<{width}}  {self.said(words)}"

    def __str__(self) -> str:
        """Return ``line`` in English."""
        return self.line()


@dataclass(frozen=True, slots=True)
class OperationRows:
    """The rows ``first`` to ``end`` (exclusive) of a run that belong to one operation of a CL file.

    They include what leads to the operation: home, tool change, positioning. The last operation includes the way home,
    and so do all where it is known where the program begins them (``start``).
    """

    name: str
    tool: str
    cl_file: str
    first: int
    end: int
    start: OperationStart | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Verification:
    """The result of verifying one program.

    Columns have one row for each motion of ``run``, or no rows if they were not asked for.

    seconds   (n,)   float64   time that the row takes (``trunnion.verification.kinematics.run_time``)
    waiting   (n,)   float64   those of these seconds in which the axes wait: dwells, tool changes, the spindle
    tip_feed  (n,)   float64   speed of the tip relative to the workpiece, mm/min; NaN where its time is not known
    cl_line   (n,)   int32     line of the CL file that the row belongs to, 0 for none

    ``clamping`` is how the part is clamped, as far as somebody said it; None: nobody did.

    ``operations`` divide the rows among them; there are none without CL files. ``recorded`` compares the machine as it
    was recorded; None: it was not. ``remarks`` are the warnings that were given on the way.
    ``driven`` is the run of the tool's centre where the control compensates its radius; None: it goes as programmed.
    ``skip_levels`` has the levels of block skip (``/``) that each OPSKIP of the CL files has in the program.
    ``assumes_unit``: a CL file is taken to be in mm, which nothing says.
    ``lost_skips`` are the places, by their numbers, of those of which no block has ``/``.
    """

    program: str
    machine: Machine
    run: Run
    checks: tuple[Check, ...]
    seconds: Floats
    tip_feed: Floats
    cl_line: Lines
    operations: tuple[OperationRows, ...] = ()
    recorded: "RecordedComparison | None" = None
    waiting: Floats = field(default_factory=lambda: np.zeros(0))
    clamping: Clamping | None = None
    remarks: tuple[Problem, ...] = ()
    skip_levels: tuple[frozenset[int], ...] = ()
    lost_skips: Mapping[int, Place] = field(default_factory=dict)
    driven: CentreRun | None = None
    assumes_unit: bool = False

    @property
    def passed(self) -> bool:
        """Whether no check failed; ``standing`` says what that stands on."""
        return all(check.passed for check in self.checks)

    @property
    def standing(self) -> Standing:
        """What the word that is said of the program stands on."""
        states = [check.state for check in self.checks]
        severities = [remark.severity for remark in self.remarks]
        return Standing(
            passed=self.passed and Severity.ERROR not in severities,
            ok=states.count(State.OK),
            failed=states.count(State.FAIL),
            not_checked=states.count(State.NOT_CHECKED),
            warnings=severities.count(Severity.WARNING),
            grounds=grounds_of((self.run,), (value for check in self.checks for value in check.stands_on)),
            assumed_unit="mm" if self.assumes_unit else "",
            moves=len(self.run) > 0,
            no_cl_file=any(check.missing == (phrase("no_cl_file"),) for check in self.checks),
        )

    def __repr__(self) -> str:
        """Return what matters in a notebook: the columns would fill pages."""
        failed = ", ".join(check.key for check in self.checks if not check.passed)
        result = f"failed: {failed}" if failed else self.standing.said()
        return f"Verification(passed={self.passed}, {result}, {len(self.run)} motions)"


def durations(verification: Verification) -> tuple[Floats, Flags]:
    """Seconds of each row, (n,) float64, 0 where not known; and whether they are known, (n,) bool."""
    known = np.isfinite(verification.seconds) & (verification.seconds >= 0.0)
    known &= ~np.isnan(verification.tip_feed)  # as at rapid where an axis has no stated speed: the others tell nothing
    return np.where(known, verification.seconds, 0.0), known


def moving_seconds(verification: Verification) -> Floats:
    """Seconds of each row in which the axes move, (n,); 0 where not known."""
    seconds, _ = durations(verification)
    return np.maximum(seconds - verification.waiting, 0.0) if len(verification.waiting) else seconds


def without_columns(verification: Verification) -> Verification:
    """Return a verification as if its columns had not been asked for."""
    no_rows = np.zeros(0)
    return replace(verification, seconds=no_rows, waiting=no_rows, tip_feed=no_rows, cl_line=np.zeros(0, np.int32))


def rows_from_starts(
    run: Run, operations: Sequence[OperationRows], starts: Sequence[OperationStart]
) -> tuple[OperationRows, ...]:
    """Divide rows where the program begins its operations: what ends one is not of the next, as far as that is known.

    operations   as their CL points divide the rows
    starts       of all of them, or none
    """
    if len(starts) != len(operations):
        return tuple(operations)
    firsts = [_row_of(run, each, start) for each, start in zip(operations, starts, strict=True)]
    firsts[:1] = [each.first for each in operations[:1]]
    ends = [*firsts[1:], *(each.end for each in operations[-1:])]
    parts = zip(operations, starts, firsts, ends, strict=True)
    return tuple(replace(each, first=first, end=end, start=start) for each, start, first, end in parts)


def _row_of(run: Run, operation: OperationRows, start: OperationStart) -> int:
    """Return the first row of an operation behind its start; if there is none, the first that its points give it."""
    rows = slice(operation.first, operation.end)
    names = [Path(file).name for file in run.files]
    is_here = np.array([k == 0 if not start.file else k > 0 and name == start.file for k, name in enumerate(names)])
    found = np.flatnonzero(is_here[run.file[rows]] & (run.line[rows] >= start.line))
    return operation.first + (int(found[0]) if len(found) else 0)
