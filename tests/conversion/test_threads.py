"""Cycles that drive the spindle: threads stay threads on every control, and what a toolpath cannot hold is refused."""

from pathlib import Path

import pytest

import trunnion
from trunnion.controls import load_control
from trunnion.conversion import Conversion, convert
from trunnion.errors import RefusedError
from trunnion.machines import load_machine
from trunnion.model.toolpath import CycleOff, CycleOn, Dwell, Operation, Sense, SpindleOff, SpindleOn
from trunnion.readers import run_program

KLARTEXT = """BEGIN PGM A MM
TOOL CALL 5 Z S500
L Z+560 R0 FMAX M91
L X+0 Y+0 Z+50 R0 FMAX M3
{cycle}
L X+10 Y+0 R0 FMAX M99
L X+20 Y+0 R0 FMAX M99
L Z+50 R0 FMAX
L Z+560 R0 FMAX M91
M30
END PGM A MM
"""
SINUMERIK = """T5 M6
SUPA G0 Z0 D0
G54 S500 M3
G0 X0 Y0 Z50 D1 F100
MCALL {cycle}
X10 Y0
X20 Y0
MCALL
G0 Z50
SUPA G0 Z0 D0
M30
"""
FANUC = """%
O0001
G21 G90 G94
T5 M6
G53 G0 Z0.
G54 S500 M3
G43 H5 G0 X0. Y0. Z50.
{cycle}
X20.
G80
G0 Z50.
G53 G0 Z0.
M30
%
"""
LINUXCNC = """G21 G90 G94
T5 M6
G53 G0 Z0
G54 S500 M3
G43 H5
G0 X0 Y0 Z50
{cycle}
X20
G80
G0 Z50
G53 G0 Z0
M2
"""
FIDIA = """G71
M306 T.5
G55 O1
M242
M3 S500
G1 X0. Y0. Z50. F3000
{cycle}
X20.
G80
G1 Z50. F3000
M242
M02
"""
RIGID_KLARTEXT = "CYCL DEF 207 RIGID TAPPING Q200=3 Q201=-20 Q239={pitch} Q203=0 Q204=10"

#: Machine, program, cycle: a right-hand thread of 1.5 mm that begins at 3 mm, 20 mm deep, and retracts to 10 mm.
THREADS = {
    "mikron_600u": (KLARTEXT, RIGID_KLARTEXT.format(pitch="+1.5")),
    "yl569": (SINUMERIK, "CYCLE84(10,0,3,-20,,,3,,1.5,0,500,500)"),
    "matsuura_mx330": (FANUC, "M29 S500\nG99 G84 X10. Z-20. R3. F750.\nG98 X10. R3."),
    "xyzac_trt": (LINUXCNC, "G98 G84 X10 Z-20 R3 F750 P0"),
    "hs664rt": (FIDIA, "G84 X10. Y0. Z10. E-20. R3. F750"),
}


def converted(machine: str, text: str, folder: Path) -> Conversion:
    """A program converted."""
    program = folder / "part.nc"
    program.write_text(text)
    site = load_machine(machine)
    run = run_program(program, site)
    assert run.errors == (), [str(error) for error in run.errors]
    return convert(run, load_control(site.control))


def one(machine: str, text: str, folder: Path) -> Operation:
    """Its only operation, converted without errors."""
    found = converted(machine, text, folder)
    assert found.errors == ()
    (operation,) = found.toolpath.operations
    return operation


def cycles(operation: Operation) -> list[CycleOn]:
    return [event for event in operation.events if isinstance(event, CycleOn)]


def spindle(operation: Operation, row: int) -> tuple[float, Sense] | None:
    """Speed and sense at a row."""
    state = None
    for event in operation.events:
        if event.row <= row and isinstance(event, SpindleOn):
            state = event.rpm, event.sense
        elif event.row <= row and isinstance(event, SpindleOff):
            state = None
    return state


