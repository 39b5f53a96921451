"""Posts and machine data of others as definitions."""

import json
import shutil
from pathlib import Path

import pytest

from tests.support.locations import ROOT
from tests.support.machines import five_axis_machines
from trunnion.cli import main
from trunnion.errors import InputError
from trunnion.foreign.definition import differences, nearest_machine, written_definition
from trunnion.foreign.machine import ForeignMachine
from trunnion.foreign.machine_data import read_machine_data
from trunnion.foreign.nx_post import read_nx_post
from trunnion.machines import load_machine

FILES = ROOT / "tests" / "data" / "foreign"
POST = [FILES / "mill.tcl", FILES / "mill.def"]


def stated(found: ForeignMachine) -> dict[str, object]:
    return {".".join(key): value.value for key, value in found.values.items()}


def loaded(text: str, folder: Path, name: str = "ours"):  # type: ignore[no-untyped-def]
    (folder / f"{name}.toml").write_text(text, encoding="utf-8")
    return load_machine(folder / f"{name}.toml")


def changed_post(folder: Path, *changes: tuple[str, str]) -> list[Path]:
    text = POST[0].read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    (folder / "mill.tcl").write_text(text, encoding="utf-8")
    return [folder / "mill.tcl"]


def test_a_post_in_inches_says_its_axes() -> None:
    found = read_nx_post(POST)
    assert found.rotary == (("C", "part"), ("B", "part"))
    values = stated(found)
    assert values["axis.B.limits_deg"] == [-30.0, 120.0]
    assert values["axis.B.point_mm"] == [0.0, 0.0, 63.5]
    assert values["axis.C.point_mm"] == [25.4, 0.0, 63.5]
    assert values["axis.C.endless"] is True
    assert values["axis.X.rapid_mm_min"] == 10160.0
    assert values["control.coolant.THRU"] == 51
    assert not [key for key in values if "format" in key]  # decimals of inches


def test_lines_of_a_post_are_listed_with_their_template_and_words() -> None:
    left = read_nx_post(POST).left
    assert [(each.what, each.why) for each in left if "template" in each.why] == [
        ('MOM_output_literal "G40 G17 G49 G80 G90 G94"', "template program_start"),
        ("MOM_do_template start_it: G_adjust[$mom_sys_adjust_code] Text[M25]", "template program_start"),
        ("PB_CMD_do_things", "template program_start"),
    ]


def test_the_definition_is_good_and_each_number_is_to_be_measured(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["import", *map(str, POST), "--output", "our_mill", "--json", "report.json"]) == 0
    out = capsys.readouterr().out
    machine = load_machine(tmp_path / "our_mill.toml")
    axes = {axis.name: axis for axis in machine.axes}
    assert (axes["B"].low, axes["B"].high, str(axes["B"].positive)) == (-30.0, 120.0, "reversed")
    assert axes["C"].point == (25.4, 0.0, 63.5)
    assert "not taken: home of Z" in out  # beyond the travel of the shipped machine
    assert "# not taken: home of Z" in (tmp_path / "our_mill.toml").read_text(encoding="utf-8")
    report = json.loads((tmp_path / "report.json").read_text(encoding="utf-8"))
    assert report["numbers_to_measure"] == len([value for value in machine.unmeasured if "our_mill" in value.file])
    assert main(["check", "our_mill.toml"]) == 0
    assert main(["import", *map(str, POST), "--output", "our_mill"]) == 2  # nothing is written over


def test_a_pui_alone_is_enough(tmp_path: Path) -> None:
    found = read_nx_post([FILES / "mill.pui"])
    assert found.rotary == (("C", "part"), ("A", "part"))
    assert loaded(written_definition(found, nearest_machine(found), "ours").text, tmp_path).axes[1].low == -110.0


