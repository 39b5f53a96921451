"""The names of the dialects of CL files, for command lines and job files: importing it imports no reader.

``trunnion.cl.dialects.DIALECTS`` has the dialects, ``trunnion.cl.writers.WRITERS`` those that are written.
"""

from typing import Final

#: Dialects that are read.
READ_DIALECTS: Final = ("clsf", "ncl", "solidworks", "clt", "catia", "fusion", "apt", "nci", "trunnion")

#: Extensions of CL files by the dialects that are written; the first one is the default.
WRITTEN_DIALECTS: Final = {"clsf": ".cls", "catia": ".aptsource", "ncl": ".ncl", "trunnion": ".apt"}
