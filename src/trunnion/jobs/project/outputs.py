"""Files that a project writes: what is wrong with one of them is reported where the project names it."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace

from trunnion.errors import InputError, Problem, key_subject
from trunnion.jobs.project.project import PostedSetup

#: The kind of codes of files that cannot be written, or must not be replaced.
_OF_OUTPUTS = "FIL2"


@contextmanager
def reported_at_outputs(setups: Sequence[PostedSetup], *, alone: bool = False) -> Iterator[None]:
    """Have problems with files that a project writes reported at the keys that name them.

    setups   of the project
    alone    there is one set-up, and all that is written is of its program
    """
    try:
        yield
    except InputError as error:
        found = [_at_key(problem, setups, alone=alone) for problem in error.problems]
        if found == list(error.problems):
            raise
        raise InputError(found) from None


def _at_key(problem: Problem, setups: Sequence[PostedSetup], *, alone: bool) -> Problem:
    if not problem.code.startswith(_OF_OUTPUTS):
        return problem
    of_file = [each.files[problem.file] for each in setups if problem.file in each.files]
    of_program = [each.files[str(each.output)] for each in setups if str(each.output) in each.files] if alone else []
    for file, line, key in [*reversed(of_file), *of_program]:
        wording = problem.wording.within("of_file_of_key", key=key, file=problem.file)
        return replace(problem, file=file, line=line, wording=wording, subject=key_subject(key))
    return problem
