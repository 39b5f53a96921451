"""X, Y and Z as increments: the same program, exactly, on every control; and what stays absolute."""

import io
import re
from decimal import Decimal
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import trunnion
from tests.support.examples import examples
from tests.support.linuxcnc.interpreter import interpret, needs_linuxcnc
from tests.support.locations import GOLDEN
from trunnion.controls.words import ABSENT, BlockNumbers, IncrementWords, NumberFormat, Word
from trunnion.output.blocks.block_writer import BlockWriter

FLAT = GOLDEN / "yl569" / "1_contour_rough.cls"
FLANGE = GOLDEN / "fanuc" / "flange.cls"
BEVEL = GOLDEN / "dmu65" / "bevel.cls"
BLADE = GOLDEN / "yl569" / "3_blade_finish.cls"
ISO = ["yl569", "matsuura_mx330", "haas_umc750", "hs664rt", "xyzac_trt"]
KLARTEXT = ["dmu65", "mikron_600u", "ucp800"]
CASES = [(m, cl) for m in (*ISO, *KLARTEXT) for cl in (FLAT, FLANGE, BEVEL) if m != "xyzac_trt" or cl is FLAT]

HEAD = """TOOL PATH/A,TOOL,D10
TLDATA/MILL,10,0,75,0,0
MSYS/0,0,0,1,0,0,0,1,0
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,1
SPINDL/RPM,4000,CLW
RAPID
GOTO/0,0,20,0,0,1
FEDRAT/MMPM,500
"""
FOOT = "RAPID\nGOTO/0,0,20\nEND-OF-PATH\n"


def post(cl: Path | str, machine: str, folder: Path, distances: str = "incremental", **settings: str) -> Path:
    """The program of a CL file, or of its lines between head and foot; it is proven."""
    if isinstance(cl, str):
        text, cl = HEAD + cl + FOOT, folder / "part.cls"
        cl.write_text(text, encoding="utf-8")
    program = folder / f"{distances}.nc"
    assert trunnion.post(cl, machine=machine, output=program, settings={"distances": distances, **settings}).passed
    return program


def steps(program: Path, letter: str) -> list[Decimal]:
    """The increments of an axis, as they are printed."""
    text = program.read_text(encoding="utf-8")
    parts = re.findall(r"G91\n(.*?)(?:G90|\Z)", text, re.DOTALL) if "G91" in text else [text]
    sign = "" if "G91" in text else "I"
    return [Decimal(each) for part in parts for each in re.findall(rf"(?<![A-Z]){sign}{letter}([-+]?[0-9.]+)", part)]


@pytest.mark.parametrize(("machine", "cl"), CASES, ids=lambda value: getattr(value, "stem", value))
def test_the_program_is_proven_and_the_absolute_one(machine: str, cl: Path, tmp_path: Path) -> None:
    program, absolute = (post(cl, machine, tmp_path, each) for each in ("incremental", "absolute"))
    text = program.read_text(encoding="utf-8")
    assert re.search(r" I[XYZ][-+]\d" if machine in KLARTEXT else r"(?m)G91$", text)
    assert trunnion.diff(program, absolute, machine=machine).same


@pytest.mark.parametrize("machine", [*ISO, *KLARTEXT])
def test_no_rounding_adds_up(machine: str, tmp_path: Path) -> None:
    """A thousand steps of a third of a millimetre end where the absolute program does, to the last digit."""
    lines = "GOTO/0,0,0\n" + "".join(f"GOTO/{k / 3:.9f},{k / 7:.9f},0\n" for k in range(1, 1001))
    program = post(lines, machine, tmp_path)
    for letter, end in (("X", 1000 / 3), ("Y", 1000 / 7)):
        found = steps(program, letter)[:1000]
        digits = max(-int(each.as_tuple().exponent) for each in found)
        assert len(found) == 1000
        assert sum(found) == round(Decimal(end), digits)


@pytest.mark.parametrize("machine", ISO)
def test_what_stays_absolute_follows_g90(machine: str, tmp_path: Path) -> None:
    skipped = "GOTO/5,0,0\nGOTO/6,0,0\nOPSKIP/ON\nGOTO/7,0,0\nGOTO/6,0,0\nOPSKIP/OFF\nGOTO/8,0,0\nGOTO/9,1,0\n"
    text = post(skipped, machine, tmp_path, numbers="off").read_text(encoding="utf-8")
    on = False
    for line in text.splitlines():
        on = (on or line == "G91") and line != "G90"
        if line.startswith("/") or re.search(r"G53|SUPA|G43|M6|G28|M242|G154|M30|M0?2$|T1", line):
            assert not on, line
    assert text.count("G91\n") == 2
    assert not on


