"""``trunnion convert`` as a user meets it."""

import re
import shlex
from importlib.resources import files
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import HEADS, YL569
from tests.support.program_text import motion_part
from tests.support.proof import unproven
from trunnion.cl import read_cl
from trunnion.cli import main
from trunnion.controls import load_control
from trunnion.machines import load_machine

Capture = pytest.CaptureFixture[str]

CASES = sorted(path.stem.removesuffix(".expected") for path in YL569.glob("*.mpf"))
HUB = YL569 / "2_hub_rough.expected.mpf"


def there_and_back(program: Path, folder: Path, capfd: Capture) -> bytes:
    """NC to CL by ``convert``, and back by the ``post`` command that it prints."""
    cl, again = folder / "x.cls", folder / "x.mpf"
    assert main(["convert", str(program), "--machine", "yl569", "--to-cl", "--output", str(cl)]) == 0
    err = capfd.readouterr().err
    (line,) = [line for line in err.splitlines() if line.startswith("to post it with the same head: ")]
    command = shlex.split(line.partition(": ")[2])
    assert command[:3] == ["trunnion", "post", str(cl)]
    assert main([*command[1:], "--output", str(again)]) == 0
    assert "warning" not in capfd.readouterr().err
    return again.read_bytes()


@pytest.mark.parametrize("name", HEADS)
def test_golden_programs_come_back_from_a_cl_file_byte_for_byte(name: str, tmp_path: Path, capfd: Capture) -> None:
    program = YL569 / f"{name}.expected.mpf"
    assert there_and_back(program, tmp_path, capfd) == program.read_bytes()


def test_the_typed_head_of_a_golden_program_becomes_ours_and_its_motion_stays(tmp_path: Path, capfd: Capture) -> None:
    program = YL569 / "1_contour_rough.expected.mpf"
    assert motion_part(there_and_back(program, tmp_path, capfd)) == motion_part(program.read_bytes())


@pytest.mark.parametrize("name", CASES)
def test_our_own_program_comes_back_twice(name: str, tmp_path: Path, capfd: Capture) -> None:
    first = tmp_path / "first.mpf"
    settings = ["--set=title=题", "--set=method=MILL_FINISH", "--set=stock=0.35", "--set=work_offset=G55"]
    assert main(["post", str(YL569 / f"{name}.cls"), "--machine", "yl569", "--output", str(first), *settings]) == 0
    capfd.readouterr()
    again = there_and_back(first, tmp_path, capfd)
    assert again == first.read_bytes()
    first.write_bytes(again)
    assert there_and_back(first, tmp_path, capfd) == again


def test_several_operations_and_tools_come_back(tmp_path: Path, capfd: Capture) -> None:
    first = tmp_path / "first.mpf"
    files = [str(YL569 / f"{name}.cls") for name in CASES]
    assert main(["post", *files, "--machine", "yl569", "--output", str(first)]) == 0
    capfd.readouterr()
    assert main(["convert", str(first), "--machine", "yl569", "--to-cl", "--output", str(tmp_path / "a.cls")]) == 0
    assert "to post it" not in capfd.readouterr().err, "nothing but defaults"
    assert main(["post", str(tmp_path / "a.cls"), "--machine", "yl569", "--output", str(tmp_path / "a.mpf")]) == 0
    assert (tmp_path / "a.mpf").read_bytes() == first.read_bytes()
    found = read_cl(tmp_path / "a.cls").operations
    assert [operation.name for operation in found] == ["CAVITY_MILL", "MULTI_BLADE_ROUGH", "BLADE_FINISH"]


@pytest.mark.parametrize("name", CASES)
def test_for_the_same_machine_the_program_stays_the_same(name: str, tmp_path: Path, capfd: Capture) -> None:
    program, target = YL569 / f"{name}.expected.mpf", tmp_path / "same.mpf"
    arguments = ["convert", str(program), "--machine", "yl569", "--to-machine", "yl569", "--output", str(target)]
    assert main(arguments) == 0
    assert motion_part(target.read_bytes()) == motion_part(program.read_bytes())
    assert target.read_bytes() == program.read_bytes() or name not in HEADS