def test_a_fork_head_has_its_pivot_above_the_gauge_point(tmp_path: Path) -> None:
    files = changed_post(
        tmp_path,
        ('"5_axis_dual_table"', '"5_axis_dual_head"'),
        ('4th_axis_leader "B"', '4th_axis_leader "C"'),
        ('5th_axis_leader "C"', '5th_axis_leader "A"'),
        ('4th_axis_plane "ZX"', '4th_axis_plane "XY"'),
        ('5th_axis_plane "XY"', '5th_axis_plane "YZ"'),
        ('mom_kin_output_unit                       "IN"', 'mom_kin_pivot_gauge_offset  "200"'),
    )
    found = read_nx_post(files)
    assert found.rotary == (("C", "tool"), ("A", "tool"))
    values = stated(found)
    assert (values["axis.A.point_mm"], values["axis.C.point_mm"]) == ([0.0, 0.0, 200.0], [-1.0, 0.0, 200.0])
    machine = loaded(written_definition(found, nearest_machine(found), "ours").text, tmp_path)
    assert next(axis for axis in machine.axes if axis.name == "A").has_limits  # stay until they are measured


@pytest.mark.parametrize("name", [name for name in five_axis_machines() if "nutated" not in name])
def test_every_shipped_machine_comes_back_from_a_post_of_it(name: str, tmp_path: Path) -> None:
    """A post with the axes of a shipped machine becomes a definition with the same axes."""
    machine = load_machine(name)
    first, second = (machine.axes[column] for column in machine.rotary)
    kinds = {("part", "part"): "dual_table", ("tool", "tool"): "dual_head", ("part", "tool"): "head_table"}
    kind = kinds[str(first.mount), str(second.mount)]
    fourth, fifth = (first, second) if kind == "dual_head" else (second, first)
    lines = [f'set mom_kin_machine_type "5_axis_{kind}"', 'set mom_kin_output_unit "MM"']
    for which, axis in (("4th", fourth), ("5th", fifth)):
        start = f"set mom_kin_{which}_axis_"
        lines += [f'{start}leader "{axis.name}"', f'{start}plane "Other"']
        lines += [f'{start}vector({k}) "{axis.direction[k]!r}"' for k in range(3)]
        lines.append(f'{start}rotation "{"standard" if axis.sense > 0 else "reverse"}"')
        low, high = (axis.low, axis.high) if axis.has_limits else (-9999.0, 9999.0)
        lines += [f'{start}min_limit "{low}"', f'{start}max_limit "{high}"']
    (tmp_path / "post.tcl").write_text("\n".join(lines), encoding="utf-8")
    found = read_nx_post([tmp_path / "post.tcl"])
    base = nearest_machine(found)
    again = loaded(written_definition(found, base, "ours").text, tmp_path)
    for axis in (first, second):
        same = next(each for each in again.axes if each.name == axis.name)
        assert (same.mount, same.direction, same.positive) == (axis.mount, axis.direction, axis.positive)
        assert (same.has_limits, same.low, same.high) == (axis.has_limits, axis.low, axis.high)


