"""Where an NC program comes from, by its content alone: the rule of ``benchmarks.acceptance``.

``python -m tests.support.program_origins FOLDER`` prints the origin of each file. The first of these that holds:

``text``      fewer than two blocks have a word of motion, a cycle or a call: this is no NC program
``named``     a comment names a CAM system, its post, or the events and tool lists that such posts print
``part``      a subprogram, or a piece of a program: it neither ends nor starts a spindle, or it begins as a subprogram
``variables`` variables, expressions or jumps: what people write for themselves, and test inputs of interpreters
``form``      the print of a machine: 20 blocks with coordinates, and a quarter of their numbers have three decimals
              that say something, which hardly anybody types
``hand``      all others
"""

import re
import sys
from enum import StrEnum
from pathlib import Path
from typing import Final


class Origin(StrEnum):
    """Where a program comes from."""

    TEXT = "text"
    NAMED = "named"
    PART = "part"
    VARIABLES = "variables"
    FORM = "form"
    HAND = "hand"


#: Programs that somebody has from a CAM system.
OF_CAM: Final = frozenset({Origin.NAMED, Origin.FORM})

#: CAM systems; and phrases, tool lists and events that posts print.
_NAMES: Final = (
    r"alphacam|artcam|aspire|bcnc|bobcad|cambam|camworks|carbide|catia|creo|delcam|easel|edgecam|esprit|estlcam",
    r"f-engrave|feature.?cam|flatcam|freecad|fusion|gibbs|gpost|heekscnc|hsmworks|hsmxpress|hypermill",
    r"image-to-gcode|inkscape|inventor|kiri|madcam|makercam|mastercam|meshcam|pcb2gcode|powermill|pycam|rhinocam",
    r"sheetcam|sketchucam|solidcam|surfcam|tebis|topsolid|unigraphics|ugnx|vcarve|v-carve|vectric|visualmill|worknc",
)
_PHRASES: Final = (
    r"post ?processor",
    r"\bpost ?:",
    r"(generated|exported|created|made|posted) (by|with|using)\b(?! hand)",
    r"\bT\d+ +D=[\d.]+ CR=",
    r"(start|end) of (program|path)( event)?\b",
    r"first tool change event",
    r"siemens.{0,3}\bnx\b|\bnx ?\d",
    r"tool ?path ?(name)? ?:",
    r"\bfile\b.{0,60}\.(stl|stp|step|igs|prt|mcx|mcam|dxf|cls|apt)\b",
)
_NAMED: Final = re.compile("|".join((*_NAMES, *_PHRASES)), re.IGNORECASE)

_COMMENT: Final = re.compile(r"\(([^\n]*)|;([^\n]*)|^MSG\(\"?([^\n]*)|^\d+ \*([^\n]*)", re.MULTILINE)
_CODE: Final = re.compile(r"\([^)\n]*\)|;[^\n]*|^%.*$|\"[^\"\n]*\"", re.MULTILINE)
_MOVES: Final = re.compile(
    r"(?<![A-Z_])[XYZABC] ?[-+=]?[\d.]|\bG\d|(?:^|\d) *(?:L|C|CC|CYCL|CALL|TOOL|LBL)\b|\bCYCLE\d", re.IGNORECASE
)
_ENDS: Final = re.compile(r"(?<![A-Z\d])M0?(?:2|30)(?!\d)|END PGM", re.IGNORECASE)
_SPINDLE: Final = re.compile(r"(?<![A-Z\d])M0?[34](?!\d)|(?<![A-Z])S\d{2}", re.IGNORECASE)
_SUBPROGRAM: Final = re.compile(r"\A\s*(?:N?\d+ +)?(?:PROC\b|O ?<[^>]+> +SUB|O ?\d+ +SUB)", re.IGNORECASE)
_RETURNS: Final = re.compile(r"(?<![A-Z\d])M(?:17|99)(?!\d)(?![\s\S]*\n[\s\S]*[XYZ]\d)|\bRET\b", re.IGNORECASE)
_VARIABLES: Final = re.compile(
    r"#[\d<\[]|\b[QR]\d+ ?=|=[QR]\d|[XYZ][-+=]?\[|\b(?:IF|WHILE|GOTOF|GOTOB|FN ?\d+|DEF (?:REAL|INT)|ENDSUB)\b"
    r"|\bO ?(?:<[^>]*>|\d+) +(?:CALL|DO|REPEAT)\b",
    re.IGNORECASE,
)
_COORDINATE: Final = re.compile(r"(?<![A-Z_])[XYZIJK] ?=?([-+]?\d*\.?\d*)(?![\d.])", re.IGNORECASE)

#: Blocks with coordinates, and the share of fine numbers, from which on a program was printed.
_BLOCKS: Final = 20
_SHARE: Final = 0.25


def origin(text: str) -> Origin:
    """Return where a program comes from."""
    code = _CODE.sub("", text)
    blocks = [line for line in code.splitlines() if _MOVES.search(line)]
    if len(blocks) < 2:
        return Origin.TEXT
    if any(_NAMED.search(comment[0]) for comment in _COMMENT.finditer(text)):
        return Origin.NAMED
    if _SUBPROGRAM.match(text) or (not _ENDS.search(code) and (_RETURNS.search(code) or not _SPINDLE.search(code))):
        return Origin.PART
    if _VARIABLES.search(code):
        return Origin.VARIABLES
    moving = [found for line in blocks if (found := _COORDINATE.findall(line))]
    numbers = [number for line in moving for number in line]
    fine = sum(bool(_decimals(number)) for number in numbers)
    return Origin.FORM if len(moving) >= _BLOCKS and fine >= _SHARE * len(numbers) else Origin.HAND


def _decimals(number: str) -> bool:
    """Whether a number has three decimals that say something."""
    _, _, decimals = number.partition(".")
    return len(decimals.rstrip("0")) >= 3


def origin_of(path: Path) -> Origin:
    """Return where the program of a file comes from."""
    return origin(path.read_bytes().decode("latin-1"))


def main() -> None:
    """Print the origin of each file."""
    root = Path(sys.argv[1])
    for path in sorted(each for each in root.rglob("*") if each.is_file()):
        print(origin_of(path), path.relative_to(root).as_posix(), sep="\t")


if __name__ == "__main__":
    main()
