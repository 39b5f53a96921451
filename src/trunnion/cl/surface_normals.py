"""Surface normals from the contact points that NX writes behind its GOTOs.

    $$ centerline and contact point
    GOTO/5.6280,6.3548,-18.1120 $$ 5.0000,7.6184,-18.3545

In:     a toolpath that has been read, and its file, which is read once more.
Out:    the same toolpath with the column ``Moves.normal``.

A tool with a round corner touches a surface along its normal, the direction from the contact point to the nearest point
of the tool's core. The core is the cylinder bounded by the circle of the corner's centre. Stock left on the part lies
along the same direction.
"""

from dataclasses import replace
from pathlib import Path
from typing import BinaryIO, Final

import numpy as np

from trunnion.arrays import Bytes, Floats, Floats2, Ints, Lines
from trunnion.decimal_bytes import EXACT_DIGITS, POWERS_OF_TEN, parse_decimal
from trunnion.errors import InputError, Problem, warning
from trunnion.jit import ONE, inner, kernel, unsigned
from trunnion.messages import Wording
from trunnion.model.toolpath import Moves, Operation, Tool, Toolpath

#: Bytes read at a time.
_CHUNK: Final = 4 << 20

#: A contact point nearer to the tool's core than this, mm, gives no direction.
_MIN_DISTANCE: Final = 1e-3

#: How far the corner radius may exceed half the diameter, as a part of the diameter: diameters are rounded.
_RADIUS_ROUNDING: Final = 1e-4

_NEWLINE, _RETURN, _BLANK, _DOLLAR, _PLUS, _COMMA, _MINUS = 10, 13, 32, 36, 43, 44, 45
_CONTACT_POINT = np.frombuffer(b"CONTACT POINT", np.uint8)
_TOOL_PATH = np.frombuffer(b"TOOL PATH", np.uint8)


def with_normals(toolpath: Toolpath) -> Toolpath:
    """Return the toolpath with surface normals; remarks name the operations that have none.

    Raises ``InputError`` if the file can no longer be read.
    """
    moving = [operation for operation in toolpath.operations if len(operation.moves)]
    if not moving:
        return toolpath
    line = np.concatenate([operation.moves.line for operation in moving])
    try:
        with _text_of(toolpath) as source:
            contact = contact_points(source, line) * toolpath.unit
    except OSError as error:
        raise InputError(
            Problem(toolpath.file, 0, Wording("FIL120", "input_gone", strerror=error.strerror or error))
        ) from error
    operations, remarks = [], list(toolpath.remarks)
    begin = 0
    for operation in toolpath.operations:
        moves = operation.moves
        points = contact[begin : begin + len(moves)]
        begin += len(moves)
        why = _why_no_normals(operation.tool, points)
        normal = np.full((len(moves), 3), np.nan) if why else normals(moves, points, operation.tool)
        if why and len(moves):
            remarks.append(_remark(toolpath.file, operation, why))
        operations.append(replace(operation, moves=replace(moves, normal=normal)))
    return replace(toolpath, operations=tuple(operations), remarks=tuple(remarks))


def _text_of(toolpath: Toolpath) -> BinaryIO:
    """Return the text of the file that a toolpath was read from, from its beginning."""
    return toolpath.reopen() if toolpath.reopen else Path(toolpath.file).open("rb", buffering=0)


def _why_no_normals(tool: Tool, contact: Floats) -> str:
    """Why an operation has no normals; empty if it has."""
    if not np.isfinite(contact).any():
        return "has no contact points, and so no surface normals"
    if tool.kind != "MILL" or tool.taper_angle or tool.tip_angle:
        return "has a tool whose form does not give the surface's normal: only ball and toroidal mills do"
    if tool.corner_radius <= 0.0 or tool.corner_radius > (0.5 + _RADIUS_ROUNDING) * tool.diameter:
        return "has a tool without a round corner, whose edge touches surfaces of any direction: no surface normals"
    return ""


def _remark(file: str, operation: Operation, why: str) -> Problem:
    return warning(file, operation.line, Wording("CL940", "operation", operation=operation.name, why=why))


