"""Programs in inches are read like the same programs in mm: every length, feed and pitch, and nothing else."""

from pathlib import Path

import numpy as np
import pytest

from trunnion.errors import Severity
from trunnion.machines import load_machine
from trunnion.model.run import Run
from trunnion.readers import run_program

#: Blocks in mm, and the same in inches.
SINUMERIK = {
    "inverse time": ("G93 G1 X25.4 F2", "G93 G1 X1 F2"),
    "inverse time, then feed": ("G93 G1 X25.4 F2\nG94 X0 F254", "G93 G1 X1 F2\nG94 X0 F10"),
    "feed per revolution": ("G95 G1 X25.4 F.254", "G95 G1 X1 F.01"),
    "tolerances": ("CYCLE832(0.0254,_FINISH,1)\nCTOL=0.0508", "CYCLE832(0.001,_FINISH,1)\nCTOL=0.002"),
    "deep drilling": (
        "CYCLE83(50.8,0,2.54,-25.4,,-7.62,,2.54,0,0,1,1,3,2.54,0,0,1.27)",
        "CYCLE83(2,0,.1,-1,,-.3,,.1,0,0,1,1,3,.1,0,0,.05)",
    ),
    "deep drilling by a factor": (
        "CYCLE83(50.8,0,2.54,-25.4,,-7.62,,-0.8,0,0,1,0,3,2.54,1.27,0,0)",
        "CYCLE83(2,0,.1,-1,,-.3,,-0.8,0,0,1,0,3,.1,.05,0,0)",
    ),
    "chip breaks by default": ("CYCLE83(50.8,0,2.54,-25.4,,-7.62)", "CYCLE83(2,0,.1,-1,,-.3)"),
    "thread": ("CYCLE84(50.8,0,2.54,-25.4,,,3,,1.27,0,500,500)", "CYCLE84(2,0,.1,-1,,,3,,.05,0,500,500)"),
    "thread in mm": (
        "CYCLE84(50.8,0,2.54,-25.4,,,3,,1.25,0,500,500,3,1)",
        "CYCLE84(2,0,.1,-1,,,3,,1.25,0,500,500,3,1)",
    ),
    "thread in inches": (
        "CYCLE84(50.8,0,2.54,-25.4,,,3,,.05,0,500,500,3,3,0,1,5.08,1.27)",
        "CYCLE84(2,0,.1,-1,,,3,,.05,0,500,500,3,3,0,1,.2,.05)",
    ),
    "floating thread": ("CYCLE840(50.8,0,2.54,-25.4,,,0,3,0,,1.27)", "CYCLE840(2,0,.1,-1,,,0,3,0,,.05)"),
    "reaming": ("CYCLE85(50.8,0,2.54,-25.4,,,254,508)", "CYCLE85(2,0,.1,-1,,,10,20)"),
    "boring": ("CYCLE86(50.8,0,2.54,-25.4,,,3,.508,0,0,45)", "CYCLE86(2,0,.1,-1,,,3,.02,0,0,45)"),
}


def run_text(folder: Path, machine: str, text: str) -> Run:
    path = folder / "p.nc"
    path.write_text(text, encoding="utf-8")
    return run_program(path, load_machine(machine))


def same(first: Run, second: Run) -> None:
    assert [d for d in (*first.diagnostics, *second.diagnostics) if d.severity is Severity.ERROR] == []
    assert len(first) == len(second)
    for name in ("tip", "feed", "kind", "feed_mode"):
        np.testing.assert_allclose(getattr(first, name), getattr(second, name), rtol=1e-12, atol=1e-9, err_msg=name)
    for one, other in zip(first.spindle_holes, second.spindle_holes, strict=True):
        assert one.first == other.first
        lengths = [(work.pitch, work.stroke, work.clearance) for work in (one.work, other.work)]
        np.testing.assert_allclose(lengths[0], lengths[1], rtol=1e-12)
    assert tolerances(first) == pytest.approx(tolerances(second))


def tolerances(run: Run) -> list[float]:
    return [event.value for event in run.events if event.kind == "tolerance" and isinstance(event.value, float)]


@pytest.mark.parametrize("name", SINUMERIK)
def test_sinumerik(name: str, tmp_path: Path) -> None:
    mm, inch = SINUMERIK[name]
    head = "G17 G90 G94\nT1 M6\nM3 S500\nG54 D1\n"
    same(
        run_text(tmp_path, "yl569", f"G710 {head}G0 X0 Y0 Z76.2\nG1 F127\n{mm}\nM30\n"),
        run_text(tmp_path, "yl569", f"G700 {head}G0 X0 Y0 Z3\nG1 F5\n{inch}\nM30\n"),
    )


def test_klartext_counts_tenths_of_an_inch_a_minute(tmp_path: Path) -> None:
    program = "0 BEGIN PGM A {}\n1 TOOL CALL 1 Z S500\n2 L X+{} Y+0 R0 FMAX M3\n3 L X+0 F{}\n4 M30\n5 END PGM A {}\n"
    mm = run_text(tmp_path, "dmu65", program.format("MM", 25.4, 254, "MM"))
    inch = run_text(tmp_path, "dmu65", program.format("INCH", 1, 100, "INCH"))
    same(mm, inch)


@pytest.mark.parametrize(
    ("machine", "text", "what"),
    [
        ("dmu65", "0 BEGIN PGM A INCH\n1 M136\n2 L X+1 F0.1\n3 END PGM A INCH\n", "M136 in inches"),
        ("hs664rt", "G70\nG1 X1. F100\nM02\n", "G70: what F counts"),
    ],
)
def test_feeds_whose_unit_no_source_tells_are_errors(machine: str, text: str, what: str, tmp_path: Path) -> None:
    errors = [d.text for d in run_text(tmp_path, machine, text).diagnostics if d.severity is Severity.ERROR]
    assert any(error.startswith(what) for error in errors), errors
