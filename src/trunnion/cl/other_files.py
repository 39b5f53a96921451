"""Files that are no CL data, told by their first bytes: forms of parts, and data of CAM systems that is no text."""

import re
from typing import Final

from trunnion.messages import Wording

#: Forms of parts, each by a mark at the beginning of the file.
_FORMS: Final = (
    ("STEP", re.compile(rb"\s*ISO-10303-21\s*;")),
    ("DXF", re.compile(rb"(?:\s*999\r?\n[^\n]*\n)*\s*0\r?\n\s*SECTION\s*\r?\n")),
    ("DXF", re.compile(rb"AutoCAD Binary DXF\r\n\x1a\x00")),
    ("STL", re.compile(rb"\s*solid\b[^\n]*\n\s*(?:facet|endsolid)\b")),
    ("IGES", re.compile(rb"[^\n]{72}S {0,6}0*1\s*\r?\n")),
    ("PDF", re.compile(rb"%PDF-")),
)

#: Extensions of binary data of CAM systems, with the systems.
_SYSTEMS: Final = {".cut": "PowerMill", ".mcam": "Mastercam", ".mcx": "Mastercam"}

#: Triangles of a binary STL, each of so many bytes, stand behind so many others.
_STL_HEAD: Final = 84
_STL_TRIANGLE: Final = 50


def other_form(head: bytes) -> Wording | None:
    """Return that a file is the form of a part, by its first bytes; None if it is not."""
    for kind, mark in _FORMS:
        if mark.match(head):
            return Wording("CL115", "form", kind=kind)
    return None


def other_binary(name: str, head: bytes) -> Wording | None:
    """Return what a file with NUL bytes is by its first bytes or its name; None if neither says it."""
    suffix = re.search(r"\.[a-z0-9]+$", name.lower())
    extension = suffix[0] if suffix else ""
    if extension in _SYSTEMS:
        return Wording("CL115", "system", extension=extension, system=_SYSTEMS[extension])
    count = int.from_bytes(head[_STL_HEAD - 4 : _STL_HEAD], "little")
    if extension == ".stl" or (count and len(head) == _STL_HEAD + count * _STL_TRIANGLE):
        return Wording("CL115", "form", kind="STL")
    return None
