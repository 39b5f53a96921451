"""The front door of surveys: what is asked for, and how it goes through the workers."""

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final, Unpack

from trunnion.batch.local import LocalWorkers
from trunnion.controls import load_control
from trunnion.errors import InputError, Problem
from trunnion.families import FAMILIES
from trunnion.files import check_outputs
from trunnion.jobs.arguments import ReadingArguments, taken
from trunnion.jobs.inputs.arguments import check_observer, check_path
from trunnion.jobs.inputs.reading import FilePath, as_machine, stated_reading
from trunnion.jobs.observer import SILENT, Observer
from trunnion.jobs.replaced_outputs import is_result_of
from trunnion.machines import Machine, shipped_machines
from trunnion.messages import Wording
from trunnion.readers import can_read, reader_of
from trunnion.readers.program.settings import family_of
from trunnion.survey.called_files import callers
from trunnion.survey.found_files import FileKind, FoundFile, found_files
from trunnion.survey.result import Became, Survey, SurveyedMachine, Trying, surveyed, trying, worth
from trunnion.survey.trying import Step, Trial, try_in_worker

#: One shipped machine for each control: CL files are posted for them. Programs are read for all that are shipped, as a
#: program for A and C says nothing on a machine with B.
MACHINES: Final = ("yl569", "dmu65", "matsuura_mx330", "haas_umc750", "hs664rt", "xyzac_trt")

#: The code of an axis that a machine does not have.
_NO_AXIS: Final = "NC230"

#: Seconds that a file has on each machine.
TIMEOUT: Final = 60.0

#: What is tried of CL files and programs.
STEPS: Final[Mapping[FileKind, tuple[Step, ...]]] = {
    FileKind.CL: (Step.INFO, Step.POST, Step.SETTINGS),
    FileKind.PROGRAM: (Step.VERIFY, Step.KEYS),
}


class SurveyArguments(ReadingArguments, total=False):
    """Arguments of ``take_survey``."""

    machine: Sequence[FilePath]
    timeout: float | None
    workers: int | None
    written: Sequence[FilePath] | None


def take_survey(
    folder: FilePath,
    *,
    steps: Mapping[FileKind, tuple[Step, ...]] = STEPS,
    observer: Observer = SILENT,
    **given: Unpack[SurveyArguments],
) -> Survey:
    """Try each CL file and program of a folder, and count what stands in the way.

    Parameters
    ----------
    folder
        Its files and those below; links are not followed, and nothing is written there.
    steps
        What is tried of CL files, and of programs.
    observer
        Receives the progress, in files.
    machine
        Names of shipped machines, or TOML files; by default one shipped machine for each control, and for programs all.
    units
        Length unit of the CL files, ``mm`` or ``inch``, whatever they state; by default each file's own, else mm.
    dialect
        What the CL files are written in; by default what is recognized.
    strict
        Unknown CL statements are errors, even if a machine's definition says what becomes of them.
    timeout
        Seconds that a file has on each machine; by default 60.
    workers
        Processes; by default as many as there are processors.
    written
        Files that the caller writes afterwards: none of the folder, but for results of an earlier survey.

    Raises
    ------
    InputError
        When folder or machines cannot be used. A file that fails raises nothing.

    Notes
    -----
    Processes of this computer import the script that calls this: it does so behind ``if __name__ == "__main__":``.
    """
    check_observer(observer)
    found = taken(SurveyArguments, "survey", given)
    machine, timeout, workers = found["machine"], found["timeout"], found["workers"]
    root = check_path("folder", folder)
    if not root.is_dir():
        raise InputError(Problem(str(root), 0, Wording("FIL110", "no_such_folder")))
    # What an earlier survey has written there is replaced, and tells nothing of the folder.
    own = {Path(file).resolve() for file in found["written"] or () if is_result_of(Path(file), "survey")}
    there = [each for each in found_files(root) if not own or each.path.resolve() not in own]
    check_outputs(found["written"] or (), (each.path for each in there))
    others = [] if machine else [name for name in shipped_machines() if name not in MACHINES]
    asked = [_absolute(name) for name in machine or [*MACHINES, *others]]
    seconds = TIMEOUT if timeout is None else timeout
    reading = ReadingArguments(units=found["units"], dialect=found["dialect"], strict=found["strict"])
    stated_reading({}, found["strict"], cl_units=found["units"], dialect=found["dialect"])  # which refuses wrong ones
    team = _Team(tuple(zip(asked, map(as_machine, asked), strict=True)), len(others), steps, reading)
    count = max(1, workers or os.cpu_count() or 1)
    with (
        observer.progress("survey", len(there), "files") as advance,
        LocalWorkers[tuple[int, int], Trial](count, try_in_worker, seconds) as processes,
    ):
        for trials in (team.trials(there), team.other_machines(), team.keyed()):
            for (number, on), outcome in processes.run(trials):
                team.keep(number, on, trying(team.machines[on], team.files[number].kind, outcome))
                advance(team.is_now_finished(number))
        advance(team.unfinished)
    files = tuple(surveyed(file, team.tried(number)) for number, file in enumerate(team.files))
    said = {str(kind): tuple(map(str, some)) for kind, some in steps.items()}
    return Survey(root.as_posix().encode("utf-8", "replace").decode(), team.machines, seconds, said, files)


def _absolute(name: FilePath) -> str:
    text = os.fspath(name)
    return str(Path(text).absolute()) if text.endswith(".toml") else text


