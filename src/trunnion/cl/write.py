"""Writes a ``Toolpath`` as a CL file that ``read_cl`` reads back the same."""

from collections.abc import Iterable
from typing import BinaryIO

from trunnion.cl.writers import WRITERS
from trunnion.errors import Problem
from trunnion.model.toolpath import Toolpath


def write_cl(
    toolpath: Toolpath,
    sink: BinaryIO,
    *,
    dialect: str = "clsf",
    inch: bool = False,
    comments: Iterable[str] = (),
) -> tuple[Problem, ...]:
    """Write a CL file.

    Parameters
    ----------
    toolpath
        Events in the order of their rows, as ``read_cl`` gives them.
    sink
        Takes UTF-8 bytes in order.
    dialect
        A key of ``trunnion.cl.writers.WRITERS``.
    inch
        Write lengths and feeds in inches instead of millimetres.
    comments
        Lines for the head of the file, as ``$$`` comments.

    Returns
    -------
    tuple of Problem
        Remarks on what the dialect cannot express and reads back otherwise.

    Raises
    ------
    InputError
        Before anything is written, if the dialect cannot hold the toolpath at all.
    """
    writer = WRITERS[dialect](toolpath, inch=inch)
    writer.write(sink, comments)
    return tuple(writer.remarks)
