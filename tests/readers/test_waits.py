"""Words with which a program waits or stops are told, with how long or for what."""

from pathlib import Path

import pytest

import trunnion
from tests.support.block_frames import HEADS, TAILS
from tests.support.locations import TESTS

#: A machine, a block, and what is told of it; nothing where it is sound.
WAITS = [
    ("yl569", "G4 F99999", "a dwell of 27:46:39 h"),
    ("yl569", "G4 F60", ""),
    ("yl569", "G4 F61", "a dwell of 1:01 min"),
    ("yl569", "G4 S10000", "a dwell of 20:00 min"),
    ("yl569", "G4 S100", ""),
    ("yl569", "SETAL(65000)", "SETAL(65000) raises an alarm"),
    ("yl569", "WAITM(1,1,2)", "WAITM waits for another"),
    ("yl569", "STOPRE", ""),
    ("yl569", 'MSG("WAIT")', ""),
    ("matsuura_mx330", "G4 P3600000", "a dwell of 1:00:00 h"),
    ("matsuura_mx330", "G4 X90.", "a dwell of 1:30 min"),
    ("matsuura_mx330", "G4 P500", ""),
    ("matsuura_mx330", "#3006=1(CHECK PART)", "#3006 stops the program"),
    ("haas_umc750", "IF [1 EQ 1] THEN #3006=1", "#3006 stops the program"),
    ("matsuura_mx330", "IF [1 EQ 2] THEN #3000=1", ""),
    ("haas_umc750", "G4 P120.", "a dwell of 2:00 min"),
    ("haas_umc750", "G4 P120", ""),
    ("xyzac_trt", "G4 P500", "a dwell of 8:20 min"),
    ("xyzac_trt", "M66 P3 L3 Q90", "M66 waits for an input, up to 1:30 min"),
    ("xyzac_trt", "M66 P3 L0", ""),
    ("hs664rt", "G4 HD300.", "a dwell of 5:00 min"),
    ("dmu65", "CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 3600", "a dwell of 1:00:00 h"),
    ("dmu65", "CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 2", ""),
    ("dmu65", "FN 14: ERROR=1000", "FN 14 stops the program"),
    ("dmu65", "FN 20: WAIT FOR M1==1", "FN 20 waits for the PLC"),
]


@pytest.mark.parametrize(("machine", "block", "told"), WAITS)
def test_a_wait_is_told_with_its_time_or_its_reason(tmp_path: Path, machine: str, block: str, told: str) -> None:
    program = tmp_path / "part.nc"
    program.write_text(HEADS[machine] + block + "\n" + TAILS.get(machine, "M30\n"), encoding="utf-8")
    run = trunnion.read_program(program, machine=machine)
    found = [each.text for each in run.diagnostics if each.code == "NC226"]
    assert [told in text for text in found] == ([True] if told else [])
    assert not run.errors


def test_a_wait_in_a_loop_is_told_once(tmp_path: Path) -> None:
    program = tmp_path / "part.mpf"
    loop = "FOR R1=1 TO 50\nG4 F99\nENDFOR\n"
    program.write_text(HEADS["yl569"] + loop + "M30\n", encoding="utf-8")
    run = trunnion.read_program(program, machine="yl569")
    assert sum(event.kind == "dwell" for event in run.events) == 50
    assert [each.text for each in run.diagnostics if each.code == "NC226"] == [
        "a dwell of 1:39 min: is its unit right?"
    ]


def test_post_names_the_waits_of_templates_and_counts_them(tmp_path: Path) -> None:
    cl = (TESTS / "data" / "shop.cls").read_text(encoding="utf-8").replace("BORHED/40.5,DEEP\n", "")
    (tmp_path / "part.cls").write_text(cl, encoding="utf-8")
    machine = tmp_path / "ours.toml"
    text = "after_operation = '''\nG4 F7200\nM0\n'''\ntool_list = ';TAKES {{ operations | first }} {time}'"
    machine.write_text(f'extends = "yl569"\n[control.templates]\n{text}\n', encoding="utf-8")
    posted = trunnion.post(tmp_path / "part.cls", machine=machine, settings={"tool_list": "on"})
    assert posted.passed
    assert [problem.code for problem in posted.problems] == ["NC226"] * 3
    assert all("a dwell of 2:00:00 h" in problem.what for problem in posted.problems)
    assert posted.verification is not None
    stops = {check.key: check for check in posted.verification.checks}["stops"]
    assert stops.summary == "1 stop; 3 dwells of 6:00:00 h and 3 stops of the program's own between operations"
    assert posted.text is not None
    assert "TAKES ROUGH TOP 2:00:0" in posted.text


@pytest.mark.parametrize("machine", ["matsuura_mx330", "haas_umc750"])
def test_an_alarm_is_an_error_and_a_message_a_stop(tmp_path: Path, machine: str) -> None:
    program = tmp_path / "part.nc"
    program.write_text(HEADS[machine] + "G0 X1.\n#3006=1(CHECK)\nG0 X2.\n#3000=7(BAD)\nG0 X3.\nM30\n%\n")
    run = trunnion.read_program(program, machine=machine)
    (error,) = run.errors
    assert (error.code, error.text) == ("NC226", "#3000 raises alarm 7: the program goes no farther")
    assert [event.kind for event in run.events if event.kind == "stop"] == ["stop"]
