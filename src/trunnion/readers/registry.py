"""Running a program with the reader of a machine's control."""

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

from trunnion.errors import InputError, Problem, Severity
from trunnion.families import FAMILIES, load_reader
from trunnion.files import WriteProgress
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.diagnostics import Diagnostic
from trunnion.model.run import Run, SkippedRun
from trunnion.model.skip_switches import skip_combinations
from trunnion.readers.control.setup_recorder import lengths_of_other_tools
from trunnion.readers.program.coolant_words import check_coolant_words
from trunnion.readers.program.family_reader import FamilyReader
from trunnion.readers.program.known_words import check_known_words, plain_code
from trunnion.readers.program.options import DEFAULT_OPTIONS, RunOptions
from trunnion.readers.program.settings import UNKNOWN, encoding_of, family_of, reading_of
from trunnion.readers.program.stated_words import unread_words


def run_program(
    path: Path | str,
    machine: Machine,
    options: RunOptions = DEFAULT_OPTIONS,
    *,
    family: str | None = None,
    write_progress: WriteProgress | None = None,
) -> Run:
    """Read a program and run it on a machine.

    path            the program
    machine         three linear axes X, Y and Z, and two rotary axes. A tool without a length
                    has the length 0, which puts the tip where the control assumes it
    options         how it is run
    family          the family of controls whose language the program has, a key of ``FAMILIES``; None for the machine's
                    control
    write_progress  the progress of the program's file if it is still being written: the program runs as far as it is
                    there, and waits for the rest. None for a complete file. The result is the same

    A program with blocks that may be skipped is run again for each combination of switches (``Run.skipped``).

    Raises ``InputError`` if a file cannot be read, does not end, is nested wrongly or too deeply, or if there is no
    reader for the control. Words that are not understood are in ``Run.diagnostics``.
    """
    reader = reader_of(machine, family)
    check_reading(machine)
    stated = encoding_of(machine) if options.encoding is None else options.encoding
    options = replace(options, encoding=stated)
    language = FAMILIES[family_of(machine) if family is None else family].reader or ""

    def read(how: RunOptions) -> Run:
        run = reader.interpreter(Path(path), machine, how).run(None if how.skip else write_progress)
        if reader.uses_length_numbers:
            run = replace(run, diagnostics=(*run.diagnostics, *lengths_of_other_tools(run, machine)))
        return replace(
            run,
            language=language,
            encoding=stated,
            uses_length_numbers=reader.uses_length_numbers,
            work_offset_name=reader.work_offsets.name,
        )

    run = read(options)
    meanings = [] if options.skip else skip_combinations(_skip_levels(run))
    if meanings and write_progress is not None:
        write_progress.wait_until_finished()
    skipped = tuple(SkippedRun(levels, read(replace(options, skip=levels))) for levels in meanings)
    unread = unread_words((run, *(each.run for each in skipped)), machine)
    return replace(run, skipped=skipped, diagnostics=(*run.diagnostics, *unread))


def _skip_levels(run: Run) -> set[int]:
    """Return the levels of the blocks that may be skipped."""
    values = (event.value for event in run.events if event.kind == "block_skip")
    return {int(value) for value in values if isinstance(value, int | float)}


@lru_cache(maxsize=8)
def reader_of(machine: Machine, family: str | None = None) -> FamilyReader:
    """Return the reader of a family, by default that of the machine's control.

    Raises ``InputError`` if there is no reader for its programs yet.
    """
    name = family_of(machine) if family is None else family
    if not _has_reader(name):
        others = tuple(filter(_has_reader, FAMILIES))
        raise InputError(Problem(machine.key, 0, Wording("NC120", "no_reader", family=name, others=others)))
    reader: FamilyReader = load_reader(name)
    if reader.offsets_of is not None:
        reader = replace(reader, work_offsets=reader.offsets_of(machine))
    if reader.words_of is not None:
        reader = replace(reader, words_without_path=reader.words_of(machine))
    return reader


@lru_cache(maxsize=8)
def check_reading(machine: Machine) -> None:
    """Check what the definition of a machine's control says to readers: ``[control.known]``,
    ``[control.reading]``, and the M codes of ``[control.coolant]``.

    Raises ``InputError`` with every mistake, each at its file and line.
    """
    if not can_read(machine):
        return
    reader = reader_of(machine)
    own = {plain_code(key.upper()): means for key, means in reading_of(machine).table("words").to_dict().items()}

    def is_own_word(word: str) -> bool:
        first = word.partition(" ")[0]
        return own[first] != UNKNOWN if first in own else reader.is_own_word(word)

    problems: list[Problem] = []
    checks: tuple[Callable[[], object], ...] = (
        lambda: check_known_words(machine, is_own_word),
        lambda: check_coolant_words(machine, is_own_word, reader.coolants),
        lambda: reader.check_reading(machine),
    )
    for check in checks:
        try:
            check()
        except InputError as error:
            problems += [problem for problem in error.problems if problem not in problems]
    if problems:
        raise InputError(problems)


def role_of(program: Path, machine: Machine) -> Wording | None:
    """Return that a program looks like a subprogram of others; None: it runs by itself."""
    words = reader_of(machine).call_words
    mark = None if words is None else words.mark_of(program)
    return None if mark is None else Wording("NC114", "is_subprogram", word=mark[0], line=mark[1])


def with_role(run: Run, program: Path, machine: Machine) -> Run:
    """Return a run that says first that its program looks like a subprogram of others, if it does."""
    told = role_of(program, machine)
    if told is None:
        return run
    return replace(run, diagnostics=(Diagnostic(1, told, Severity.WARNING, run.files[0]), *run.diagnostics))


def can_read(machine: Machine) -> bool:
    """Whether there is a reader for the programs of a machine."""
    return _has_reader(family_of(machine))


def _has_reader(family: str) -> bool:
    return family in FAMILIES and FAMILIES[family].reader is not None