def test_machine_data_are_compared_with_a_definition(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["import", str(FILES / "nck.arc"), "--machine", "yl569"]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("axis.X.limits_mm: [-250.0, 250.0] in yl569, [-251.0, 250.0] there")
    assert lines[1].startswith("axis.X.acceleration_mm_s2: not stated in yl569, 2500.0 there")
    assert lines[2].startswith("axis.C.point_mm X: 0.0 in yl569, 0.02 there")
    assert lines[-1] == "3 differences in 7 values; 2 not compared"


def test_machine_data_become_a_definition(tmp_path: Path) -> None:
    found = read_machine_data(FILES / "nck.arc")
    assert (found.rotary, nearest_machine(found)) == ((("C", "part"), ("B", "part")), "yl569")
    machine = loaded(written_definition(found, "yl569", "ours").text, tmp_path)
    assert list(differences(found, machine)) == []
    assert {axis.name: axis.rapid for axis in machine.axes}["B"] == 16 * 360.0


@pytest.mark.parametrize(
    ("change", "code"),
    [
        (('"5_axis_dual_table"', '"3_axis_mill"'), "DEF620"),
        (('set mom_kin_machine_type                      "5_axis_dual_table"', ""), "DEF620"),
        (('set mom_kin_4th_axis_leader "B"', ""), "DEF620"),
        (('4th_axis_leader "B"', '4th_axis_leader "C"'), "DEF620"),
    ],
)
def test_what_is_no_machine_with_five_axes_is_refused(change: tuple[str, str], code: str, tmp_path: Path) -> None:
    with pytest.raises(InputError) as refused:
        read_nx_post(changed_post(tmp_path, change))
    assert [problem.code for problem in refused.value.problems] == [code]


def test_a_machine_like_none_gets_a_definition_of_its_own(tmp_path: Path) -> None:
    changes = ('4th_axis_leader "B"', '4th_axis_leader "A"'), ('4th_axis_plane "ZX"', '4th_axis_plane "YZ"')
    heads = ('"5_axis_dual_table"', '"5_axis_dual_head"'), ('5th_axis_leader "C"', '5th_axis_leader "B"')
    plane = ('5th_axis_plane "XY"', '5th_axis_plane "ZX"')
    found = read_nx_post(changed_post(tmp_path, *changes, *heads, plane))
    assert (found.rotary, nearest_machine(found)) == ((("A", "tool"), ("B", "tool")), "")
    machine = loaded(written_definition(found, "", "ours").text, tmp_path)
    assert [axis.name for axis in machine.axes] == ["X", "Y", "Z", "A", "B"]
    assert {"X carries", "Y carries", "Z carries"} <= {value.name for value in machine.unmeasured}


def test_limits_of_an_axis_that_the_shipped_machine_turns_endlessly_count(tmp_path: Path) -> None:
    files = changed_post(tmp_path, ('mom_sys_5th_axis_has_limits               "0"', 'mom_sys_5th "1"'))
    for base in ("yl569", "haas_umc750"):
        machine = loaded(written_definition(read_nx_post(files), base, "ours").text, tmp_path)
        axis = next(each for each in machine.axes if each.name == "C")
        assert (axis.low, axis.high, axis.endless) == (0.0, 360.0, False)


def test_no_machine_like_it_is_refused(tmp_path: Path) -> None:
    no_plane = ('mom_kin_4th_axis_plane "ZX"', 'mom_kin_4th_axis_plane "Other"')
    found = read_nx_post(changed_post(tmp_path, ('4th_axis_leader "B"', '4th_axis_leader "W"'), no_plane))
    with pytest.raises(InputError, match="C \\(part\\) W \\(part\\)"):
        nearest_machine(found)


def test_of_a_value_that_is_set_again_the_last_counts_and_the_other_is_reported(tmp_path: Path) -> None:
    files = changed_post(tmp_path, ("proc MOM_start", 'set mom_kin_4th_axis_max_limit "90"\nproc MOM_start'))
    found = read_nx_post(files)
    assert stated(found)["axis.B.limits_deg"] == [-30.0, 90.0]
    assert "mom_kin_4th_axis_max_limit = 120" in [each.what for each in found.left]


def test_what_a_procedure_sets_does_not_count_and_is_reported(tmp_path: Path) -> None:
    files = changed_post(tmp_path, ("   PB_CMD_do", '   set mom_kin_4th_axis_max_limit "90"\n   PB_CMD_do'))
    found = read_nx_post(files)
    assert stated(found)["axis.B.limits_deg"] == [-30.0, 120.0]
    assert "it is set while the program runs, in MOM_start_of_program" in [each.why for each in found.left]


@pytest.mark.parametrize("value", ["[exec rm -rf /]", "$env(HOME)", '"$x"', "1e999", "nan", "abc"])
def test_expressions_and_odd_numbers_state_nothing(value: str, tmp_path: Path) -> None:
    files = changed_post(tmp_path, ('mom_kin_4th_axis_max_limit "120"', f"mom_kin_4th_axis_max_limit {value}"))
    found = read_nx_post(files)
    assert ("axis", "B", "limits_deg") not in found.values
    assert [each for each in found.left if each.what.startswith("mom_kin_4th_axis_max_limit")]


def test_limits_that_cannot_be_are_reported(tmp_path: Path) -> None:
    files = changed_post(tmp_path, ('mom_kin_4th_axis_max_limit "120"', 'mom_kin_4th_axis_max_limit "-120"'))
    assert [each.what for each in read_nx_post(files).left if "limits_deg" in each.why] == [
        "mom_kin_4th_axis_min_limit = -30", "mom_kin_4th_axis_max_limit = -120"
    ]  # fmt: skip
    data = (FILES / "nck.arc").read_text(encoding="utf-8").replace("[AX4]=100", "[AX4]=-100")
    (tmp_path / "nck.arc").write_text(data, encoding="utf-8")
    whys = [each.what for each in read_machine_data(tmp_path / "nck.arc").left if "can be made" in each.why]
    assert whys == ["$MA_POS_LIMIT_MINUS[AX4] = -11", "$MA_POS_LIMIT_PLUS[AX4] = -100"]


def test_files_that_are_no_text_or_not_there_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "post.tcl").write_bytes(b"set mom\0")
    for name, code in (("post.tcl", "DEF610"), ("none.tcl", "DEF610"), ("post.cps", "DEF650"), ("none.arc", "DEF610")):
        assert main(["import", str(tmp_path / name), "--output", str(tmp_path / "ours")]) == 2
        assert f"[{code}]" in capsys.readouterr().err
    shutil.copy(POST[0], tmp_path / "list.txt")
    assert main(["import", str(tmp_path / "list.txt"), "--output", str(tmp_path / "ours")]) == 2
    assert "[DEF630]" in capsys.readouterr().err
    assert sorted(file.name for file in tmp_path.iterdir()) == ["list.txt", "post.tcl"]


