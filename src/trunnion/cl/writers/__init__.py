"""Writers of CL files, one for each dialect that can be written."""

from typing import Final

from trunnion.cl.writers.catia import CatiaWriter
from trunnion.cl.writers.clsf import ClsfWriter
from trunnion.cl.writers.ncl import NclWriter
from trunnion.cl.writers.trunnion import TrunnionWriter
from trunnion.cl.writers.writer import ClWriter

__all__ = ["WRITERS", "ClWriter"]

#: By the names of their dialects.
WRITERS: Final[dict[str, type[ClWriter]]] = {
    writer.name: writer for writer in (ClsfWriter, CatiaWriter, NclWriter, TrunnionWriter)
}
