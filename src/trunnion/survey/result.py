"""What came of a survey, and its counts: rates by dialect and control, and the codes that block most files."""

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from enum import StrEnum
from functools import cached_property
from typing import Annotated, ClassVar, Final

from trunnion.batch.worker_task import Outcome, Status
from trunnion.errors import Problem, Severity
from trunnion.messages import Wording
from trunnion.records import dataclass
from trunnion.results import Figure, OptionalText
from trunnion.survey.found_files import FileKind, FoundFile
from trunnion.survey.trying import KEYS, SETTINGS, STEP, Step


class Became(StrEnum):
    """What became of a file on a machine, the best first.

    PROVEN        posted, and the program proven
    PROVEN_WARNED  the same, with warnings
    PROVEN_FILLED  refused as it is; proven with stand-ins for the settings that its errors ask for
    READ          a program: read and run, and no check of it alone fails
    READ_WARNED   the same, with warnings
    READ_KEYED    refused as it is; read and run with the keys of ``[control.reading]`` under which it reads best
    CALLED        a subprogram, read through a program beside it that calls it
    BEYOND        understood, and nothing is wrong but that this machine cannot go so far, or turn its spindle so fast
    CHECK_FAILED  a program: read and run, and a check of it fails
    PROOF_FAILED  posted, and the program does not do what the CL file says: it is not written
    REFUSED       not understood, or it must not run
    TIMED_OUT     it took longer than it may
    NOT_TRIED     a link, too large, or the computer did not let it be read
    BROKEN        an error of Trunnion
    NOT_OURS      neither a CL file nor a program of a control that is read
    """

    PROVEN = "proven"
    PROVEN_WARNED = "proven with warnings"
    PROVEN_FILLED = "proven with settings"
    READ = "read"
    READ_WARNED = "read with warnings"
    READ_KEYED = "read with keys"
    CALLED = "called by another"
    BEYOND = "beyond the machine"
    CHECK_FAILED = "check failed"
    PROOF_FAILED = "proof failed"
    REFUSED = "refused"
    TIMED_OUT = "timed out"
    NOT_TRIED = "not tried"
    BROKEN = "error of Trunnion"
    NOT_OURS = "not ours"

    @property
    def passed(self) -> bool:
        """Whether it went through."""
        return self in _PASSED

    @property
    def is_blocked(self) -> bool:
        """Whether codes say why it did not go through."""
        return self in _BLOCKED


_PASSED: Final = frozenset({Became.PROVEN, Became.PROVEN_WARNED, Became.READ, Became.READ_WARNED})
_BLOCKED: Final = frozenset(
    {
        Became.PROVEN_FILLED, Became.READ_KEYED, Became.BEYOND, Became.CHECK_FAILED, Became.PROOF_FAILED,
        Became.REFUSED, Became.BROKEN,
    }
)  # fmt: skip

#: The check that fails where something is not understood.
_WORDS: Final = "words"

#: Codes that only say what follows from the errors before them.
_SEQUELS: Final = frozenset({"CNV130", "CTL940", "PLN160"})

#: Checks and codes of travel and of the spindle's speed.
_OF_MACHINE: Final = frozenset({"travel", "rpm", "PLN120", "PLN125", "PLN430"})

#: Statements that belong to turning.
_TURNING: Final = frozenset(("CL260", each) for each in ("turning", "toolno_belongs_turning", "mode_turn_turning"))

#: The code of a program of which more is not understood than understood.
_OTHER_CONTROL: Final = "NC113"

#: From the best to the worst.
_ORDER: Final = {each: rank for rank, each in enumerate(Became)}


def _text_or_none(said: Wording) -> str | None:
    """Return a text as data; null where nothing is said."""
    return str(said) or None


@dataclass(frozen=True, slots=True)
class SurveyedMachine:
    """A machine of the survey.

    machine  name of its definition
    control  name of its control
    posts    whether CL files were posted for it; for others, programs were read
    """

    machine: str
    control: str
    posts: bool = True