def test_names_of_machine_axes_alone_are_letters(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    lines = (FILES / "nck.arc").read_text(encoding="utf-8").splitlines()
    (tmp_path / "nck.arc").write_text("\n".join(each for each in lines if "CHANAX" not in each), encoding="utf-8")
    found = read_machine_data(tmp_path / "nck.arc")
    assert found.rotary == (("C", "part"), ("B", "part"))
    monkeypatch.chdir(tmp_path)
    assert main(["import", "nck.arc", "--output", "ours", "--json", "ours.json"]) == 0
    report = json.loads((tmp_path / "ours.json").read_text(encoding="utf-8"))
    text = (tmp_path / "ours.toml").read_text(encoding="utf-8")
    assert len(report["taken"]) == report["numbers_to_measure"] == text.count("# measure: $M")
    assert "not taken" in text


def test_what_the_shipped_machine_has_no_axis_for_is_not_called_taken(tmp_path: Path) -> None:
    written = written_definition(read_nx_post(POST), "ucp800", "ours")
    assert not [key for key in written.taken if key[:2] == ("axis", "B")]
    assert [each.why for each in written.left if each.what == "axis.B.limits_deg = [-30, 120]"] == [
        "ucp800 has no axis B"
    ]


def test_a_line_of_rotation_that_points_the_other_way_is_written(tmp_path: Path) -> None:
    lines = "\n".join(f'set mom_kin_5th_axis_vector({k}) "{value}"' for k, value in enumerate((0, 0, -1)))
    files = changed_post(tmp_path, ('set mom_kin_5th_axis_plane "XY"', f'set mom_kin_5th_axis_plane "Other"\n{lines}'))
    found = read_nx_post(files)
    machine = loaded(written_definition(found, nearest_machine(found), "ours").text, tmp_path)
    assert next(axis for axis in machine.axes if axis.name == "C").direction == (0.0, 0.0, -1.0)
