"""Writing a program to its file, and reading it back meanwhile.

In:     a planned program.
Out:    its file, and the run of what is on the disk.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import BinaryIO

from trunnion import readers
from trunnion.errors import InputError
from trunnion.files import OutputFiles, WriteProgress
from trunnion.jobs.observer import SILENT, Observer
from trunnion.jobs.post.inserts import mode_problems
from trunnion.jobs.post.stages import PlannedProgram, Posting, WrittenProgram
from trunnion.machines import Machine
from trunnion.model.operation_start import OperationStart
from trunnion.model.run import Run
from trunnion.model.template_passage import TemplatePassage
from trunnion.output.changed_words import changers
from trunnion.output.program import Program
from trunnion.output.program_writer import write_program
from trunnion.output.subprograms import SubprogramOutput
from trunnion.verification import Check, Verification


def write_and_read_back(posting: Posting, plan: Callable[[], PlannedProgram]) -> WrittenProgram:
    """Plan a program, write it and read it back; the reader gets ready during the plan and follows the writer.

    Raises ``InputError`` if its reader cannot follow it.
    """
    files, job, divided = posting.target.files, posting.job, posting.subprograms is not None
    reading = read_back_while_writing(files, job.machine, encoding=job.encoding, divided=divided, beside=job.beside)
    with reading as (progress, running):
        planned = plan()
        posting.places.changers.update(changers(planned.program.motions))
        passages = posting.places.passages
        starts = write(planned.program, files.main, progress, posting.subprograms, posting.observer, passages)
        if problems := mode_problems(planned.program, passages):
            raise InputError(problems)
    with posting.places.told():
        return WrittenProgram(planned, starts, running.result())


@contextmanager
def read_back_while_writing(
    files: OutputFiles, machine: Machine, *, encoding: str, divided: bool, beside: Sequence[Path] = ()
) -> Iterator[tuple[WriteProgress, Future[Run | None]]]:
    """Run a program while its file is being written; the reader is set up while the program is planned.

    Reading afterwards lengthens the post of a million points by a seventh (2.60 to 2.96 s on the machine where this was
    measured). The run is that of the bytes in the file, as if it had begun when the file was complete.

    files     where the program is written
    machine   runs it
    encoding  of its texts
    divided   the program calls subprograms: the run waits for all files, as calls stand before what they call
    beside    files of subprograms that exist already and that its templates call

    progress  receives how much of the file can be read
    run       complete soon after the block has ended; None: no reader knows the control
    """
    progress = WriteProgress()
    with ThreadPoolExecutor(1) as executor:
        # Without a word the reader would wait forever: an interruption of the first one leaves the second.
        try:
            run = executor.submit(_run, files, machine, encoding, progress, divided or bool(beside), beside)
            yield progress, run
            files.start_sync()
            progress.finish()
        except BaseException:
            progress.stop()
            raise
        finally:
            progress.finish()


def _run(
    files: OutputFiles,
    machine: Machine,
    encoding: str,
    progress: WriteProgress,
    waits: bool,
    beside: Sequence[Path],
) -> Run | None:
    if not readers.can_read(machine):
        return None
    if waits:
        progress.wait_until_finished()
    others = [*files.other_paths, *beside]
    return readers.run_program(
        files.path, machine, readers.RunOptions(subprograms=others, encoding=encoding), write_progress=progress
    )


def write(
    program: Program,
    sink: BinaryIO,
    progress: WriteProgress | None = None,
    subprograms: SubprogramOutput | None = None,
    observer: Observer = SILENT,
    passages: list[TemplatePassage] | None = None,
) -> tuple[OperationStart, ...]:
    """Write a program, and return where its operations begin.

    program      checked by ``trunnion.output.validation.check_program``
    sink         takes the bytes of the main program
    progress     receives how much of them can be read back
    subprograms  how the program is divided into files; None: it is a single file
    observer     receives the progress, in points
    passages     takes where texts of the user's templates stand
    """
    rows, done = sum(len(motion.operation.moves) for motion in program.motions), 0
    with observer.progress("writing", rows, "points") as advance:

        def written(points: int) -> None:
            nonlocal done
            advance(points)
            done += points
            if progress is not None:
                sink.flush()
                progress.advance(sink.tell(), sink.tell() * rows // done)

        starts = write_program(program, sink, written, subprograms, passages)
    sink.flush()
    return starts


def named_verification(found: Verification, name: str, kept: Iterable[Path]) -> Verification:
    """Return the verification of a program with its files, and the places in them, called as they will be.

    Files that are ``kept`` exist already, and stay what they are called.
    """
    names = _names(found.run, name) | {str(file): str(file) for file in kept} | {"": ""}

    def named(check: Check) -> Check:
        return replace(
            check,
            places=tuple(
                replace(each, nc_file=names.get(each.nc_file, Path(each.nc_file).name)) for each in check.places
            ),
        )

    return replace(found, program=name, run=named_run(found.run, name), checks=tuple(map(named, found.checks)))


def named_run(run: Run, name: str) -> Run:
    """Return a run whose files are called as they will be: the program by its name, subprograms as they lie
    beside it.
    """
    names = _names(run, name)
    told = tuple(replace(each, file=names.get(each.file, each.file)) for each in run.diagnostics)
    files = tuple(names[file] for file in run.files)
    skipped = tuple(replace(each, run=named_run(each.run, name)) for each in run.skipped)
    return replace(run, files=files, diagnostics=told, skipped=skipped)


def _names(run: Run, name: str) -> dict[str, str]:
    """Return what the files of a run will be called."""
    return {file: Path(file).name for file in run.files[1:]} | {run.files[0]: name}
