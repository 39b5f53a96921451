"""What the control's part of a definition is told when it is wrong, before any program is written or read."""

from pathlib import Path

import pytest

import trunnion
from trunnion.cli import main
from trunnion.controls import load_control, shipped_controls
from trunnion.controls.definition_files import load_control_table
from trunnion.controls.setting_rules import SettingKind, SettingRule
from trunnion.controls.vocabulary import PROGRAM_CHOICES, RUN_ONLY_SETTINGS, WRITER_FORMATS
from trunnion.jobs.inputs.run_settings import RUN_SETTINGS

#: A shipped machine for each family.
MACHINES = ("yl569", "dmu65", "matsuura_mx330", "hs664rt", "xyzac_trt")

CL = Path(__file__).parents[1] / "golden" / "yl569" / "2_hub_rough.cls"


def told(tmp_path: Path, capfd: pytest.CaptureFixture[str], machine: str, text: str) -> list[str]:
    """The lines that ``trunnion check`` prints of a machine that extends a shipped one."""
    file = tmp_path / "mine.toml"
    file.write_text(f'extends = "{machine}"\n{text}\n', encoding="utf-8")
    assert main(["check", str(file)]) == 2
    return [line for line in capfd.readouterr().err.splitlines() if "mine.toml" in line]


def test_the_names_of_run_settings_are_those_of_the_post() -> None:
    assert RUN_SETTINGS.keys() - PROGRAM_CHOICES.keys() == RUN_ONLY_SETTINGS


