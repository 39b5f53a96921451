"""CL files, and programs that somebody has taken for one.

In:     a file, and how it is read.
Out:    its toolpaths; or all that is wrong with it, and first of all that it is an NC program, where it is one.
"""

from dataclasses import replace
from pathlib import Path
from typing import BinaryIO, Final

from trunnion.cl.read import ClReading
from trunnion.cl.watched import Watch, read_watched
from trunnion.errors import InputError, warning
from trunnion.messages import Wording
from trunnion.model.toolpath import Toolpath

#: Fewer errors do not say that a file is no CL file.
_FEW_ERRORS: Final = 5

#: The code of errors that say so, however few they are.
_NO_CL_FILE: Final = "CL110"


def read_cl_file(file: Path | BinaryIO, watch: Watch, how: ClReading) -> list[Toolpath]:
    """Return the toolpaths of a file, as ``read_watched`` does, each with a remark where its unit is assumed.

    Raises ``InputError`` with every problem of it; the first says what program it is, where it is one.
    """
    try:
        return [_with_assumption(toolpath) for toolpath in read_watched(file, watch, how)]
    except InputError as error:
        is_doubtful = len(error.problems) >= _FEW_ERRORS or any(each.code == _NO_CL_FILE for each in error.problems)
        if not (is_doubtful and isinstance(file, Path)):
            raise
        from trunnion.readers import program_for_cl_file  # a CL file has no need of it

        program = program_for_cl_file(file)
        if program is None:
            raise
        others = [each for each in error.problems if each.code != _NO_CL_FILE]  # they would say it again
        raise InputError((program, *others)) from None


def _with_assumption(toolpath: Toolpath) -> Toolpath:
    if toolpath.states_unit or not any(len(operation.moves) for operation in toolpath.operations):
        return toolpath
    remark = warning(toolpath.file, 0, Wording("CL420", "mm_assumed"))
    return replace(toolpath, remarks=(remark, *toolpath.remarks))
