"""Writing a program that fails its proof: its head says why, and all that is told of its lines holds for that file.

In:     a program, its proof, and what proves it again.
Out:    the program with notices in its head, and the proof of it.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import Final

from trunnion import readers
from trunnion.controls.vocabulary import FORCED_NOTICE
from trunnion.jobs.post.stages import Posting, Proof
from trunnion.jobs.post.writing import write
from trunnion.model.operation_start import OperationStart
from trunnion.model.run import Run
from trunnion.output.program import Program

#: Notices quote numbers of blocks, and may need more lines with larger ones; soon they do not.
_MOST_WRITINGS: Final = 4


def write_forced(
    posting: Posting,
    program: Program,
    proof: Proof,
    prove: Callable[[Run | None, Sequence[OperationStart]], Proof],
) -> Proof:
    """Write a program with a notice of the checks that failed, and return the proof of what is written.

    Notices move lines and numbers of blocks, which they quote themselves: the program is read back and proven again
    with them, and what the second proof says of it stands in the notices that stay.
    """
    job, files = posting.job, posting.target.files
    notices = _notices(proof)
    for _ in range(_MOST_WRITINGS):
        starts = _write(posting, program, notices)
        others = [*files.other_paths, *job.beside]
        run = readers.run_program(
            files.path, job.machine, readers.RunOptions(subprograms=others, encoding=job.encoding)
        )
        proof = prove(run, starts)
        before, notices = notices, _notices(proof)
        if _line_count(program, notices) == _line_count(program, before):
            if notices != before:
                _write(posting, program, notices)
            break
    return proof


def forced_notices(faults: Iterable[str]) -> list[str]:
    """Return the notice of what was overruled: one for all faults, each said once; none if there are none."""
    each = list(dict.fromkeys(faults))
    listed = each if len(each) < 2 else [f"{number}. {fault}" for number, fault in enumerate(each, 1)]
    return [f"{FORCED_NOTICE}, written by --force: {'; '.join(listed)}"] if each else []


def _notices(proof: Proof) -> list[str]:
    return forced_notices(f"{check.title}: {check.summary}" for check in proof.failed)


def _write(posting: Posting, program: Program, notices: Sequence[str]) -> tuple[OperationStart, ...]:
    files = posting.target.files
    files.restart()
    return write(replace(program, notices=[*program.notices, *notices]), files.main, subprograms=posting.subprograms)


def _line_count(program: Program, notices: Sequence[str]) -> int:
    return sum(len(program.control.family.comment(program.spelled(text))) for text in notices)
