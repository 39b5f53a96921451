"""Cures of messages about Mastercam's NCI, by lines that go out and come in, and about files that are no CL data."""

from collections.abc import Mapping
from pathlib import Path
from typing import Final

from tests.support import nci
from tests.support.cures.cure import Cure, Outcome, marked, read
from trunnion.cl import ClReading, read_cl
from trunnion.errors import TrunnionError

_CUT: Final = [
    *nci.tool(3, 10, 1, 900),
    *nci.line(0, (0, 0, 50), -2),
    *nci.line(1, (0, 0, -2), 300),
]
_HEAD: Final = "\n".join([*nci.header(), *_CUT]) + "\n"
_FOOT: Final = "1003\n0. 0. 0.\n"


def _nci(message: str, *lines: str, **settings: str) -> Cure:
    """Lines behind a cut."""
    return marked(message, read, *lines, head=_HEAD, foot=_FOOT, **settings)


def _with_cutcom(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Read a file with what is stated of its points."""
    file = folder / "part.nci"
    file.write_text(text, encoding="utf-8")
    try:
        found = read_cl(file, ClReading(cutcom=settings.get("cutcom")))
    except TrunnionError as error:
        return Outcome(tuple(error.problems), False)
    return Outcome(tuple(found.remarks), True)


def _binary(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Read a text under the name of PowerMill's data."""
    file = folder / "part.cut"
    file.write_bytes(text.encode())
    try:
        found = read_cl(file)
    except TrunnionError as error:
        return Outcome(tuple(error.problems), False)
    return Outcome(tuple(found.remarks), True)


def _other(message: str, code: str, wrong: str, right: str) -> Cure:
    """Values of a record, and others."""
    return _nci(message, code, f"- {wrong}", f"+ {right}")


def _out(message: str, *lines: str) -> Cure:
    """Records that go out, and a line in their place."""
    return _nci(message, *(f"- {line}" for line in lines), "+ 1", "+ 0 20 0 -2 -1 0")


def _places(message: str, *places: int, flag: int = 0) -> Cure:
    """Records 11 one behind the other, which stay."""
    lines = [row for k, place in enumerate(places) for row in nci.five_axis((k, 0, 0), (0.0, 0.0, 1.0), 100, place)]
    if flag:
        lines[-1] = lines[-1].replace(" 22 0 ", f" 22 {flag} ")
    head = "\n".join([*nci.header(), *_CUT[:12]]) + "\n"
    return marked(message, read, *lines, head=head, foot=_FOOT)


_CHANGE: Final = "0 100 2 {} 0 0 {} 900 0. {} 0. 0. 0."
#: A hole: type, dwell and two pecks are open.
_HOLE: Final = "{} 0 0 -9 {} 100 {} 0 0 9 2 0 0 0 0 9 0 0"
_DRILLED: Final = _HOLE.format(0, 0, "0 0")
_STATED: Final = _nci(
    "CL470 points_of_compensation", "1", "41 30. 0. -2. -1. 0", "1", "40 40. 0. -2. -1. 0"
)  # fmt: skip

CURES: Final = (
    Cure("CL115", "form", read, "ISO-10303-21;\nHEADER;\n", (("ISO-10303-21;\nHEADER;\n", _HEAD + _FOOT),)),
    Cure("CL115", "system", _binary, "\x00\x01CL", (("\x00\x01CL", _HEAD + _FOOT),)),
    _nci("CL165 no_code", "- 0 5 0 -2 -1 0", "1", "0 20 0 -2 -1 0", "- 1"),
    _other("CL165 values", "1", "0 20 0 -2 -1", "0 20 0 -2 -1 0"),
    _other("CL165 no_number", "1", "0 20 O -2 -1 0", "0 20 0 -2 -1 0"),
    _other("CL165 no_whole_number", "1002", _CHANGE.format(5.5, 0, 0), _CHANGE.format(5, 0, 0)),
    _other("CL165 unknown_value", "1", "0 20 0 -2 -1 7", "0 20 0 -2 -1 0"),
    _nci("CL220 parameters", "10010", "0.5"),
    _nci("CL220 values", "1012", "1 0 0 0 0 0 0 0 0 0"),
    _places("CL225 place", 42, 12, 22, 52),
    _places("CL225 flag", 42, 12, 22, 22, flag=100),
    _places("CL225 ends_within", 42, 12, 22),
    _other("CL250 cycle_record", "81", _HOLE.format(5, 0, "0 0"), _DRILLED),
    _other("CL830 nci_pecks", "81", _HOLE.format(1, 0, "3 1"), _HOLE.format(1, 0, "3 0")),
    _other("CL830 nci_heights", "81", _DRILLED.replace(" 9 2 0 ", " 9 2 4 "), _DRILLED),
    _other("CL830 nci_dwell", "81", _HOLE.format(0, -1, "0 0"), _HOLE.format(0, 1, "0 0")),
    _nci("CL850 hole_without_cycle", "+ 81", f"+ {_DRILLED}", "100", "0 5 0 -9 9 2 0 100 5 0 9 0 0"),
    _nci("CL770 nci_lengths", "20007", "- 0 9 8", "+ 0 8 9", "1002", _CHANGE.format(5, 0, 0)),
    _other("CL250 arc_plane", "2", "0 3 0 0 10 0 -2 -1 0 0", "0 0 0 0 10 0 -2 -1 0 1"),
    _other("CL250 arc_full", "3", "0 0 0 0 10 0 -2 -1 0 0", "0 0 0 0 10 0 -2 -1 0 1"),
    marked("CL250 arc_without_start", read, "+ 0", "+ 0 0 0 -2 -2 0", "3", "0 0 20 0 10 0 -2 300 0 0",
           head="\n".join([*nci.header(), *_CUT[:8]]) + "\n", foot=_FOOT),
    _out("CL260 lathe_record", "200", "1"),
    _out("CL260 subprogram_record", "1018", "1"),
    _other("CL320 dwell_speed", "4", "0.5 700", "0.5 900"),
    _other("CL330 coolant_number", "1002", _CHANGE.format(5, 0, 9), _CHANGE.format(5, 0, 1)),
    _nci("CL430 tool_plane", "1014", "- 1 0 0 0 0 1 0 -1 0.5", "+ 1 0 0 0 0 1 0 -1 0", "1000", _CHANGE.format(3, 0, 0),
         "0", "0 20 0 -2 -2 0", "1", "0 20 0 -9 100 0"),
    _nci("CL430 work_system", "1027", f"- {nci.TOP} 5 0 0", f"+ {nci.TOP} 0 0 0", "1000", _CHANGE.format(3, 0, 0),
         "1", "0 20 0 -2 100 0"),
    _other("CL430 plane_number", "1002", _CHANGE.format(5, 2, 0), _CHANGE.format(5, 0, 0)),
    _nci("CL430 no_tool_change", "1013", "0 8 0", "+ 1002", f"+ {_CHANGE.format(5, 0, 0)}", "1", "0 20 0 -2 100 0"),
    Cure(_STATED.code, _STATED.variant, _with_cutcom, _STATED.text, ({"cutcom": "contour"},)),
    _nci("CL530 line_behind_tilted", *nci.five_axis((9, 0, 0), (0.6, 0.0, 0.8), 100, 42), "- 1", "- 0 20 0 -2 -1 0",
         *(f"+ {line}" for line in nci.five_axis((20, 0, -2), (0.0, 0.0, 1.0), -1, 42))),
    _other("CL540 second_point", "11", "20 0 -2 20 0 -1 -1 42 0 0.6 0 0.8", "20 0 -2 20 0 -1 -1 42 0 0 0 1"),
    _nci("CL710 unchanged_behind_rapid", "0", "0 0 0 50 -2 0", "1", "- 0 20 0 -2 -1 0", "+ 0 20 0 -2 300 0"),
    _other("CL710 no_feed", "1", "0 20 0 -2 0 0", "0 20 0 -2 250 0"),
    _other("CL710 rapid_with_feed", "0", "0 20 0 50 300 0", "0 20 0 50 -2 0"),
    _other("CL710 line_at_rapid", "1", "0 20 0 -2 -2 0", "0 20 0 -2 -1 0"),
    _nci("CL780 null_change", "- 1000", "+ 1002", _CHANGE.format(5, 0, 0)),
)  # fmt: skip