@pytest.mark.parametrize("key", ["generic_head_table_bc", "generic_head_head_ca", "generic_nutated_b45_c"])
@pytest.mark.parametrize("name", CASES)
def test_on_another_machine_the_tool_does_the_same(name: str, key: str, tmp_path: Path, capfd: Capture) -> None:
    program, target = YL569 / f"{name}.expected.mpf", tmp_path / "other.mpf"
    machines = ["--machine", "yl569", "--to-machine", key]
    assert main(["convert", str(program), *machines, "--output", str(target)]) == 0
    said = unproven(capfd.readouterr().err)
    if name not in HEADS:  # its typed foot leaves the coolant to M30, and the new program has M9
        program = tmp_path / "with_coolant_off.mpf"
        program.write_bytes((YL569 / f"{name}.expected.mpf").read_bytes().replace(b"N1290 M5", b"N1290 M5 M9"))
    assert main(["diff", str(program), str(target), *machines, "--tolerance", "0.00002"]) == 0
    assert capfd.readouterr().out.startswith("same: ")
    text = target.read_text(encoding="utf-8")
    if name not in HEADS:
        assert "the change to tool 0: not carried over" in said, "its typed foot empties the spindle"
        return
    assert "warning" not in said
    assert f";DATE TIME :{HEADS[name]['date']}" in text, "settings are carried over"
    axes = load_machine(key).axes
    letters = [axes[column].name for column in load_machine(key).rotary]
    assert all(re.search(rf"^N\d+ X.* {letter}[-\d.]", text, re.MULTILINE) for letter in letters)


def test_what_is_set_counts_more_than_what_the_program_says(tmp_path: Path, capfd: Capture) -> None:
    target = tmp_path / "a.mpf"
    arguments = ["convert", str(HUB), "--machine", "yl569", "--to-machine", "yl569", "--output", str(target)]
    assert main([*arguments, "--set", "title=new", "--set", "tolerance=0.02"]) == 0
    lines = target.read_text(encoding="utf-8").splitlines()
    assert lines[0] == "N10 ;new"
    assert "N230 _camtolerance=.02" in lines


def test_the_cl_file_says_in_comments_what_it_cannot_hold(tmp_path: Path, capfd: Capture) -> None:
    assert main(["convert", str(HUB), "--machine", "yl569", "--to-cl", "--output", str(tmp_path / "a.cls")]) == 0
    lines = (tmp_path / "a.cls").read_text(encoding="utf-8").splitlines()
    assert lines[0] == "$$ --set title=轮毂粗加工"
    assert read_cl(tmp_path / "a.cls").part == HEADS["2_hub_rough"]["part"]


def test_the_result_can_go_to_stdout_or_into_a_folder(tmp_path: Path, capfd: Capture) -> None:
    assert main(["convert", str(HUB), "--machine", "yl569", "--to-cl", "--output", "-"]) == 0
    out = capfd.readouterr().out
    assert out.endswith("END-OF-PATH\n")
    assert main(["convert", str(HUB), "--machine", "yl569", "--to-cl", "--output", str(tmp_path)]) == 0
    assert (tmp_path / "2_hub_rough.expected.cls").read_text(encoding="utf-8") == out


# Bad input


def failed(folder: Path, capfd: Capture, *arguments: str, code: int = 2) -> str:
    """Runs a command that must fail and leave nothing; returns what it says."""
    target = folder / "out" / "x.cls"
    target.parent.mkdir(exist_ok=True)
    assert main(["convert", *arguments, "--output", str(target)]) == code
    assert list(target.parent.iterdir()) == []
    out, err = capfd.readouterr()
    assert out == ""
    return err


def test_a_program_that_is_not_there_is_named(tmp_path: Path, capfd: Capture) -> None:
    err = failed(tmp_path, capfd, str(tmp_path / "no.mpf"), "--machine", "yl569", "--to-cl")
    assert "no.mpf: error:" in err


def test_a_machine_that_is_not_there_is_named_with_those_that_are(tmp_path: Path, capfd: Capture) -> None:
    assert "yl569" in failed(tmp_path, capfd, str(HUB), "--machine", "yl596", "--to-cl")
    assert "yl569" in failed(tmp_path, capfd, str(HUB), "--machine", "yl569", "--to-machine", "yl596")


def test_a_machine_whose_control_cannot_be_written_says_so(tmp_path: Path, capfd: Capture) -> None:
    text = files("trunnion.machines").joinpath("library", "ucp800.toml").read_text(encoding="utf-8")
    machine = tmp_path / "other.toml"
    machine.write_text(text.replace('extends = "heidenhain_itnc530"', 'family = "unheard_of"'), encoding="utf-8")
    err = failed(tmp_path, capfd, str(HUB), "--machine", "yl569", "--to-machine", str(machine))
    assert 'control.family is "unheard_of"' in err


