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

    toolpath  events in the order of their rows, as ``read_cl`` gives them
    sink      takes UTF-8 bytes in order
    dialect   a key of ``trunnion.cl.writers.WRITERS``
    inch      write lengths and feeds in inches instead of millimetres
    comments  lines for the head of the file, as ``$$`` comments

    tuple of Problem  remarks on what the dialect cannot express and reads back otherwise

    Raises ``InputError`` before anything is written, if the dialect cannot hold the toolpath at all.
    """
    writer = WRITERS[dialect](toolpath, inch=inch)
    writer.write(sink, comments)
    return tuple(writer.remarks)