def normals(moves: Moves, contact: Floats, tool: Tool) -> Floats:
    """Return unit vectors out of the surface, (n, 3) float64, NaN where no contact point gives one.

    moves    of one operation, mm
    contact  (n, 3) float64: contact points, mm, NaN where there is none
    tool     a ball or toroidal mill
    """
    to_contact = contact - moves.tip
    axial = np.einsum("ij,ij->i", to_contact, moves.axis)
    radial = to_contact - axial[:, None] * moves.axis
    distance = np.linalg.norm(radial, axis=1)
    core = max(0.5 * tool.diameter - tool.corner_radius, 0.0)
    share = np.minimum(core / np.maximum(distance, 1e-12), 1.0)
    nearest = np.maximum(axial, tool.corner_radius)[:, None] * moves.axis + share[:, None] * radial
    normal = nearest - to_contact
    length = np.linalg.norm(normal, axis=1)
    found = np.full_like(normal, np.nan)
    clear = length > _MIN_DISTANCE
    found[clear] = normal[clear] / length[clear, None]
    return np.asarray(found)


def contact_points(source: BinaryIO, line: Lines) -> Floats:
    """Contact points behind the GOTOs of a file, (n, 3) float64, in units of the file; NaN where there is none.

    They count from a comment that announces contact points up to the next operation.

    source  the text of the CL file from its beginning
    line    (n,) int32, lines of the GOTOs, increasing
    """
    found = np.full((len(line), 3), np.nan)
    state = np.array([1, 0, 0], np.int64)
    rest = b""
    while piece := source.read(_CHUNK):
        whole = rest + piece
        end = whole.rfind(b"\n") + 1
        rest = whole[end:]
        if end:
            _scan_contact_points(np.frombuffer(whole, np.uint8), end, line, found, state)
    if rest:
        _scan_contact_points(np.frombuffer(rest + b"\n", np.uint8), len(rest) + 1, line, found, state)
    return found


@kernel(writes="found state")
def _scan_contact_points(data: Bytes, stop: int, line: Lines, found: Floats2, state: Ints) -> None:
    """Scan whole lines up to ``stop``; ``state``: next line, next row, and whether contact points are announced."""
    at = 0
    number, row, announced = state[0], state[1], state[2]
    while at < stop:
        while row < line.shape[0] and line[row] < number:
            row += 1
        end = at
        dollars = -1
        while data[end] != _NEWLINE:
            if dollars < 0 and data[end] == _DOLLAR and data[end + 1] == _DOLLAR:
                dollars = end + 2
            end += 1
        if row < line.shape[0] and line[row] == number:
            if announced and dollars >= 0:
                _parse_point(data, dollars, found, row)
        elif dollars >= 0 and _contains(data, dollars, end, _CONTACT_POINT):
            announced = 1
        elif _contains(data, at, min(end, at + _TOOL_PATH.shape[0]), _TOOL_PATH):
            announced = 0
        at = end + 1
        number += 1
    state[0], state[1], state[2] = number, row, announced


@inner
def _contains(data: Bytes, begin: int, end: int, word: Bytes) -> bool:
    """Whether bytes contain a word, in upper or lower case; ``word`` is in capitals."""
    for first in range(begin, end - word.shape[0] + 1):
        same = 0
        while same < word.shape[0]:
            byte = data[first + same]
            if byte != word[same] and byte - 32 != word[same]:
                break
            same += 1
        if same == word.shape[0]:
            return True
    return False


@inner
def _parse_point(data: Bytes, begin: int, found: Floats, row: int) -> None:
    """Parse ``x,y,z`` up to the end of the line into a row; anything else leaves NaN there."""
    at = unsigned(begin)
    for k in range(3):
        while data[at] == _BLANK:
            at += ONE
        negative = data[at] == _MINUS
        if negative or data[at] == _PLUS:
            at += ONE
        mantissa, digits, decimals, _, at = parse_decimal(data, at)
        while data[at] == _BLANK:
            at += ONE
        ends = data[at] == _RETURN or data[at] == _NEWLINE
        if digits == 0 or digits > EXACT_DIGITS or (data[at] != _COMMA if k < 2 else not ends):
            found[row, 0] = found[row, 1] = found[row, 2] = np.nan
            return
        value = mantissa / POWERS_OF_TEN[decimals]
        found[row, k] = -value if negative else value
        at += ONE
