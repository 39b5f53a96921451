"""What Sinumerik says that words and templates alone cannot: arcs, dwells, messages, the tool's call.

Facts: SINUMERIK 840D sl programming manuals, *Fundamentals* and *Job planning*; docs/controls/sinumerik.md has them
one by one.
"""

import math

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.control.definition import Control
from trunnion.nc import ABSENT, NumberFormat, counts
from trunnion.toolpath import Arcs, Dwell, Message, Stop

_PLANES = ("plane_yz", "plane_zx", "plane_xy")
_CENTRE_WORDS = (("J", "K"), ("K", "I"), ("I", "J"))
_END_WORDS = (("Y", "Z"), ("Z", "X"), ("X", "Y"))


def comment(text: str) -> str:
    """A line that the control ignores."""
    return f";{text}"


def tool_call(number: int, name: str, by_name: bool) -> str:
    """What stands after ``T=``: a number, or a name in quotation marks."""
    return f'"{name}"' if by_name else str(number)


def sequence(mode: int) -> tuple[int, int, int]:
    """Axes of the three turns of CYCLE800's _MODE, 0 for X: bits 1 and 0 name the first, 3 and 2 the second, 5 and 4
    the third; 1 is X, 2 is Y, 3 is Z."""
    return (mode & 3) - 1, (mode >> 2 & 3) - 1, (mode >> 4 & 3) - 1


def turns(matrix: Floats, order: tuple[int, int, int]) -> tuple[float, float, float]:
    """Three angles, degrees, that turn the program's axes into those of a plane, each about an axis already turned.

    Parameters
    ----------
    matrix : (3, 3) float64
        X, Y and Z of the plane as columns.
    order
        The axes in the order of their turns, 0 for X; no two alike.

    With s = 1 for the orders X Y Z, Y Z X, Z X Y and s = -1 for the others, the product of the three turns has in row i
    the columns i: cos b cos c, j: -s cos b sin c, k: s sin b, and in column k the rows j: -s sin a cos b, k: cos a
    cos b. Where cos b vanishes only the sum or the difference of a and c counts: c is then 0.
    """
    i, j, k = order
    s = 1.0 if (j - i) % 3 == 1 else -1.0
    across = math.hypot(matrix[i, i], matrix[i, j])
    b = math.atan2(s * matrix[i, k], across)
    if across < 1e-9:
        a, c = math.atan2(s * matrix[k, j], matrix[j, j]), 0.0
    else:
        a, c = math.atan2(-s * matrix[j, k], matrix[k, k]), math.atan2(-s * matrix[i, j], matrix[i, i])
    return math.degrees(a), math.degrees(b), math.degrees(c)


def dwell(event: Dwell, formats: dict[str, NumberFormat]) -> str:
    """``G4 F`` waits seconds, ``G4 S`` spindle revolutions; both stand in a block of their own."""
    return f"G4 {'S' if event.revolutions else 'F'}{formats['dwell'].text(event.amount)}"


def stop(event: Stop, control: Control) -> list[str]:
    """M0 or M1, after the text that the operator is to see."""
    code = control.codes["optional_stop" if event.optional else "stop"]
    return ([comment(event.text)] if event.text else []) + [f"M{code}"]


def message(event: Message) -> str:
    """A comment, or for the operator MSG; a quotation mark inside would end the text early."""
    return 'MSG("' + event.text.replace('"', "'") + '")' if event.display else comment(event.text)


def arc_words(
    arcs: Arcs, tip: Floats, rows: Ints, first: int, decimals: int, control: Control
) -> tuple[dict[str, Ints], dict[str, Ints]]:
    """The words that make rows of a table into arcs.

    Parameters
    ----------
    arcs
        All arcs of the operation, about X, Y or Z.
    tip : (n, 3) float64
        End points of the whole operation, mm.
    rows : (a,) int64
        Indices into ``arcs`` of those that lie in the table.
    first
        The operation's row that is row 0 of the table.

    Returns
    -------
    columns, forced
        Word -> (a,) counts, and word -> (a,) 0 or 1, for the table rows ``arcs.row[rows] - first``. The centre is
        relative to the start; G2 is clockwise seen against the plane's normal; TURN counts whole turns besides.

    In the plane ZX the plane's normal is +Y, in YZ +X: I K and J K are the centre's words there.
    """
    normal = arcs.normal[rows]
    along = np.argmax(np.abs(normal), axis=1)
    positive = normal[np.arange(len(rows)), along] > 0
    codes = control.codes
    columns = {
        "motion": np.where(positive, codes["arc_counterclockwise"], codes["arc_clockwise"]).astype(np.int64),
        "plane": np.array([codes[p] for p in _PLANES], np.int64)[along],
        "turns": np.where(arcs.turns[rows] > 0, arcs.turns[rows], ABSENT),
    }
    offset = arcs.centre[rows] - tip[arcs.row[rows] - 1]
    forced: dict[str, Ints] = {}
    for c, letter in enumerate("IJK"):
        wanted = np.array([letter in _CENTRE_WORDS[a] for a in range(3)])[along]
        columns[letter] = np.where(wanted, counts(np.ascontiguousarray(offset[:, c]), decimals), ABSENT)
        forced["XYZ"[c]] = np.array(["XYZ"[c] in _END_WORDS[a] for a in range(3)], np.int64)[along]
    return columns, forced
