"""Settings of a post: what they may be, whether they come from the command line or from a script."""

from pathlib import Path

import pytest

import trunnion
from tests.support.locations import YL569
from trunnion.cli import main
from trunnion.controls import load_control
from trunnion.jobs.inputs.settings import Settings, control_setting_faults
from trunnion.machines.loading import shipped_machines

CL = YL569 / "2_hub_rough.cls"
PROGRAM = YL569 / "2_hub_rough.expected.mpf"


@pytest.mark.parametrize(
    "zero",
    [(1.0, 2.0, float("nan")), "0,0,inf", "-inf,0,0", "nan,0,0", (0.0, 0.0, 1e9), "0,0,-1e300", (0.0, 0.0), "1,2,3,4"],
)
@pytest.mark.filterwarnings("error")
def test_a_workpiece_zero_is_three_finite_lengths(zero: object) -> None:
    with pytest.raises(trunnion.InputError, match="zero is"):
        trunnion.post(CL, machine="yl569", settings={"zero": zero})  # type: ignore[dict-item]
    with pytest.raises(trunnion.InputError, match="zero: error: is"):
        trunnion.verify(PROGRAM, machine="yl569", zero=zero)  # type: ignore[arg-type]
    with pytest.raises(trunnion.InputError, match="zero: error: is"):
        trunnion.convert(PROGRAM, machine="yl569", to_cl=True, zero=zero)  # type: ignore[arg-type]


@pytest.mark.parametrize("length", [float("nan"), float("inf"), "nan", -1.0, 1e9])
def test_a_tool_length_is_finite(length: object) -> None:
    with pytest.raises(trunnion.InputError, match="tool_length: error: is"):
        trunnion.verify(PROGRAM, machine="yl569", tool_length=length)  # type: ignore[arg-type]


