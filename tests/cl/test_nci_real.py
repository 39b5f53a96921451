"""A real NCI of Mastercam: the program of a Fagor that was posted from it, and each of its fields damaged."""

import random
import re
from collections import Counter
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support import nci
from trunnion.arrays import Floats
from trunnion.cl import ClReading, read_cl
from trunnion.errors import InputError
from trunnion.model.toolpath import Kind, Toolpath

real = pytest.mark.skipif(not nci.REAL.is_file(), reason="the files of others are not here")

#: Degrees between two tool axes: B and C are printed with two decimals.
_AXIS = 0.006
#: Half a digit of coordinates with four decimals, inches.
_HALF_DIGIT = 0.5e-4 + 1e-9

#: Mutations of the sample that a test tries; all of them by ``python -m tests.cl.test_nci_real``.
_SAMPLE = 400


def _degrees(one: Floats, other: Floats) -> Floats:
    return np.asarray(np.degrees(2.0 * np.arcsin(np.linalg.norm(one - other, axis=1) / 2.0)), np.float64)


def _words(program: str) -> Floats:
    """X, Y, Z, B and C of each block with coordinates of the workpiece, its words modal."""
    now = dict.fromkeys("XYZBC", 0.0)
    rows = []
    for block in program.splitlines():
        if "G53" in block or ";" in block:
            continue
        found = re.findall(r"([XYZBC])(-?[\d.]+)", block)
        now |= {letter: float(value) for letter, value in found}
        if any(letter in "XYZ" for letter, _ in found):
            rows.append([now[letter] for letter in "XYZBC"])
    return np.array(rows)


@real
def test_points_axes_and_feeds_are_those_of_the_posted_program(tmp_path: Path) -> None:
    """Its last block but one mirrors the tool axis: B15.96 in place of B-15.96, and no C. It is a rapid to the end."""
    tip, axis, feed = nci.fagor_axes()
    machine, program = tmp_path / "head.toml", tmp_path / "part.ngc"
    machine.write_text(nci.MACHINE, encoding="utf-8")
    moves = read_cl(nci.REAL, ClReading(units="inch")).operations[0].moves
    assert len(moves) == len(tip) == 115
    cuts = moves.kind == Kind.LINEAR
    assert np.count_nonzero(np.abs(moves.feed[cuts] / 25.4 - feed[cuts]) < 1e-9) == 109
    result = trunnion.post(nci.REAL, machine=machine, output=program, settings={"cl_units": "inch", "units": "inch"})
    assert result.passed
    found = _words(program.read_text(encoding="utf-8"))[:115]
    assert np.abs(found[:, :3] - tip).max() <= _HALF_DIGIT
    b, c = np.radians(found[:, 3]), np.radians(found[:, 4])
    ours = np.column_stack((np.sin(b) * np.cos(c), np.sin(b) * np.sin(c), np.cos(b)))
    assert _degrees(ours, axis)[:-1].max() < _AXIS
    assert _degrees(ours, axis * [-1, 1, 1])[-1] < _AXIS


@cache
def _lines() -> tuple[str, ...]:
    return tuple(nci.REAL.read_text(encoding="utf-8").splitlines())


def _written() -> tuple[str, ...]:
    """A job with what the real file lacks: holes in two tool axes, lengths of tools, arcs, a helix, a turned plane."""
    up, aslant = (0.0, 0.0, 1.0), (0.6, 0.0, 0.8)
    holes = [
        nci.Hole((10, 20, 1), up, 9, 3, 50, 2.5, 0.25), nci.Hole((30, 20, 1), up, 9, 3, 50, 2.5, 0.25),
        nci.Hole((30, 40, 1), aslant, 12, 3, 50, 2.5),
    ]  # fmt: skip
    arcs = ["3", "0 0 20 0 10 0 0 -1 0 0", "2", "1 0 10 0 5 0 20 -1 0 0", "3", "2 0 30 0 25 0 10 -1 0 0"]
    lines = [
        "20001", "DRILL 6", "20007", "0. 30. 70. 35. 10. 50. 40. 0 0. 0. 0", *nci.tool(3, 6, 0, 900, 1),
        *nci.five_axis((0, 0, 60), up, -2, 42), *nci.cycle(1, holes, 120, 2), *nci.cycle(3, holes[:1], 900),
        *nci.five_axis((0, 0, 60), up, -2, 42), "1014",
        "1. 0. 0. 0. 0. 1. 0. -1. 0.", "1002", "0 100 2 3 0 0 0 900 0. 1 0. 0. 0.",
        *nci.line(0, (0, 0, 60), -2), *nci.line(1, (0, 0, 0), 300), *arcs, "2", "0 0 30 10 35 10 9 -1 0 1",
        *nci.line(0, (0, 0, 60), -2),
    ]  # fmt: skip
    return tuple(nci.file_of(*lines).splitlines())