@dataclass(frozen=True, slots=True)
class Trying:
    """What became of a file on one machine.

    became    what became of it
    step      the step that failed, or the last one; null where none was begun
    codes     of all errors, each once; of a failed check its name
    errors    the first one of each code
    warnings  how many there are
    count     how many errors there are
    keys      keys of ``[control.reading]`` with which a program was read
    """

    machine: str
    control: str
    became: Became
    step: OptionalText
    codes: tuple[str, ...]
    errors: tuple[Problem, ...]
    warnings: int
    count: Annotated[int, Figure("error_count")]
    keys: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class SurveyedFile:
    """A file of the folder.

    file    its name from the folder on
    kind    ``CL file``, ``program`` or ``other``
    looks_said  dialect of a CL file; what another one looks like, or why it was not tried; null: it says too little
    became  on the machine where the least became of it
    tries   a CL file on each machine; a program on the machine that reads it best
    """

    file: str
    kind: FileKind
    looks_said: Annotated[Wording, Figure("looks", take=_text_or_none)]
    became: Became
    tries: tuple[Trying, ...] = ()

    @property
    def looks(self) -> str:
        """What it looks like, in English."""
        return str(self.looks_said)

    @property
    def passes(self) -> int:
        """On how many machines it went through."""
        return sum(each.became.passed for each in self.tries)


@dataclass(frozen=True, slots=True)
class Rate:
    """How files of one dialect or likeness fare on one control.

    files   how many were tried
    passed  how many went through
    became  how many became what
    """

    kind: FileKind
    looks_said: Annotated[Wording, Figure("looks", take=_text_or_none)]
    control: str
    files: int
    passed: int
    became: Mapping[str, int]

    @property
    def looks(self) -> str:
        """What these files look like, in English."""
        return str(self.looks_said)


@dataclass(frozen=True, slots=True)
class Blocker:
    """A code that keeps files from going through.

    files  how many files have it
    opens  of these, files whose only errors have it; others may lie behind them
    first  the first of them
    """

    code: str
    files: int
    opens: int
    first: Problem

    @property
    def cure_said(self) -> Wording | None:
        """Where it is said how to correct the first one, if that does not say it itself."""
        return None if self.first.cure else Wording("survey", "explained", code=self.code)

    @property
    def cure(self) -> str:
        """How to correct the first one, or where that is said."""
        return self.first.cure or str(self.cure_said)


@dataclass(frozen=True)
class Survey:
    """What Trunnion makes of the files of a folder.

    folder    as it was named
    machines  on which it was tried
    timeout   seconds that a file had on each machine
    steps     what was tried of CL files and programs
    files     in the order of their names
    """

    SCHEMA: ClassVar[int] = 1

    folder: str
    machines: tuple[SurveyedMachine, ...]
    timeout: Annotated[float, Figure(unit="s")]
    steps: Mapping[str, tuple[str, ...]]
    files: tuple[SurveyedFile, ...]

    @cached_property
    def counts(self) -> dict[Became, int]:
        """How many files became what, on the machine where the least became of each."""
        return _counts(each.became for each in self.files)

    @property
    @Figure("counts", after="steps")
    def _counts_by_name(self) -> dict[str, int]:
        """How many files became what, on the machine where the least became of each."""
        return {str(each): count for each, count in self.counts.items()}

    @property
    @Figure(after="counts")
    def rates(self) -> tuple[Rate, ...]:
        """How files fare, by dialect or likeness, and control."""
        groups: dict[tuple[FileKind, Wording, str], list[Became]] = {}
        for file in self.files:
            for each in file.tries:
                groups.setdefault((file.kind, file.looks_said, each.control), []).append(each.became)
        return tuple(
            Rate(*key, len(found), sum(each.passed for each in found), {str(k): n for k, n in _counts(found).items()})
            for key, found in sorted(groups.items(), key=lambda group: tuple(map(str, group[0])))
        )

    @property
    @Figure(after="rates")
    def blockers(self) -> tuple[Blocker, ...]:
        """Codes that keep files from going through, those of most files first."""
        firsts: dict[str, Problem] = {}
        files, opens = Counter[str](), Counter[str]()
        for file in self.files:
            missed = [each for each in file.tries if not each.became.passed]
            codes = {code for each in missed if each.became.is_blocked for code in each.codes}
            files.update(codes)
            if len(codes) == 1 and all(each.became.is_blocked for each in missed):
                opens.update(codes)
            for each in missed:
                for problem in each.errors if each.became.is_blocked else ():
                    firsts.setdefault(problem.code, problem)
        known = {code: firsts[code] for code in files if code in firsts}
        order = sorted(known, key=lambda code: (-files[code], -opens[code], code))
        return tuple(Blocker(code, files[code], opens[code], known[code]) for code in order)


def _counts(found: "Iterator[Became] | Sequence[Became]") -> dict[Became, int]:
    counts = Counter(found)
    return {each: counts[each] for each in Became if counts[each]}