@pytest.mark.parametrize("machine", THREADS)
def test_a_thread_becomes_a_tap_at_its_holes(machine: str, tmp_path: Path) -> None:
    text, cycle = THREADS[machine]
    if machine == "matsuura_mx330":
        cycle = cycle.split("\nG98")[0].replace("G99", "G98").replace("Z50.", "Z10.")
        text = text.replace("Z50.\n{", "Z10.\n{")
    if machine == "xyzac_trt":
        text = text.replace("Z50\n{", "Z10\n{")
    operation = one(machine, text.format(cycle=cycle), tmp_path)
    (found,) = cycles(operation)
    values, surface = dict(found.values), -20.0 - dict(found.values)["FEDTO"][0]
    assert found.mode == ("TAP",)
    assert surface + values["RAPTO"][0] == pytest.approx(3.0)
    assert surface + values["RTRCTO"][0] == pytest.approx(10.0)
    assert values.get("MMPR", (1.5,)) == (1.5,)
    assert values.get("MMPM", (750.0,)) == (750.0,)
    assert bool(dict(found.words)) is (machine == "xyzac_trt"), "its G84 is for a compensating chuck"
    end = next(event.row for event in operation.events if isinstance(event, CycleOff))
    holes = operation.moves.tip[found.row : end]
    assert holes[:, 0].tolist() == [10.0, 20.0]
    assert holes[:, 2].tolist() == pytest.approx([surface, surface])
    assert spindle(operation, found.row) == (500.0, Sense.CLW)
    assert not any(isinstance(event, Dwell) for event in operation.events)


@pytest.mark.parametrize("to", [*THREADS])
@pytest.mark.parametrize("machine", ["mikron_600u", "yl569", "matsuura_mx330"])
def test_the_other_control_taps_with_its_own_cycle(machine: str, to: str, tmp_path: Path) -> None:
    text, cycle = THREADS[machine]
    (tmp_path / "part.nc").write_text(text.format(cycle=cycle))
    found = trunnion.convert(tmp_path / "part.nc", machine=machine, to_machine=to)
    assert found.posted is not None
    assert found.posted.passed
    written = found.text or ""
    own = {
        "mikron_600u": "CYCL DEF 207",
        "yl569": "CYCLE84(",
        "matsuura_mx330": "G84",
        "xyzac_trt": "G33.1",
        "hs664rt": "G84",
    }
    assert own[to] in written
    assert ("M29 S500" in written) is (to == "matsuura_mx330")


@pytest.mark.parametrize(
    ("machine", "cycle"),
    [
        ("mikron_600u", RIGID_KLARTEXT.format(pitch="-1.5")),
        ("yl569", "CYCLE84(10,0,3,-20,,,3,,-1.5,0,500,500)"),
        ("matsuura_mx330", "M29 S500\nG98 G74 X10. Z-20. R3. F750."),
        ("xyzac_trt", "M4\nG98 G74 X10 Z-20 R3 F750 P0\nX20\nG80\nM3\nG0"),
    ],
)
def test_a_left_hand_thread_keeps_its_hand(machine: str, cycle: str, tmp_path: Path) -> None:
    operation = one(machine, THREADS[machine][0].format(cycle=cycle), tmp_path)
    (found,) = cycles(operation)
    assert spindle(operation, found.row) == (500.0, Sense.CCLW)
    after = next(event.row for event in operation.events if isinstance(event, CycleOff))
    assert spindle(operation, after) == (500.0, Sense.CLW), "as the program has it elsewhere"


@pytest.mark.parametrize(
    ("machine", "cycle", "mode", "stroke"),
    [
        ("yl569", "CYCLE84(10,0,3,-20,,,3,,1.5,0,500,500,3,1,0,1,6,1)", ("TAP", "BRKCHP"), 6.0),
        ("yl569", "CYCLE84(10,0,3,-20,,,3,,1.5,0,500,500,3,1,0,2,6)", ("TAP", "DEEP"), 6.0),
        (
            "mikron_600u",
            "CYCL DEF 209 TAP Q200=3 Q201=-20 Q239=+1.5 Q203=0 Q204=10 Q257=6 Q256=1 Q336=0",
            ("TAP", "BRKCHP"),
            6.0,
        ),
    ],
)
def test_strokes_of_a_thread_stay(
    machine: str, cycle: str, mode: tuple[str, ...], stroke: float, tmp_path: Path
) -> None:
    (found,) = cycles(one(machine, THREADS[machine][0].format(cycle=cycle), tmp_path))
    assert found.mode == mode
    assert dict(found.values)["STEP"] == (stroke,)