def _damaged(field: str) -> Iterator[str]:
    """What may become of a field: another number, another sign, a lost or a doubled character."""
    if re.fullmatch(r"-?\d+\.?\d*", field):
        yield field[1:] if field.startswith("-") else f"-{field}"
        yield f"{float(field) + 1:g}"
        yield f"{field}5" if "." in field else f"{field}0"
        yield field.replace(".", "") if "." in field else f"{field}.5"
    yield ""
    yield f"{field} {field}"


Lines = tuple[str, ...]


def mutations(whole: Lines) -> Iterator[tuple[int, int, str]]:
    """Line, field in it, and what stands there: all of the file."""
    for number, line in enumerate(whole):
        for place, field in enumerate(line.split(" ")):
            for other in dict.fromkeys(_damaged(field)):
                if other != field:
                    yield number, place, other


def said(toolpath: Toolpath) -> object:
    """All that a toolpath says, warnings included."""
    operations = [
        (
            operation.name, operation.tool, operation.frame, [repr(event) for event in operation.events],
            *(getattr(operation.moves, name).tobytes() for name in ("tip", "axis", "kind", "feed", "line")),
            *(getattr(operation.arcs, name).tobytes() for name in ("row", "centre", "normal", "radius", "full_turns")),
        )
        for operation in toolpath.operations
    ]  # fmt: skip
    return toolpath.part, operations, [(each.line, each.what) for each in toolpath.remarks]


def judged(whole: Lines, mutation: tuple[int, int, str], file: Path) -> str:
    """What becomes of a mutation: ``refused``, ``changed``, ``named`` in a warning, ``equal`` or ``silent``."""
    number, place, other = mutation
    lines = list(whole)
    fields = lines[number].split(" ")
    field = fields[place]
    lines[number] = " ".join([*fields[:place], *([other] if other else []), *fields[place + 1 :]])
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    try:
        toolpath = read_cl(file, ClReading(units="inch"))
    except InputError:
        return "refused"
    if said(toolpath) != said(_read(whole, file.with_name("whole.nci"))):
        return "changed"
    code = lines[number - 1].strip() if number % 2 else ""
    if any(code in _codes(problem.what) for problem in toolpath.remarks):
        return "named"
    if not field and not other.strip():
        return "equal"
    same = re.fullmatch(r"[-\d.]+", other) and float(other) == float(field)
    second = code == "11" and place >= 3 and re.fullmatch(r"[-\d.]+", other)
    if same or (second and abs(float(other) - float(field)) < 1e-5):
        return "equal"
    return "silent"


@cache
def _read(lines: Lines, file: Path) -> Toolpath:
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return read_cl(file, ClReading(units="inch"))


def _codes(what: str) -> set[str]:
    """Codes of pairs that a warning names."""
    listed = re.search(r"not followed: (.*)", what)
    found = set()
    for run in listed[1].split(", ") if listed else ():
        first, _, last = run.partition("–")
        found |= {str(code) for code in range(int(first), int(last or first) + 1)}
    return found


@pytest.mark.parametrize(("lines", "count"), [pytest.param(_lines, 5000, marks=real), (_written, 1400)])
def test_no_damaged_field_passes_in_silence(tmp_path: Path, lines: Callable[[], Lines], count: int) -> None:
    every = list(mutations(lines()))
    assert len(every) >= count
    sample = random.Random(35).sample(every, _SAMPLE)
    counts = Counter(judged(lines(), mutation, tmp_path / "part.nci") for mutation in sample)
    assert counts["silent"] == 0, counts
    assert counts["refused"] > counts["changed"] > 0


if __name__ == "__main__":
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        verdicts: Counter[str] = Counter()
        for lines in (_lines(), _written()):
            for each in mutations(lines):
                verdict = judged(lines, each, Path(folder) / "part.nci")
                verdicts[verdict] += 1
                if verdict == "silent":
                    print(each, lines[each[0]])
        print(verdicts, verdicts.total())
