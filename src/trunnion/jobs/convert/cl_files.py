"""Conversion of a toolpath into a CL file, which is read back and compared before it appears."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import BinaryIO, Final

from trunnion.cl import DIALECTS
from trunnion.cl.read_back import read_back_problems
from trunnion.cl.writers import WRITERS
from trunnion.errors import InputError, Problem, RefusedError, argument_problem, merge_repeated, setting_problem
from trunnion.jobs.arguments import ConvertArguments
from trunnion.jobs.inputs.reading import read_cl
from trunnion.jobs.inputs.settings import Settings, as_texts
from trunnion.jobs.observer import Observer
from trunnion.jobs.result_output import Target
from trunnion.messages import Wording
from trunnion.model.clamping_notices import clamped_notices
from trunnion.model.toolpath import Toolpath

#: Settings of a conversion from CL file to CL file, and what they may be.
_SETTINGS: Final[Mapping[str, tuple[str, ...]]] = {
    "cl_units": ("mm", "inch"),
    "dialect": tuple(DIALECTS),
    "units": ("mm", "inch"),
}

_INCH: Final = 25.4

#: What is said of a file whose statements nobody knows.
_NO_CL_FILE: Final = "not_cl_file"


def write_and_prove(
    toolpath: Toolpath, target: Target, dialect: str, *, inch: bool = False, comments: Sequence[str] = ()
) -> tuple[Problem, ...]:
    """Write a CL file and read it back; return what the dialect cannot say.

    Raises ``InputError`` if the dialect has no words for a motion, a tool or a cycle.

    Raises ``RefusedError`` if what was written says anything else than the toolpath.
    """
    writer = WRITERS[dialect](toolpath, inch=inch)
    writer.write(target.files.main, comments)
    target.files.flush()
    if problems := read_back_problems(writer.toolpath, target.files.path, dialect):
        raise RefusedError(problems)
    return merge_repeated(writer.remarks)


def convert_cl(
    path: Path | BinaryIO, target: Target, given: ConvertArguments, observer: Observer
) -> tuple[Toolpath, tuple[Problem, ...]]:
    """Read a CL file or stream of any dialect, and write it in another one; return the toolpath and all warnings."""
    texts = _checked(given["settings"])
    units, read_in = (given["units"] or texts.get("cl_units"), given["dialect"] or texts.get("dialect"))
    try:
        toolpath = read_cl(path, units=units, dialect=read_in, strict=given["strict"], observer=observer)
    except InputError as error:
        if error.problems[0].wording.variant != _NO_CL_FILE:
            raise
        hint = argument_problem("machine", Wording("CNV110", "read_as_cl_file"))
        raise InputError((*error.problems, hint)) from None
    observer.problems(toolpath.remarks)
    inch = texts["units"] == "inch" if "units" in texts else toolpath.unit == _INCH
    clamped = () if toolpath.clamping is None else tuple(clamped_notices(toolpath.clamping))
    remarks = write_and_prove(toolpath, target, str(given["to_dialect"]), inch=inch, comments=clamped)
    observer.problems(remarks)
    return toolpath, (*toolpath.remarks, *remarks)


def _checked(settings: Settings | None) -> dict[str, str]:
    """Return the settings as texts."""
    texts = as_texts(settings)
    problems = [
        setting_problem(key, Wording("CNV111", "no_meaning_between_cl_files", allowed=tuple(_SETTINGS)))
        for key in texts.keys() - _SETTINGS.keys()
    ]
    for key, choices in _SETTINGS.items():
        if texts.get(key, choices[0]) not in choices:
            problems.append(
                setting_problem(
                    key,
                    Wording(
                        "CNV111",
                        "unknown_choice",
                        value=repr(texts[key]),
                        choices=tuple(f"{key}={choice}" for choice in choices),
                    ),
                )
            )
    if problems:
        raise InputError(problems)
    return texts