@pytest.mark.parametrize("machine", ["dmu65", "yl569", "matsuura_mx330", "hs664rt"])
def test_with_tcp_nothing_changes_but_the_start_of_operations(machine: str, tmp_path: Path) -> None:
    program, absolute = (
        post(BLADE, machine, tmp_path, each, numbers="off" if machine != "dmu65" else "on").read_text(encoding="utf-8")
        for each in ("incremental", "absolute")
    )
    assert re.sub(r"(?m)^G90\n", "", program) == re.sub(r"(?m)^G90\n", "", absolute)
    assert "G91" not in program


@pytest.mark.parametrize(
    ("machine", "units"), [(m, u) for m in (*ISO, *KLARTEXT) for u in ("mm", "inch") if (m, u) != ("hs664rt", "inch")]
)
def test_circles_of_any_kind_end_where_they_should(machine: str, units: str, tmp_path: Path) -> None:
    whole = "GOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10,0.06,0.5,10,0\nGOTO/10,0,0\n"
    half = "CIRCLE/0,0,0,0,0,1,10,0.06,0.5,10,0\nGOTO/-10,0,0\nCIRCLE/0,0,0,0,0,1,10,0.06,0.5,10,0\nGOTO/0,-10,-3\n"
    lines = f"{whole}{half}GOTO/5,5,-3\n"
    program, absolute = (post(lines, machine, tmp_path, each, units=units) for each in ("incremental", "absolute"))
    assert trunnion.diff(program, absolute, machine=machine).same


@pytest.mark.parametrize("machine", ["yl569", "matsuura_mx330", "xyzac_trt"])
def test_each_file_begins_and_ends_absolute(machine: str, tmp_path: Path) -> None:
    """Also a subprogram that goes on in another file."""
    lines = "".join(f"GOTO/{k % 50},{k % 7},0\n" for k in range(3000))
    post(lines, machine, tmp_path, programs="operations", split="20480")
    files = [each for each in tmp_path.iterdir() if each.suffix not in (".cls",)]
    assert len(files) > 2
    for each in files:
        words = re.findall(r"G9[01]\b(?!\.)", each.read_text(encoding="utf-8"))
        assert not words or words[-1] == "G90"


@needs_linuxcnc
@pytest.mark.parametrize("cl", [FLAT])
def test_linuxcnc_makes_the_same_motions(cl: Path, tmp_path: Path) -> None:
    one, two = (
        interpret(post(cl, "xyzac_trt", tmp_path, each).read_text(encoding="utf-8"), tmp_path, "XYZAC").moves
        for each in ("incremental", "absolute")
    )
    assert [(move.kind, move.feed, move.turns) for move in one] == [(move.kind, move.feed, move.turns) for move in two]
    for mine, other in zip(one, two, strict=True):
        assert np.allclose(mine.end, other.end, atol=1e-6)


WORDS = [Word("motion", "G", NumberFormat(0)), *(Word(each, each, NumberFormat(3)) for each in "XYZ")]
COLUMN = st.lists(st.one_of(st.just(int(ABSENT)), st.integers(-5, 5)), min_size=9, max_size=9)


@given(st.tuples(COLUMN, COLUMN, COLUMN), st.lists(st.booleans(), min_size=9, max_size=9), st.booleans(), COLUMN)
@settings(max_examples=examples(300), deadline=None)
def test_a_slow_twin_finds_the_positions_of_the_table(
    columns: tuple[list[int], ...], may: list[bool], by_prefix: bool, second: list[int]
) -> None:
    """Blocks are followed as a control follows them; two tables come one after the other."""
    said = IncrementWords(prefix="I") if by_prefix else IncrementWords("G91", "G90")
    sink = io.BytesIO()
    writer = BlockWriter(sink, WORDS, BlockNumbers(numbered=False), increment_words=said)
    tables = [columns, (second, columns[0], columns[1])]
    for table in tables:
        counts = {axis: np.array(column, np.int64) for axis, column in zip("XYZ", table, strict=True)}
        motion = {"motion": np.arange(1, 10, dtype=np.int64)}
        writer.write_table({**motion, **counts}, {"motion": True}, relative=np.array(may))
    writer.write_lines(["END"])
    at, relative, rows = dict.fromkeys("XYZ", ABSENT), False, []
    for line in sink.getvalue().decode().splitlines():
        if line in ("G90", "G91", "END"):
            assert not (by_prefix and line != "END")
            relative = line == "G91"
            continue
        for sign, axis, number in re.findall(r"(I?)([XYZ])(-?[0-9.]+)", line):
            count = round(float(number) * 1000)
            is_step = relative or bool(sign)
            assert not (is_step and at[axis] == ABSENT)
            at[axis] = at[axis] + count if is_step else count
        rows.append(dict(at))
    assert not relative
    expected, known = [], dict.fromkeys("XYZ", ABSENT)
    for table in tables:
        for row in range(9):
            known |= {axis: column[row] for axis, column in zip("XYZ", table, strict=True) if column[row] != ABSENT}
            expected.append(dict(known))
    assert rows == expected