@pytest.mark.parametrize("name", sorted(RUN_ONLY_SETTINGS))
def test_a_definition_cannot_set_what_only_a_run_sets(
    name: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    (line,) = told(tmp_path, capfd, "yl569", f'[control.settings]\n{name} = "1"')
    assert f"mine.toml:3: error: control.settings.{name} is a setting of a run" in line
    assert f"--set {name}=1" in line


def test_a_post_refuses_it_too(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text('extends = "yl569"\n[control.settings]\ncl_units = "inch"\n', encoding="utf-8")
    with pytest.raises(trunnion.InputError, match=r"mine.toml:3: error: control.settings.cl_units is a setting of a"):
        trunnion.post(CL, machine=file)


@pytest.mark.parametrize("machine", MACHINES)
def test_a_template_field_is_no_setting(machine: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    (line,) = told(tmp_path, capfd, machine, '[control.settings]\nhome_x = "1"')
    assert "mine.toml:3: error: control.settings.home_x is a template field" in line


@pytest.mark.parametrize("name", ["units", "times", "tool_list", "preselect", "restart"])
def test_what_a_program_says_may_be_set_by_the_definition(name: str, tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    value = PROGRAM_CHOICES[name][-1]
    file.write_text(f'extends = "yl569"\n[control.settings]\n{name} = "{value}"\n', encoding="utf-8")
    assert main(["check", str(file)]) == 0


@pytest.mark.parametrize("machine", MACHINES)
def test_reading_is_judged_with_the_definition(machine: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    (line,) = told(tmp_path, capfd, machine, "[control.reading]\nbogus = 1")
    assert "mine.toml:3: error: control.reading.bogus is not a key that is known here" in line


@pytest.mark.parametrize(
    ("machine", "entry", "said"),
    [
        ("yl569", 'cycles_along_tool = "no"', "write true or false"),
        ("hs664rt", 'feed_without_tcp = "x"', 'write one of "slides", "all_axes"'),
        ("xyzac_trt", "units = 5", 'write one of "", "mm", "inch"'),
        ("matsuura_mx330", "dwells = 1", 'write one of "milliseconds", "point"'),
        ("matsuura_mx330", 'words = { G234 = "G43.4", "G0234" = "G43.5" }', "says the same as 'G234'"),
    ],
)
def test_values_of_reading_are_judged_too(
    machine: str, entry: str, said: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    (line,) = told(tmp_path, capfd, machine, f"[control.reading]\n{entry}")
    assert "mine.toml:3: error: control.reading" in line
    assert said in line


def test_a_post_refuses_what_no_reader_would_ask_for(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text('extends = "yl569"\n[control.reading]\ncycles_along_tol = true\n', encoding="utf-8")
    for call in (lambda: trunnion.post(CL, machine=file), lambda: trunnion.read_program(CL, machine=file)):
        with pytest.raises(trunnion.InputError, match=r"mine.toml:3: error: control.reading.cycles_along_tol is not"):
            call()


def test_the_file_of_a_control_is_judged_likewise(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(
        'extends = "sinumerik_840d"\nname = "Ours"\n[reading]\nbogus = 1\n[settings]\nmode = "tcp"\n', encoding="utf-8"
    )
    assert main(["check", str(file)]) == 2
    said = capfd.readouterr().err
    assert "mine.toml:4: error: reading.bogus" in said
    assert "mine.toml:6: error: settings.mode is a setting of a run" in said


@pytest.mark.parametrize(
    "field", ["{5:coordinate", "{title!r}", "{title.x}", "{machine:>9}", "[[ {title}", "{title}]]"]
)
def test_a_brace_that_belongs_to_no_field_is_a_mistake(
    field: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    (line,) = told(tmp_path, capfd, "yl569", f'[control.templates]\nprogram_end = "; {field}\\nM30"')
    assert "mine.toml:3: error: control.templates.program_end has a brace that belongs to no field" in line
    assert field in line


@pytest.mark.parametrize("machine", MACHINES)
def test_a_format_with_a_misspelt_name_is_a_mistake(
    machine: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    (line,) = told(tmp_path, capfd, machine, '[[control.format]]\nname = "coordinat"\ndecimals = 4')
    assert "mine.toml:3: error:" in line
    assert "a format that nothing prints" in line
    assert 'did you mean "coordinate"?' in line


@pytest.mark.parametrize("name", shipped_controls())
def test_shipped_controls_have_the_formats_that_writers_use(name: str) -> None:
    control = load_control(load_control_table(name))
    assert {"coordinate", "dwell"} <= control.formats.keys() & WRITER_FORMATS


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("seqno", "SEQNO"),
        ("PPRINT / A,B", "PPRINT/B,A"),
        ("AUXFUN/31", "AUXFUN/31.0"),
        ("ROTATE/TABLE", "ROTATE/table"),
    ],
)
@pytest.mark.parametrize("table", ["control.statements", "cl.words"])
def test_two_entries_of_one_statement_are_a_mistake(
    table: str, first: str, second: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    lines = told(tmp_path, capfd, "yl569", f'[{table}]\n"{first}" = "COOLNT/ON"\n"{second}" = "COOLNT/OFF"')
    assert any(f"mine.toml:4: error: {table}.{second} says the same as {first!r}" in line for line in lines)


@pytest.mark.parametrize(
    ("kind", "wrong", "right"),
    [
        (SettingKind.PATH, ["PARTS", "TNC:\\PARTS", "a/b"], ["PARTS/", "TNC:\\PARTS\\", "/_N_WKS_DIR/"]),
        (SettingKind.M_CODE, ["M0", "M2", "M5", "M06", "M30", "M030", "M98", "M99"], ["M29", "M13", "M428", "M300"]),
        (SettingKind.G_CODE, ["G0", "G01", "G1", "G4"], ["G43.4", "G234", "G5", "G10"]),
    ],
)
def test_words_that_end_or_move_and_folders_without_an_end_are_refused(
    kind: SettingKind, wrong: list[str], right: list[str]
) -> None:
    rule = SettingRule(kind)
    assert not any(rule.allows(text) for text in wrong)
    assert all(rule.allows(text) for text in right)


@pytest.mark.parametrize(
    ("machine", "setting", "said"),
    [
        ("yl569", "call_folder=PARTS", "write a folder with / or \\ at its end"),
        ("dmu65", "call_folder=TNC:\\PARTS", "write a folder with / or \\ at its end"),
        ("matsuura_mx330", "rigid_tap=M30", "write an M code, such as M29"),
        ("xyzac_trt", "tcp_on=M2", "write an M code, such as M29"),
        ("matsuura_mx330", "tcp_on=G0", "write a G code, such as G43.4"),
    ],
)
def test_a_post_refuses_such_a_setting(machine: str, setting: str, said: str) -> None:
    key, _, value = setting.partition("=")
    with pytest.raises(trunnion.InputError) as caught:
        trunnion.post(CL, machine=machine, settings={key: value})
    assert said in str(caught.value)


def test_an_extends_that_goes_round_or_is_too_long_has_its_line(tmp_path: Path) -> None:
    (tmp_path / "loop.toml").symlink_to(tmp_path / "loop.toml")
    for name in ("loop.toml", "a" * 300 + ".toml", "a" * 5000, "a" * 5000 + ".toml"):
        for head in ("", 'name = "x"\n[control]\n'):
            file = tmp_path / "mine.toml"
            file.write_text(f'{head}extends = "{name}"\n', encoding="utf-8")
            with pytest.raises(trunnion.InputError) as caught:
                trunnion.describe_machine(file) if not head else trunnion.describe_control(file)
            assert any(problem.file.endswith("mine.toml") for problem in caught.value.problems)


@pytest.mark.parametrize(
    ("lines", "line", "what"),
    [
        ("{# OURS #}\nM8 %}", 6, "has %} without {% before it: 'M8 %}'; write {% where it begins"),
        ("{# OURS #}\n{title}\n{{ title | uper }}", 7, "no filter or format 'uper'; did you mean \"upper\"?"),
        ("{% if title = 'A' %}\nM8\n{% endif %}", 5, "with =, which compares nothing; write == to compare"),
        ("M8 %}", 5, "has %} without {% before it: 'M8 %}'"),
    ],
)
def test_a_slip_in_a_text_is_told_at_its_line(
    lines: str, line: int, what: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    text = f'[control.templates]\nbefore_operation = """\n;A\n{lines}\n"""'
    (said,) = told(tmp_path, capfd, "yl569", text)
    assert f"mine.toml:{line}: error: control.templates.before_operation" in said
    assert what in said


@pytest.mark.parametrize(
    ("written", "line"),
    [
        ('"""\n{}\n"""', 4),
        ("'''\r\n{}'''", 4),
        ('"""\n\nM30\n{}"""', 6),
        ('"{}"', 3),
        ('"""{}"""', 3),
        ('"""M30\n{}\n"""', 4),
    ],
)
@pytest.mark.parametrize("fault", ["{{ }}", "{nosuch}"])
def test_a_fault_of_a_template_is_told_at_its_own_line(tmp_path: Path, fault: str, written: str, line: int) -> None:
    machine = tmp_path / "ours.toml"
    text = f'extends = "matsuura_mx330"\n[control.templates]\nprogram_end = {written.replace("{}", fault)}\n'
    machine.write_bytes(text.encode())
    with pytest.raises(trunnion.InputError) as caught:
        load_control(trunnion.load_machine(machine).control)
    assert [problem.line for problem in caught.value.problems] == [line]
