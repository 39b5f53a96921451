"""The dialects of CL files. Each is data and a few small functions; ``dialect.Dialect`` says what belongs to it."""

from typing import Final

from trunnion.cl.dialect import Dialect
from trunnion.cl.dialects.apt import APT
from trunnion.cl.dialects.camworks import CAMWORKS
from trunnion.cl.dialects.catia import CATIA
from trunnion.cl.dialects.clsf import CLSF
from trunnion.cl.dialects.fusion import FUSION
from trunnion.cl.dialects.nci import NCI
from trunnion.cl.dialects.ncl import NCL
from trunnion.cl.dialects.recognition import Recognition, recognize
from trunnion.cl.dialects.solidworks import SOLIDWORKS
from trunnion.cl.dialects.trunnion import TRUNNION

__all__ = ["DIALECTS", "Dialect", "Recognition", "recognize_dialect"]

#: By their names, those of ``trunnion.dialect_names.READ_DIALECTS``.
DIALECTS: Final[dict[str, Dialect]] = {
    dialect.name: dialect for dialect in (CLSF, NCL, SOLIDWORKS, CAMWORKS, CATIA, FUSION, APT, NCI, TRUNNION)
}


def recognize_dialect(head: bytes) -> Recognition:
    """Return the dialect of a file by the lines at its head; a file without any mark is taken as an NX CLSF."""
    return recognize(head, DIALECTS.values(), CLSF)