@pytest.mark.parametrize("into", [[], ["--to-cl", "--to-machine", "yl569"]])
def test_one_of_both_ways_out_must_be_chosen(into: list[str], capfd: Capture) -> None:
    with pytest.raises(SystemExit) as stopped:
        main(["convert", str(HUB), "--machine", "yl569", *into])
    assert stopped.value.code == 2
    assert "--to-cl" in capfd.readouterr().err


def test_an_output_that_cannot_be_written_is_said(tmp_path: Path, capfd: Capture) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("in the way")
    arguments = ["convert", str(HUB), "--machine", "yl569", "--to-cl", "--output", str(blocked / "x.cls")]
    assert main(arguments) == 2
    assert "cannot be written" in capfd.readouterr().err
    assert blocked.read_text() == "in the way"


def test_a_program_is_never_written_over_itself(
    tmp_path: Path, capfd: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    program = tmp_path / "a.mpf"
    program.write_bytes(HUB.read_bytes())
    monkeypatch.chdir(tmp_path)
    for output in ([], ["--output", "a.mpf"], ["--output", "."]):
        assert main(["convert", "a.mpf", "--machine", "yl569", "--to-machine", "yl569", *output]) == 2
        assert "a.mpf: error: would be written over, although" in capfd.readouterr().err
    assert program.read_bytes() == HUB.read_bytes()


def test_unknown_words_are_refused_with_their_block(tmp_path: Path, capfd: Capture) -> None:
    program = tmp_path / "a.mpf"
    program.write_bytes(HUB.read_bytes().replace(b"N500 X48.39629", b"N500 WOBBLE(3) X48.39629"))
    arguments = [str(program), "--machine", "yl569", "--to-cl"]
    err = failed(tmp_path, capfd, *arguments, code=1)
    assert "a.mpf:50: error:" in err
    assert "WOBBLE" in err
    assert "--force" in err
    assert main(["convert", *arguments, "--force", "--output", str(tmp_path / "forced.cls")]) == 1
    assert "a.mpf:50: error:" in capfd.readouterr().err


def test_a_program_that_leaves_the_travel_of_the_other_machine_is_refused(tmp_path: Path, capfd: Capture) -> None:
    arguments = [str(HUB), "--machine", "yl569", "--to-machine", "yl569", "--set", "zero=0,0,900"]
    err = failed(tmp_path, capfd, *arguments, code=1)
    assert f"{HUB}:46: error: axis Z would go to" in err
    target = tmp_path / "a.mpf"
    assert main(["convert", *arguments, "--force", "--output", str(target)]) == 1
    assert ";MUST NOT RUN AS IT IS" in target.read_text(encoding="utf-8")


def test_a_setting_that_the_other_control_does_not_have_is_named(tmp_path: Path, capfd: Capture) -> None:
    shipped = "\n".join(load_control(load_machine("yl569").control).templates["program_start"].lines)
    (tmp_path / "own.toml").write_text(
        'schema = 1\nextends = "yl569"\nname = "own"\n[control.settings]\nshop = ""\n'
        f"[control.templates]\nprogram_start = '''\n;SHOP {{shop}}\n{shipped}\n'''\n"
    )
    program, target = tmp_path / "a.mpf", tmp_path / "b.mpf"
    own = ["--machine", str(tmp_path / "own.toml")]
    assert main(["post", str(YL569 / "2_hub_rough.cls"), *own, "--set=shop=7", "--output", str(program)]) == 0
    capfd.readouterr()
    assert main(["convert", str(program), *own, "--to-machine", "yl569", "--output", str(target)]) == 0
    assert (
        "warning: shop is '7', which is not carried over; see that the program is good without it: Sinumerik 840D sl "
        "has no such setting"
    ) in capfd.readouterr().err


def test_a_tool_that_is_set_is_called_whatever_the_program_calls(tmp_path: Path, capfd: Capture) -> None:
    program, target = tmp_path / "a.mpf", tmp_path / "b.mpf"
    program.write_text(HUB.read_text(encoding="utf-8").replace("T=2", 'T="UGT0203_004"'), encoding="utf-8")
    arguments = ["convert", str(program), "--machine", "yl569", "--to-machine", "yl569", "--output", str(target)]
    for extra, call in (([], 'T="UGT0203_004"'), (["--set", "tool=9"], "T=9")):
        assert main([*arguments, *extra]) == 0
        assert f"{call}\n" in target.read_text(encoding="utf-8")


def test_a_program_without_motion_is_an_error(tmp_path: Path, capfd: Capture) -> None:
    program = tmp_path / "a.mpf"
    program.write_text("SUPA G0 X0 Y0 Z0\nM30\n")
    assert "no motion at the part" in failed(tmp_path, capfd, str(program), "--machine", "yl569", "--to-cl")


@pytest.mark.parametrize(
    ("setting", "word"),
    [
        ("titel=x", "titel is not a setting"),
        ("units=mm", "units has no meaning"),
        ("zero=1,2,3", "zero has no meaning"),
    ],
)
def test_a_setting_that_makes_no_sense_is_named(setting: str, word: str, tmp_path: Path, capfd: Capture) -> None:
    assert word in failed(tmp_path, capfd, str(HUB), "--machine", "yl569", "--to-cl", "--set", setting)


def test_a_zero_that_is_no_point_is_named(tmp_path: Path, capfd: Capture) -> None:
    arguments = [str(HUB), "--machine", "yl569", "--to-machine", "yl569", "--set", "zero=1,2"]
    assert "zero is '1,2'" in failed(tmp_path, capfd, *arguments)


def test_a_program_by_vectors_comes_back_as_it_is(tmp_path: Path, capfd: Capture) -> None:
    first, again = tmp_path / "first.mpf", tmp_path / "again.mpf"
    cl = str(YL569 / "2_hub_rough.cls")
    assert main(["post", cl, "--machine", "yl569", "--output", str(first), "--set", "orientation=vector"]) == 0
    capfd.readouterr()
    convert = ["convert", str(first), "--machine", "yl569", "--to-machine"]
    assert main([*convert, "yl569", "--output", str(again)]) == 0
    assert "warning" not in capfd.readouterr().err
    assert again.read_bytes() == first.read_bytes()
    assert there_and_back(first, tmp_path, capfd) == first.read_bytes()
    assert main([*convert, "dmu65", "--output", str(again)]) == 0
    assert "orientation is 'vector', which is not carried over" in capfd.readouterr().err
    assert main([*convert, "yl569", "--output", str(again), "--set", "orientation=angles"]) == 0
    assert "A3=" not in again.read_text(encoding="utf-8")


def test_several_files_become_one_or_several_as_it_is_set(tmp_path: Path, capfd: Capture) -> None:
    several, again = tmp_path / "several.mpf", tmp_path / "again.mpf"
    cl = str(YL569 / "2_hub_rough.cls")
    given = ["--set", "programs=operations", "--set", "orientation=vector"]
    assert main(["post", cl, "--machine", "yl569", "--output", str(several), *given]) == 0
    capfd.readouterr()
    parts = sorted(str(path) for path in tmp_path.glob("*.spf"))
    convert = ["convert", str(several), "--subprograms", *parts, "--machine", "yl569", "--to-machine", "yl569"]
    assert main([*convert, "--output", str(again)]) == 0
    assert "2 files become one program; --set programs=operations" in capfd.readouterr().err
    assert "A3=" in again.read_text(encoding="utf-8")
    (tmp_path / "new").mkdir()
    assert main([*convert, "--output", str(tmp_path / "new" / "again.mpf"), "--set", "programs=operations"]) == 0
    assert "become one program" not in capfd.readouterr().err
    (part,) = (tmp_path / "new").glob("*.spf")
    assert "A3=" in part.read_text(encoding="utf-8")


def test_the_earlier_name_of_the_dialect_is_understood_with_a_warning(tmp_path: Path, capfd: Capture) -> None:
    words = ["convert", str(YL569 / "2_hub_rough.cls"), "--to-cl", "--output"]
    assert main([*words, str(tmp_path / "a.ncl"), "--dialect", "ncl"]) == 0
    assert "--to-dialect does [ARG190]" in capfd.readouterr().err
    assert main([*words, str(tmp_path / "b.ncl"), "--to-dialect", "ncl", "--dialect", "clsf", "--units", "mm"]) == 0
    assert "ARG190" not in capfd.readouterr().err
    assert (tmp_path / "a.ncl").read_bytes() == (tmp_path / "b.ncl").read_bytes()


def test_a_tolerance_that_follows_from_the_operation_outlives_a_default_of_the_other_machine(tmp_path: Path) -> None:
    first, second = tmp_path / "first.mpf", tmp_path / "second.mpf"
    trunnion.post(YL569 / "1_contour_rough.cls", machine="generic_head_head_ca", output=first)
    trunnion.convert(first, machine="generic_head_head_ca", to_machine="yl569", output=second)
    called = [re.findall(r"CYCLE832\(([.\d]+),", file.read_text(encoding="utf-8")) for file in (first, second)]
    assert called == [["0.06"], ["0.06"]], "the definition of the yl569 has 0.01"
