"""The files of an impeller that is machined: their names, and whether they may be written, before any work.

In:     the folder, the definition and what is to be made of it.
Out:    ``ImpellerFiles``.
"""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

from trunnion.controls.definition import SubprogramNaming
from trunnion.errors import InputError, Problem, argument_problem
from trunnion.files import EarlierJob, OutputFiles, once_in_place, resolve_output
from trunnion.files.places import cannot_write
from trunnion.impeller.impeller import Impeller
from trunnion.impeller.machining import operation_names
from trunnion.impeller.steps import MachiningStep, file_stem
from trunnion.jobs.inputs.arguments import check_path
from trunnion.messages import Wording
from trunnion.output.subprograms import SubprogramNames
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True)
class ImpellerFiles:
    """Files in a folder, by the name of the impeller and that of its steps."""

    folder: Path
    stem: str
    extension: str

    @property
    def program(self) -> Path:
        """The main program."""
        return self.folder / f"{self.stem}{self.extension}"

    @property
    def report(self) -> Path:
        """Of the proof."""
        return self.folder / f"{self.stem}.html"

    @property
    def simulation(self) -> Path:
        """The report of the simulation."""
        return self.folder / f"{self.stem}_simulation.html"

    @property
    def picture(self) -> Path:
        """What the simulation leaves of the stock."""
        return self.folder / f"{self.stem}_stock.png"

    def cl_file(self, step: MachiningStep) -> Path:
        """Return the CL file of a step."""
        return self.folder / f"{self.stem}_{file_stem(step.name)}.cls"

    def check_own(self) -> None:
        """Raise ``InputError`` if main program or report, whose names nobody chose, is somebody else's file."""
        problems = []
        for file in (self.program, self.report):
            place = resolve_output(file)
            if place.path.exists() and not EarlierJob(place.path).wrote(place.path):
                problems.append(Problem(place.name, 0, Wording("IMP410", "not_as_written_by_cut")))
        if problems:
            raise InputError(problems)

    def remember_report(self) -> None:
        """Record that the report, if there is one, is this cut's."""
        once_in_place(self._remember_report)

    def _remember_report(self) -> None:
        place = resolve_output(self.report)
        if place.path.exists():
            EarlierJob(place.path).remember([place.path])

    def check_others(
        self, files: OutputFiles, steps: Sequence[MachiningStep], impeller: Impeller, naming: SubprogramNaming | None,
        *, simulated: bool,
    ) -> None:  # fmt: skip
        """Find out whether all files beside the main program may be written; ``naming`` is that of subprograms, if any.

        Raises ``InputError`` with all of those that may not.
        """
        names = [self.cl_file(step).name for step in steps]
        names += [self.simulation.name, self.picture.name] if simulated else []
        if naming is not None and naming.first_number is None:
            given = SubprogramNames(naming, self.stem)
            operations = [name for step in steps for name in operation_names(impeller, step)]
            names += [naming.prefix + given.unique(name) + naming.extension for name in operations]
        problems: list[Problem] = []
        for name in names:
            try:
                files.check_file(name)
            except InputError as error:
                problems += error.problems
        if problems:
            raise InputError(problems)


@contextmanager
def output_folder(output: object) -> Iterator[Path]:
    """Yield the folder of the files, made if there is none; one that is made and stays empty is removed.

    Raises ``InputError`` if there cannot be a folder.
    """
    folder = check_path("output", output)
    if str(folder) == "-":
        raise InputError(argument_problem("output", Wording("IMP410", "several_files_to_stdout")))
    made = list(_missing([folder, *folder.parents]))
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise cannot_write(str(folder), error) from None
    try:
        yield folder
    finally:
        with suppress(OSError):  # it is not empty
            for each in made:
                each.rmdir()


def _missing(folders: Iterable[Path]) -> Iterator[Path]:
    """Those that do not exist, up to the first that does."""
    for folder in folders:
        if folder.exists():
            return
        yield folder
