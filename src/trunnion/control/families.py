"""The families of controls whose programs can be written."""

from collections.abc import Mapping
from typing import Final

from trunnion.control import fanuc, fidia, heidenhain, linuxcnc, sinumerik
from trunnion.control.family import Family

FAMILIES: Final[Mapping[str, Family]] = {
    "sinumerik_840d": sinumerik,
    "linuxcnc": linuxcnc,
    "heidenhain_itnc530": heidenhain,
    "heidenhain_tnc640": heidenhain,
    "fidia_nc15": fidia,
    "fanuc_30i": fanuc,
}
