"""Every mistake of a definition comes at once, each told once, with what to write instead."""

import re
from pathlib import Path

import pytest

import trunnion
from trunnion.cli import main
from trunnion.errors import InputError
from trunnion.machines import load_machine

AXES_OF_CONTROL = 'extends = "yl569"\nname = "OURS"\n'


def told(folder: Path, capsys: pytest.CaptureFixture[str], text: str, code: int = 2) -> list[str]:
    """What ``check`` says of a definition, without the name of its file."""
    file = folder / "ours.toml"
    file.write_text(text, encoding="utf-8")
    assert main(["check", str(file)]) == code
    return capsys.readouterr().err.replace(str(file), "").splitlines()


def test_mistakes_of_axes_and_of_the_control_come_together(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = (
        f'{AXES_OF_CONTROL}[[axis]]\nname = "W"\nkind = "linear"\n[control.known]\nM30 = "no effect"\nM80 = 5\n'
        '[control.statements]\nGOTO = "M1"\n[control.settings]\nedge = [2]\n'
    )
    lines = told(tmp_path, capsys, text)
    assert [line.split(";")[0] for line in lines] == [
        ":3: error: axis W carries is missing",
        ":3: error: axis W direction is missing",
        ":3: error: axis has 4 linear and 2 rotary axes (X, Y, Z, W, C, B)",
        ":7: error: control.known.M30 is a word of the control itself, or begins with one: "
        "the declaration would hide it",
        ":8: error: control.known.M80 is 5",
        ":10: error: control.statements.GOTO is a statement that is read: the entry would never count",
        ":12: error: control.settings.edge is [2]",
    ]
    assert lines[-1].endswith("write a text in quotes, or a number [DEF330]")


@pytest.mark.parametrize(
    ("stated", "other"),
    [
        ("ON = 9", "OFF"),
        ("OFF = 8", "(OFF|FLOOD)"),
        ("THRU = 4", "spindle_counterclockwise"),
        ("MIST = 30", "the end of a program"),
        ("MIST = 8", "FLOOD"),
        ("AIR = 8", "FLOOD"),
    ],
)
def test_a_coolant_has_the_number_of_no_other_word(
    stated: str, other: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lines = told(tmp_path, capsys, f"{AXES_OF_CONTROL}[control.coolant]\n{stated}\n")
    assert lines
    assert all(re.search(f", which is {other}[ ;].*write the M number", line) for line in lines)


def test_a_name_that_stands_twice_is_one_mistake(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    axes = '[[axis]]\nname = "B"\nlimits_deg = [-5, 95]\n[[axis]]\nname = "B"\nhome_deg = 3\n'
    (line,) = told(tmp_path, capsys, AXES_OF_CONTROL + axes)
    assert line.startswith(':6: error: axis[1].name is "B" a second time (first in line 3); write all')
    formats = '[[control.format]]\nname = "feed"\n[[control.format]]\nname = "feed"\n'
    (line,) = told(tmp_path, capsys, AXES_OF_CONTROL + formats)
    assert 'name is "feed" a second time' in line


@pytest.mark.parametrize(("twice", "key"), [('name = "b"\n', "name"), ("[control]\n[control]\n", "[control]")])
def test_a_key_that_stands_twice_is_named(
    twice: str, key: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (line,) = told(tmp_path, capsys, AXES_OF_CONTROL + twice)
    assert f"is not TOML: {key} is there already; write each key and each [table] once" in line


@pytest.mark.parametrize("limits", ["[-1e308, 1e308]", "[-inf, 1e10]", "[0, 1000000001]"])
@pytest.mark.filterwarnings("error")
def test_a_number_that_no_machine_has_is_refused(
    limits: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (line,) = told(tmp_path, capsys, f'{AXES_OF_CONTROL}[[axis]]\nname = "X"\nlimits_mm = {limits}\n')
    assert line.endswith("low < high, in millimetres, from -1e+09 to 1e+09 [DEF330]")
    axis = f"{AXES_OF_CONTROL}[workpiece]\nzero_mm = [0, 0, -1e200]\n[spindle]\nmax_rpm = 1e99\n"
    assert all(line.endswith("from -1e+09 to 1e+09 [DEF330]") for line in told(tmp_path, capsys, axis))


def test_a_coolant_that_does_not_exist_names_all_that_do(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (line,) = told(tmp_path, capsys, f"{AXES_OF_CONTROL}[control.coolant]\nHIGH = 88\n")
    assert line.endswith("known here: AIR, FLOOD, MIST, OFF, ON, TAP, THRU [DEF320]")


@pytest.mark.parametrize(
    "entry", ["GOTO", "TLDATA", "INSERT", "COOLNT/ON", "SPINDL/RPM", "CYCLE/DRILL", "STOP", "FINI"]
)
def test_entries_of_statements_that_are_read_are_refused(entry: str, tmp_path: Path) -> None:
    file = tmp_path / "ours.toml"
    for table, value in (("control.statements", "M1"), ("cl.words", "COOLNT/AIR")):
        file.write_text(f'{AXES_OF_CONTROL}[{table}]\n"{entry}" = "{value}"\n', encoding="utf-8")
        with pytest.raises(InputError, match=f"{table}.{entry} is a statement that is read"):
            trunnion.post([], machine=file)


@pytest.mark.parametrize(
    "entry",
    [
        *("ROTATE/TABLE", "AUXFUN/31", "SEQNO", "MY_EVENT", "LOADTL/FOO", "SPINDL/HIGH", "COOLNT/BLAST", "CUTCOM/FOO"),
        *("DELAY/FOO", "OPSKIP/FOO", "LOAD/MAGAZ", "CYCLE/FOO", "RAPID/FOO", "PAINT"),
    ],
)
def test_entries_of_statements_that_can_be_unknown_are_taken(
    entry: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert not told(tmp_path, capsys, f'{AXES_OF_CONTROL}[control.statements]\n"{entry}" = "M1"\n', code=0)


def test_the_file_of_a_control_is_told_from_that_of_a_machine(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "shop.toml"
    file.write_text('extends = "sinumerik_840d"\nname = "S"\n[settings]\nedge = "2"\n', encoding="utf-8")
    assert main(["post", "part.cls", "--machine", str(file)]) == 2
    assert "shop.toml: error: defines a control, not a machine; give a machine whose" in capsys.readouterr().err
    assert main(["check", str(file)]) == 0
    assert main(["check", "sinumerik_840d"]) == 0
    capsys.readouterr()
    assert main(["check", "sinumerik_840"]) == 2
    err = capsys.readouterr().err
    assert 'no shipped machine or control of this name; did you mean "sinumerik_840d"?' in err


def test_capitals_of_the_extension_are_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "SHOP.TOML").write_text('extends = "yl569"\n', encoding="utf-8")
    (line,) = told(tmp_path, capsys, 'extends = "SHOP.TOML"\nname = "A"\n')
    assert line.endswith(".toml in small letters [DEF210]")
    with pytest.raises(InputError, match=r"whose name ends in \.toml, in small letters"):
        load_machine(tmp_path / "SHOP.TOML")