def test_the_command_refuses_an_endless_workpiece_zero(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    output = tmp_path / "p.mpf"
    code = main(["post", str(CL), "--machine", "yl569", "--set", "zero=0,0,inf", "--output", str(output)])
    assert (code, output.exists()) == (2, False)
    assert "zero is '0,0,inf'" in capsys.readouterr().err


def test_a_run_keeps_the_setup_with_which_it_was_read() -> None:
    """Its slides were computed with the workpiece zero and the tool length of its machine."""
    run = trunnion.read_program(PROGRAM, machine="yl569")
    for setup in ({"zero": (0, 0, 5000)}, {"tool_length": 100.0}, {"subprograms": ["sub.spf"]}):
        with pytest.raises(trunnion.InputError, match="already been read"):
            trunnion.verify(run, machine="yl569", **setup)
    with pytest.raises(trunnion.InputError, match="was read for"):
        trunnion.verify(run, machine="dmu65")
    with pytest.raises(trunnion.InputError, match="was read for"):
        trunnion.diff(run, PROGRAM, machine="dmu65", to_machine="yl569")


#: A machine for each control, and settings that it cannot have.
REFUSED: dict[str, dict[str, list[str | float]]] = {
    "yl569": {
        "tolerance": ["-1", "0", "x", "nan", "inf", "11", "1e-2", "0.000001", -1, float("nan")],
        "three_axis_tolerance": ["-1", "0"],
        "fallback_tolerance": ["-1", "abc"],
        "edge": ["99", "0", "-1", "1.5", "x", "", "\u00b2"],
        "stock": ["thick", "1e5"],
        "cycle832": ["x", "_ORI_FINISH,1"],
        "tool_call": ["nam"],
        "tool": ["0", '"MILL "10"'],
        "method": ['A"B'],
        "swivel_data": ["TABLE", '"A",1'],
        "swivel_retract": ["9", "-1", ""],
        "swivel_style": ["1", "x"],
        "call_folder": ['A"', "A B"],
        "plane": ["cycle80"],
        "work_offset": ["G99", "54", "g55", "G58", "G504", ""],
        "title": ["two\nlines", "a\u2028b", "\ud800"],
    },
    "dmu65": {
        "tolerance": [-1, "0"],
        "hsc_mode": [7, "x"],
        "rotary_tolerance": ["x", "-1"],
        "delta_length": ["100", "x"],
        "delta_radius": ["-100"],
        "work_offset": ["x", "-1"],
        "call_folder": ["A B"],
        "tool": ["0", 'A"B'],
    },
    "matsuura_mx330": {
        "rigid_tap": ["X5", "M"],
        "work_offset": ["G99", "G54.1 P0", "G54.1 P301"],
        "tool": ["MILL", "0"],
        "tool_call": ["x"],
    },
    "hs664rt": {
        "work_offset": ["foo", "G55", "G55 O0"],
        "rapid_feed": ["0", "1.5", "x", "-1"],
        "tcp_on": ["G1", "G96"],
        "tcp_off": ["G1"],
        "tool": ["MILL"],
    },
    "linuxcnc_5axis": {
        "tolerance": ["-1", "x"],
        "fallback_tolerance": ["0"],
        "tool": ["MILL", "0"],
        "work_offset": ["foo", "G59.4"],
    },
}


@pytest.mark.third
@pytest.mark.parametrize(("machine", "key"), [(machine, key) for machine, keys in REFUSED.items() for key in keys])
def test_what_a_setting_cannot_be_is_refused_before_any_work(machine: str, key: str) -> None:
    for value in REFUSED[machine][key]:
        with pytest.raises(trunnion.InputError) as raised:
            trunnion.plan("no such file", machine=machine, settings={key: value})
        (problem,) = raised.value.problems
        assert (problem.file, problem.what.split(" ")[0], bool(problem.cure)) == ("settings", key, True)


#: Settings of each control that it can have.
ALLOWED: dict[str, list[Settings]] = {
    "yl569": [
        {"tolerance": "0.01", "three_axis_tolerance": 0.02, "stock": -0.2, "edge": 2, "tool": 5, "method": "FINISH"},
        {"cycle832": "_ORI_SEMIFIN", "tool": "MILL 10", "swivel_data": '"TABLE"', "call_folder": "/_N_WKS_DIR/"},
        {"tool": '"MILL 10"', "title": None, "date": None, "edge": None},
    ],
    "dmu65": [{"hsc_mode": "1", "rotary_tolerance": 0.05, "tolerance": 0.02, "tool": "MILL 10", "delta_radius": -0.05}],
    "matsuura_mx330": [{"rigid_tap": "", "tool": 7}, {"rigid_tap": "M135"}],
    "hs664rt": [{"rapid_feed": 5000, "tcp_on": "G196", "tcp_off": "G197"}],
}


@pytest.mark.parametrize("machine", ALLOWED)
def test_what_a_setting_can_be_is_posted_and_proven(machine: str) -> None:
    for settings in ALLOWED[machine]:
        assert trunnion.post(CL, machine=machine, settings=settings, columns=False).passed


def test_a_name_of_a_tool_needs_no_quotation_marks() -> None:
    plain = trunnion.post(CL, machine="yl569", settings={"tool": "MILL 10"})
    assert plain.text is not None
    assert 'T="MILL 10"' in plain.text
    assert plain.text == trunnion.post(CL, machine="yl569", settings={"tool": '"MILL 10"'}).text


def test_none_is_not_set() -> None:
    settings = {"title": None, "date": None, "tolerance": None, "zero": None, "tcp": None}
    assert trunnion.post(CL, machine="yl569", settings=settings).text == trunnion.post(CL, machine="yl569").text


def test_every_default_of_every_machine_can_be_set() -> None:
    for name in shipped_machines():
        machine = trunnion.load_machine(name)
        control = load_control(machine.control)
        assert not control_setting_faults(control.settings, control, machine)


def test_an_unknown_setting_is_told_with_the_one_that_resembles_it() -> None:
    with pytest.raises(trunnion.InputError, match='titel is not a setting of Sinumerik 840D sl; did you mean "title"'):
        trunnion.plan(CL, machine="yl569", settings={"titel": "x"})
    for other in ("speed", "spindle_sense"):
        with pytest.raises(trunnion.InputError, match='did you mean "spindle"'):
            trunnion.plan(CL, machine="yl569", settings={other: "2500"})


def test_the_command_names_its_option(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    output = str(tmp_path / "p.mpf")
    assert main(["post", str(CL), "--machine", "yl569", "--set", "tolerance=abc", "--output", output]) == 2
    said = capsys.readouterr().err
    assert said.startswith("--set: error: tolerance is 'abc'; write a number in mm above 0 and of at most 10")


def test_a_program_whose_settings_another_control_cannot_have_is_converted_without_them(tmp_path: Path) -> None:
    program = tmp_path / "p.mpf"
    program.write_bytes(PROGRAM.read_bytes().replace(b"_camtolerance=.06", b"_camtolerance=60."))
    converted = trunnion.convert(program, machine="yl569", to_machine="dmu65")
    assert "tolerance" not in converted.settings
    assert any("cannot have" in problem.what for problem in converted.problems)


DEFINITION = """
extends = "yl569"
name = "wrong settings"

[control.settings]
edge = "99"
own = "x"

[control.setting_rules]
own = { kind = "number", at_most = 5 }
nowhere = { kind = "number" }
stock = { kind = "colour" }
"""


def test_a_definition_is_judged_by_its_own_rules(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "m.toml"
    file.write_text(DEFINITION, encoding="utf-8")
    assert main(["check", str(file)]) == 2
    said = capsys.readouterr().err
    for text in (
        f"{file}:6: error: control.settings.edge is '99'; write a whole number of at least 1 and of at most 12",
        f"{file}:7: error: control.settings.own is 'x'; write a number of at most 5",
        "control.setting_rules.nowhere is the rule of no setting",
        f'{file}:12: error: control.setting_rules.stock.kind is "colour"',
    ):
        assert text in said, said


def test_a_setting_of_ones_own_has_a_rule_of_ones_own(tmp_path: Path) -> None:
    file = tmp_path / "m.toml"
    own = '[control.settings]\nown = ""\n[control.setting_rules]\nown = { kind = "number", at_most = 5 }\n'
    file.write_text(f'extends = "yl569"\nname = "own"\n{own}', encoding="utf-8")
    with pytest.raises(trunnion.InputError, match="own is '6'; write a number of at most 5, or nothing"):
        trunnion.plan(CL, machine=file, settings={"own": 6})


#: Two work offsets of each control, and what messages call them.
OFFSETS = {
    "yl569": (("G55", "G55"), ("G505", "G505")),
    "dmu65": (("1", "preset 1"), ("7", "preset 7")),
    "matsuura_mx330": (("G55", "G55"), ("G54.1 P3", "G54.1 P3")),
    "hs664rt": (("G55 O1", "G55 O1"), ("G55 O2", "G55 O2")),
    "linuxcnc_5axis": (("G55", "G55"), ("G59.1", "G59.1")),
}


@pytest.mark.parametrize("machine", OFFSETS)
def test_work_offsets_are_proven_and_called_as_the_control_does(machine: str, tmp_path: Path) -> None:
    for (said, name), (other, other_name) in (OFFSETS[machine], OFFSETS[machine][::-1]):
        output = tmp_path / "p.nc"
        result = trunnion.post(CL, machine=machine, output=output, settings={"work_offset": said}, columns=False)
        assert [check.summary for check in result.checks if check.key == "offset"] == [f"{name} throughout"]
        for asked in (said, name):
            assert trunnion.verify(output, machine=machine, cl=CL, work_offset=asked, columns=False).passed
        found = trunnion.verify(output, machine=machine, cl=CL, work_offset=other, columns=False)
        (check,) = [check for check in found.checks if not check.passed]
        assert check.key == "offset"
        assert f"works in {name}, not in {other_name}" in check.summary


def test_a_setting_with_two_values_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["post", "part.cls", "--machine", "yl569", "--set", "work_offset=G57", "--set", "work_offset=SIDES:G55"])
    assert ended.value.code == 2
    assert "work_offset has two values, 'G57' and 'SIDES:G55'; write one" in capsys.readouterr().err