def count_errors(outcome: Outcome) -> int:
    """How many errors there are."""
    return sum((outcome.figures.get("error_codes") or {}).values())


def trying(machine: SurveyedMachine, kind: FileKind, outcome: Outcome) -> Trying:
    """Return what became of a file on a machine."""
    errors = [each for each in outcome.problems if each.severity is Severity.ERROR]
    became = _BECAME[outcome.status](kind, outcome)
    codes = _codes(outcome, errors)
    if became in (Became.REFUSED, Became.CHECK_FAILED) and codes and _OF_MACHINE.issuperset(codes):
        became = Became.BEYOND
    firsts = {each.code: each for each in reversed(errors)}
    told = tuple(firsts[code] for code in codes if code in firsts)
    step = str(outcome.figures.get(STEP, ""))
    keys = tuple(outcome.figures.get(KEYS, ()))
    return Trying(
        machine.machine, machine.control, became, step, codes, told, outcome.warnings, count_errors(outcome), keys
    )


def _codes(outcome: Outcome, errors: Sequence[Problem]) -> tuple[str, ...]:
    """Return the codes of all errors but sequels; checks that fail only where no other error is behind them."""
    codes = outcome.figures.get("error_codes") or [each.code for each in errors]
    failed = outcome.figures.get("failed_checks") or ()
    return tuple(dict.fromkeys(code for code in codes if code not in {*failed, *_SEQUELS})) or tuple(failed)


def _passed(kind: FileKind, outcome: Outcome) -> Became:
    if kind is FileKind.CL and SETTINGS in outcome.figures:
        return Became.PROVEN_FILLED
    if kind is FileKind.CL:
        return Became.PROVEN_WARNED if outcome.warnings else Became.PROVEN
    if KEYS in outcome.figures:
        return Became.READ_KEYED
    return Became.READ_WARNED if outcome.warnings else Became.READ


def _failed(kind: FileKind, outcome: Outcome) -> Became:
    failed = outcome.figures.get("failed_checks") or ()
    is_read = kind is FileKind.PROGRAM and outcome.figures.get(STEP) == Step.VERIFY
    if not failed or (is_read and _WORDS in failed):
        return Became.REFUSED
    return Became.CHECK_FAILED if is_read else Became.PROOF_FAILED


_BECAME: Final[Mapping[Status, Callable[[FileKind, Outcome], Became]]] = {
    Status.PASSED: _passed,
    Status.FAILED: _failed,
    Status.UNUSABLE: lambda kind, outcome: Became.REFUSED,
    Status.HINDERED: lambda kind, outcome: Became.NOT_TRIED,
    Status.BROKEN: lambda kind, outcome: Became.BROKEN,
    Status.DIED: lambda kind, outcome: Became.BROKEN,
    Status.TIMED_OUT: lambda kind, outcome: Became.TIMED_OUT,
}


def surveyed(file: FoundFile, tries: Sequence[Trying]) -> SurveyedFile:
    """Return what became of a file: of a CL file each try counts, of a program the best."""
    if file.caller:
        return SurveyedFile(file.name, file.kind, Wording("survey", "subprogram", caller=file.caller), Became.CALLED)
    if not tries:
        is_other = file.is_tried and file.kind is FileKind.OTHER
        became = Became.NOT_OURS if is_other else Became.NOT_TRIED
        return SurveyedFile(file.name, file.kind, file.looks_said, became)
    counted = tuple(tries) if file.kind is FileKind.CL else (min(tries, key=worth),)
    if not file.looks and _OTHER_CONTROL in counted[0].codes:
        return SurveyedFile(file.name, FileKind.OTHER, Wording("survey", "not_understood"), Became.NOT_OURS)
    if file.kind is FileKind.CL and all(map(_is_of_turning, counted)):
        return SurveyedFile(file.name, FileKind.OTHER, Wording("survey", "turning"), Became.NOT_OURS)
    return SurveyedFile(
        file.name, file.kind, file.looks_said, max((t.became for t in counted), key=_ORDER.__getitem__), counted
    )


def _is_of_turning(found: Trying) -> bool:
    return any((each.code, each.wording.variant) in _TURNING for each in found.errors)


def worth(each: Trying) -> tuple[int, bool, int]:
    """Return what became of a file on a machine as something that is the smaller the better."""
    return _ORDER[each.became], each.step != Step.CONVERT, each.count