class _Team:
    """The machines, the files as they are found, and what became of each on each machine.

    There are three rounds: each file on the machines that are asked for, or one for each control; programs that do not
    go through on other machines, as one for A and C says nothing of a machine with B; and then, once more for each
    language, with the keys of ``[control.reading]`` under which they read best.
    """

    def __init__(
        self,
        loaded: Sequence[tuple[str, Machine]],
        others: int,
        steps: Mapping[FileKind, tuple[Step, ...]],
        reading: ReadingArguments,
    ) -> None:
        self._names, self._steps, self._reading = [name for name, _ in loaded], steps, reading
        self._languages = [_language(machine) for _, machine in loaded]
        self._definitions = [machine.control.text("extends", "") for _, machine in loaded]
        self._readers = {
            language: reader_of(machine)
            for language, (_, machine) in zip(self._languages, loaded, strict=True)
            if can_read(machine)
        }
        self.machines = tuple(
            SurveyedMachine(
                Path(name).name if name.endswith(".toml") else name,
                load_control(machine.control).name,
                posts=number < len(loaded) - others,
            )
            for number, (name, machine) in enumerate(loaded)
        )
        self.files = list[FoundFile]()
        self.tries = list[dict[int, Trying]]()
        self._expected = list[int]()
        self._finished = set[int]()

    def trials(self, files: Sequence[FoundFile]) -> Iterator[tuple[tuple[int, int], Trial]]:
        """Yield what is to be tried of each file first."""
        called = callers(files, self._readers) if self._steps[FileKind.PROGRAM] else {}
        for number, file in enumerate(files):
            if number in called:
                file = replace(file, caller=called[number].name)
            machines = [on for on in self._machines_for(file) if self.machines[on].posts]
            self.files.append(file)
            self.tries.append({})
            self._expected.append(len(machines))
            for on in machines:
                yield (number, on), self._trial(file, on)

    def other_machines(self) -> Iterator[tuple[tuple[int, int], Trial]]:
        """Yield programs that did not go through, on the other machines.

        What a control does not understand, it does not understand on another machine either.
        """
        for number, file in enumerate(self.files):
            if file.kind is FileKind.PROGRAM and not self._went_through(number):
                hopeless = {self._definitions[on] for on, found in self.tries[number].items() if _is_of_control(found)}
                for on in self._machines_for(file):
                    if not self.machines[on].posts and self._definitions[on] not in hopeless:
                        yield (number, on), self._trial(file, on)

    def keyed(self) -> Iterator[tuple[tuple[int, int], Trial]]:
        """Yield programs that are refused everywhere, on the machine of each language that reads them best."""
        for number, file in enumerate(self.files):
            steps = self._steps[file.kind] if file.kind is FileKind.PROGRAM else ()
            tries = sorted(self.tries[number].items(), key=lambda each: worth(each[1]))
            if Step.KEYS not in steps or not tries or self._went_through(number):
                continue
            if tries[0][1].became is not Became.REFUSED:
                continue
            best: dict[str, int] = {}
            for on, found in tries:
                if found.became is Became.REFUSED:
                    best.setdefault(self._languages[on], on)
            for on in best.values():
                yield (number, on), Trial(file.name, file.path, self._names[on], steps, self._reading)

    def keep(self, number: int, on: int, found: Trying) -> None:
        """Keep what became of a file on a machine: of two rounds the better."""
        before = self.tries[number].get(on)
        self.tries[number][on] = found if before is None else min(before, found, key=worth)

    def is_now_finished(self, number: int) -> bool:
        """Whether a file has just been tried where it is, and nothing more will be: others may have further rounds."""
        is_cl = self.files[number].kind is FileKind.CL
        is_last = len(self.tries[number]) == self._expected[number] and (is_cl or self._went_through(number))
        if not is_last or number in self._finished:
            return False
        self._finished.add(number)
        return True

    @property
    def unfinished(self) -> int:
        """How many files are left."""
        return len(self.files) - len(self._finished)

    def tried(self, number: int) -> list[Trying]:
        """Return what became of a file, in the order of the machines."""
        return [each for _, each in sorted(self.tries[number].items())]

    def _trial(self, file: FoundFile, on: int) -> Trial:
        steps = tuple(each for each in self._steps[file.kind] if each is not Step.KEYS)
        return Trial(file.name, file.path, self._names[on], steps, self._reading)

    def _went_through(self, number: int) -> bool:
        # A program that is read and cannot be converted is read no better elsewhere.
        return any(each.became.passed or each.step == Step.CONVERT for each in self.tries[number].values())

    def _machines_for(self, file: FoundFile) -> Iterator[int]:
        if file.kind is FileKind.OTHER or file.caller or not self._steps[file.kind]:
            return
        for on, language in enumerate(self._languages):
            is_cl, languages = file.kind is FileKind.CL, file.languages
            if self.machines[on].posts if is_cl else languages is None or language in languages:
                yield on


def _is_of_control(found: Trying) -> bool:
    """Whether a program is refused, and not for an axis that the machine does not have."""
    return found.became is Became.REFUSED and _NO_AXIS not in found.codes


def _language(machine: Machine) -> str:
    """Return the folder of the reader of a machine's programs."""
    return (FAMILIES[family_of(machine)].reader or ".none.").rsplit(".", 2)[-2]
