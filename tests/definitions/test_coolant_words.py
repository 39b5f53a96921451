"""Coolants whose M codes a control, or another table of the definition, takes for something else."""

from pathlib import Path

import pytest

from trunnion.cli import main

#: A shipped machine for each family.
MACHINES = ("yl569", "dmu65", "ucp800", "matsuura_mx330", "haas_umc750", "hs664rt", "xyzac_trt")


def told(tmp_path: Path, capsys: pytest.CaptureFixture[str], machine: str, text: str) -> str:
    """What ``trunnion check`` prints of a machine that extends a shipped one; empty: it is good."""
    file = tmp_path / "mine.toml"
    file.write_text(f'extends = "{machine}"\n{text}\n', encoding="utf-8")
    code = main(["check", str(file)])
    error = capsys.readouterr().err
    assert (code == 0) is (not error)
    return error


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("stated", ["AIR = 0", "AIR = 19", "THRU = 2", "AIR = 8", "MIST = 9", "FLOOD = 9"])
def test_no_coolant_has_a_word_of_the_control(
    machine: str, stated: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    if machine == "yl569" and stated == "AIR = 19":
        stated = "AIR = 17"  # the end of a subprogram
    line = told(tmp_path, capsys, machine, f"[control.coolant]\n{stated}")
    assert "mine.toml:3: error: control.coolant." in line
    assert "[DEF330]" in line


@pytest.mark.parametrize(
    ("machine", "stated"),
    [("dmu65", "AIR = 128"), ("dmu65", "AIR = 13"), ("matsuura_mx330", "AIR = 98"), ("xyzac_trt", "THRU = 48")],
)
def test_nor_one_that_only_its_family_has(
    machine: str, stated: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert "is a word of the control itself" in told(tmp_path, capsys, machine, f"[control.coolant]\n{stated}")


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize(
    ("kind", "effect", "fits"),
    [
        ("THRU", "coolant through", True),
        ("THRU", "no effect: pump", True),
        ("THRU", "coolant off", False),
        ("THRU", "coolant mist", False),
        ("THRU", "spindle off, coolant through", True),
        ("THRU", "spindle off", False),
        ("MIST", "coolant mist", True),
        ("MIST", "coolant flood", False),
        ("AIR", "waits", True),
        ("AIR", "coolant mist", False),
        ("AIR", "spindle off", False),
        ("ON", "coolant flood", True),
        ("OFF", "coolant off", True),
        ("OFF", "coolant flood", False),
    ],
)
def test_both_tables_say_the_same_of_a_code(
    machine: str, kind: str, effect: str, fits: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = f'[control.coolant]\n{kind} = 88\n[control.known]\nM88 = "{effect}"'
    line = told(tmp_path, capsys, machine, text)
    if fits:
        assert not line
    else:
        assert f"mine.toml:3: error: control.coolant.{kind} is M88, of which [control.known] says" in line


@pytest.mark.parametrize("stated", ["ON = 7", "TAP = 7", "THRU = 88\nON = 88\nTAP = 88", 'MIST = "none"\nAIR = 51'])
def test_on_and_tap_are_names_for_any_coolant(stated: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for machine in ("yl569", "matsuura_mx330"):
        told_of = told(tmp_path, capsys, machine, f"[control.coolant]\n{stated}")
        assert "is M7, which is MIST" in told_of if "= 7" in stated else not told_of