@pytest.mark.parametrize(
    ("machine", "cycle"),
    [
        ("yl569", "CYCLE840(10,0,3,-20,,,0,3,0,,1.5)"),
        ("mikron_600u", "CYCL DEF 206 TAP Q200=3 Q201=-20 Q206=750 Q211=0.5 Q203=0 Q204=10"),
    ],
)
def test_a_compensating_chuck_and_the_dwell_are_said(machine: str, cycle: str, tmp_path: Path) -> None:
    operation = one(machine, THREADS[machine][0].format(cycle=cycle), tmp_path)
    (found,) = cycles(operation)
    assert dict(found.words) == {"OPTION": ""}
    assert dict(found.values).get("DWELL") == ((0.5,) if machine == "mikron_600u" else None)
    assert not any(isinstance(event, Dwell) for event in operation.events)


@pytest.mark.parametrize(
    ("machine", "cycle"),
    [
        ("yl569", "CYCLE86(10,0,3,-20,,,3,0,0,0,0)"),
        ("mikron_600u", "CYCL DEF 202 BORE Q200=3 Q201=-20 Q206=100 Q211=0 Q208=500 Q203=0 Q204=10 Q214=0 Q336=0"),
        ("matsuura_mx330", "G98 G86 X10. Z-20. R3. F100."),
        ("xyzac_trt", "G98 G86 X10 Z-20 R3 F100 P0"),
        ("hs664rt", "G86 X10. Y0. Z10. E-20. R3. F100"),
    ],
)
def test_a_bore_at_whose_bottom_the_spindle_stops_stays_one(machine: str, cycle: str, tmp_path: Path) -> None:
    assert [found.mode for found in cycles(one(machine, THREADS[machine][0].format(cycle=cycle), tmp_path))] == [
        ("BORE", "DRAG")
    ]


@pytest.mark.parametrize(
    ("machine", "cycle", "what"),
    [
        ("yl569", "CYCLE86(10,0,3,-20,,,3,1,0,0,0)", "stops the spindle at an angle"),
        ("yl569", "CYCLE88(10,0,3,-20,,1,3)", "stops the program at the bottom"),
        (
            "mikron_600u",
            "CYCL DEF 202 BORE Q200=3 Q201=-20 Q206=100 Q211=0 Q208=500 Q203=0 Q204=10 Q214=1 Q336=0",
            "stops the spindle at an angle",
        ),
        ("matsuura_mx330", "G98 G76 X10. Z-20. R3. Q1. F100.", "stops the spindle at an angle"),
        ("matsuura_mx330", "G98 G88 X10. Z-20. R3. F100.", "stops the program at the bottom"),
        ("xyzac_trt", "G98 G88 X10 Z-20 R3 F100 P0", "stops the program at the bottom"),
    ],
)
def test_a_bore_that_needs_an_angle_or_the_operator_is_refused(
    machine: str, cycle: str, what: str, tmp_path: Path
) -> None:
    (tmp_path / "part.nc").write_text(THREADS[machine][0].format(cycle=cycle))
    with pytest.raises(RefusedError, match=what):
        trunnion.convert(tmp_path / "part.nc", machine=machine, to_cl=True)


@pytest.mark.parametrize("lines", ["G331 Z-20 K1.5", "G33 Z-20 K1.5", "G63 Z-20 F750"])
def test_threads_that_the_reader_takes_as_lines_are_refused(lines: str, tmp_path: Path) -> None:
    text = SINUMERIK.replace("MCALL {cycle}", lines)
    (tmp_path / "part.nc").write_text(text)
    with pytest.raises(RefusedError, match="is taken as a straight line"):
        trunnion.convert(tmp_path / "part.nc", machine="yl569", to_cl=True)


def test_a_thread_while_the_spindle_stands_is_refused(tmp_path: Path) -> None:
    text = LINUXCNC.replace(" M3", "").format(cycle="G98 G81 X10 Z-20 R3 F750")
    assert converted("xyzac_trt", text, tmp_path).errors == ()
    text = FIDIA.replace("M3 S500", "S500").format(cycle=THREADS["hs664rt"][1])
    assert [error.what for error in converted("hs664rt", text, tmp_path).errors][:1] == [
        "a thread or bore while the spindle stands still"
    ]
