"""A control family that the package does not know: a writer, a reader, a TOML file and one registry entry.

Its blocks name motions by words. Programs for it are posted, proven, verified and converted like any others.
"""

from pathlib import Path

import pytest

from tests.support.locations import YL569
from trunnion.cli import main
from trunnion.machines import load_machine
from trunnion.model.toolpath import Kind
from trunnion.readers import run_program

pytestmark = pytest.mark.usefixtures("toy_family")

MACHINE = Path(__file__).parent / "toy" / "yl569_toy.toml"
BLADE = YL569 / "3_blade_finish.cls"

#: Three-axis milling with circles either way, a dwell, a stop and coolant.
PLATE = """TOOL PATH/PLATE,TOOL,D10
TLDATA/MILL,10.0000,0.0000,75.0000,0.0000,0.0000
MSYS/0.0000,0.0000,0.0000,1.0000000,0.0000000,0.0000000,0.0000000,1.0000000,0.0000000
LOAD/TOOL,3
SPINDL/RPM,1000.0000,CLW
COOLNT/ON
RAPID
GOTO/0.0000,0.0000,50.0000,0.0000000,0.0000000,1.0000000
FEDRAT/MMPM,250.0000
GOTO/0.0000,0.0000,5.0000
DELAY/1.5
CIRCLE/10.0,0.0,5.0,0.0,0.0,1.0,10.0,0.06,0.5,10.0,0.0
GOTO/10.0000,-10.0000,5.0000
CIRCLE/10.0,-20.0,5.0,0.0,0.0,-1.0,10.0,0.06,0.5,10.0,0.0
GOTO/20.0000,-20.0000,5.0000
OPSTOP
GOTO/30.0000,-20.0000,5.0000
RAPID
GOTO/30.0000,-20.0000,60.0000
END-OF-PATH
"""


def post(cl: Path, target: Path) -> str:
    assert main(["post", str(cl), "--machine", str(MACHINE), "--output", str(target)]) == 0
    return target.read_text(encoding="utf-8")


def test_a_five_axis_program_is_posted_with_its_proof_and_read_back(tmp_path: Path) -> None:
    program = tmp_path / "blade.toy"
    text = post(BLADE, program)
    assert "N7 TCP ON\nN8 RAPID X54.13516 Y-0.31289 Z-15.03633 S2500 M3\nN9 LINE X52.29363 Y-0.65697" in text
    run = run_program(program, load_machine(MACHINE))
    assert run.errors == ()
    assert run.tcp.sum() == 147


def test_a_three_axis_program_has_circles_and_events(tmp_path: Path) -> None:
    cl, program = tmp_path / "plate.cls", tmp_path / "plate.toy"
    cl.write_text(PLATE, encoding="utf-8")
    text = post(cl, program)
    assert "CCW X10. Y-10. I10. J0.\n" in text
    assert "CW X20. Y-20. I10. J-20.\n" in text
    assert "WAIT 1.5\n" in text
    run = run_program(program, load_machine(MACHINE))
    assert run.errors == ()
    assert (run.kind == Kind.ARC).sum() == 2
    assert [event.kind for event in run.events if event.kind in ("dwell", "optional_stop")] == [
        "dwell",
        "optional_stop",
    ]


def test_verification_finds_a_changed_number(tmp_path: Path) -> None:
    program = tmp_path / "blade.toy"
    text = post(BLADE, program)
    verify = ["verify", str(program), "--machine", str(MACHINE), "--cl", str(BLADE)]
    assert main(verify) == 0
    program.write_text(text.replace("X48.0487 ", "X48.1487 "), encoding="utf-8")
    assert main(verify) == 1


def test_a_program_goes_to_sinumerik_and_comes_back_byte_for_byte(tmp_path: Path) -> None:
    first, sinumerik, second = tmp_path / "first.toy", tmp_path / "blade.mpf", tmp_path / "second.toy"
    text = post(BLADE, first)
    to_sinumerik = ["convert", str(first), "--machine", str(MACHINE), "--to-machine", "yl569"]
    assert main([*to_sinumerik, "--output", str(sinumerik)]) == 0
    assert "TRAORI" in sinumerik.read_text(encoding="utf-8")
    back = ["convert", str(sinumerik), "--machine", "yl569", "--to-machine", str(MACHINE)]
    assert main([*back, "--output", str(second)]) == 0
    assert second.read_text(encoding="utf-8") == text


def test_what_the_family_lacks_is_refused_with_its_reason(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cl, program = tmp_path / "plate.cls", tmp_path / "plate.toy"
    cl.write_text(PLATE.replace("FEDRAT/MMPM,250.0000", "FEDRAT/MMPR,0.1"), encoding="utf-8")
    assert main(["post", str(cl), "--machine", str(MACHINE), "--output", str(program)]) == 2
    assert "error: a feed per revolution; output it in mm/min" in capsys.readouterr().err
    assert not program.exists()
