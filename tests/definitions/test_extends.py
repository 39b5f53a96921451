"""Definitions that extend others."""

from pathlib import Path

import pytest

from tests.support.definition_files import loaded, written
from trunnion.controls import load_control
from trunnion.definitions import (
    resolve_extends,
)
from trunnion.errors import InputError
from trunnion.machines import load_machine


def test_what_a_child_says_replaces_and_the_rest_is_inherited(tmp_path: Path) -> None:
    base = written(tmp_path, "shelf/base.toml", "a = 1\nb = 2\n[t]\nc = 3\nd = [1, 2]\n")
    table = loaded(tmp_path, 'extends = "base"\nb = 20\n[t]\nd = [9]\n')
    assert table.to_dict() == {"a": 1, "b": 20, "t": {"c": 3, "d": [9]}}
    assert table.location("a") == (str(base), 1)
    assert table.location("b") == (str(tmp_path / "mine.toml"), 2)
    assert table.table("t").location("c") == (str(base), 4)
    assert table.files() == sorted([str(base), str(tmp_path / "mine.toml")])


def test_tables_with_names_are_merged_by_name_appended_and_removed(tmp_path: Path) -> None:
    written(tmp_path, "shelf/base.toml", '[[w]]\nname="X"\nn=1\n[[w]]\nname="Y"\nn=2\n[[w]]\nname="Z"\nn=3\n')
    mine = '[[w]]\nname="Z"\nn=30\n[[w]]\nname="Q"\nn=4\n[[w]]\nname="X"\nremove=true\n'
    names = [(w["name"], w["n"]) for w in loaded(tmp_path, 'extends = "base"\n' + mine).to_dict()["w"]]  # type: ignore[attr-defined]
    assert names == [("Y", 2), ("Z", 30), ("Q", 4)]


def test_removing_what_is_not_there_and_a_name_left_out_are_mistakes(tmp_path: Path) -> None:
    written(tmp_path, "shelf/base.toml", '[[w]]\nname="X"\n')
    table = loaded(tmp_path, 'extends = "base"\n[[w]]\nname="XX"\nremove=true\n[[w]]\nn=1\n')
    with pytest.raises(InputError) as caught:
        table.raise_problems()
    assert [(p.line, p.what) for p in caught.value.problems] == [
        (4, 'w[0]: there is no w called "XX" to remove'),
        (5, "w[1].name is missing"),
    ]


def test_a_chain_of_three_files_is_merged_in_order(tmp_path: Path) -> None:
    written(tmp_path, "shelf/old.toml", "a = 1\nb = 1\nc = 1\n")
    written(tmp_path, "sub/mid.toml", 'extends = "old"\nb = 2\nc = 2\n')
    assert loaded(tmp_path, 'extends = "sub/mid.toml"\nc = 3\n').to_dict() == {"a": 1, "b": 2, "c": 3}


@pytest.mark.parametrize(
    "name",
    [
        "../secret.toml",
        "/etc/passwd",
        "/etc/secret.toml",
        "sub/../../secret.toml",
        "..\\\\secret.toml",
        "C:/secret.toml",
        "~/secret.txt",
        "secret.txt",
        "sub/..",
        "",
        "file://secret.toml",
    ],
)
def test_a_definition_may_not_name_files_elsewhere(tmp_path: Path, name: str) -> None:
    written(tmp_path, "secret.toml", "a = 1\n")
    (tmp_path / "here").mkdir()
    with pytest.raises(InputError, match="not a file that a definition may read"):
        loaded(tmp_path / "here", f'extends = "{name}"\n')


def test_a_link_may_not_lead_elsewhere_either(tmp_path: Path) -> None:
    secret = written(tmp_path, "secret.toml", "a = 1\n")
    (tmp_path / "here").mkdir()
    (tmp_path / "here" / "link.toml").symlink_to(secret)
    with pytest.raises(InputError, match="leads out of the folder"):
        loaded(tmp_path / "here", 'extends = "link.toml"\n')


def test_a_definition_may_lie_in_a_folder_beside_the_one_that_extends_it(tmp_path: Path) -> None:
    written(tmp_path, "shop/base.toml", 'extends = "old/older"\na = 1\n')
    written(tmp_path, "shop/old/older.toml", "b = 2\n")
    for name in ("shop/base", "shop/base.toml", "./shop/base"):
        assert loaded(tmp_path, f'extends = "{name}"\n').to_dict() == {"a": 1, "b": 2}


def test_a_file_in_the_folder_reaches_what_is_below_itself_and_nothing_beside_the_folder(tmp_path: Path) -> None:
    written(tmp_path, "other.toml", "b = 2\n")
    for name in ("other.toml", "../other.toml", "../other"):
        written(tmp_path, "shop/base.toml", f'extends = "{name}"\n')
        with pytest.raises(InputError) as caught:
            loaded(tmp_path, 'extends = "shop/base"\n')
        (problem,) = caught.value.problems
        assert (problem.file, problem.line) == (str(tmp_path / "shop" / "base.toml"), 1)


def test_a_missing_file_of_the_folder_is_told_with_its_name(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r'there is no file "shop/base\.toml" beside the definition') as caught:
        loaded(tmp_path, 'a = 1\nextends = "shop/base"\n')
    assert caught.value.problems[0].line == 2


def test_a_linked_folder_may_not_lead_elsewhere_but_may_stay_inside(tmp_path: Path) -> None:
    written(tmp_path, "secret/base.toml", "a = 1\n")
    written(tmp_path, "here/real/base.toml", "a = 2\n")
    (tmp_path / "here" / "shop").symlink_to(tmp_path / "secret", target_is_directory=True)
    (tmp_path / "here" / "ours").symlink_to(tmp_path / "here" / "real", target_is_directory=True)
    with pytest.raises(InputError, match="leads out of the folder"):
        loaded(tmp_path / "here", 'extends = "shop/base"\n')
    assert loaded(tmp_path / "here", 'extends = "ours/base"\n').to_dict() == {"a": 2}


def test_links_that_go_round_are_no_definition(tmp_path: Path) -> None:
    (tmp_path / "a").symlink_to(tmp_path / "b")
    (tmp_path / "b").symlink_to(tmp_path / "a")
    with pytest.raises(InputError, match=r"leads out of the folder|there is no file"):
        loaded(tmp_path, 'extends = "a/base"\n')


def test_a_circle_through_a_folder_is_told(tmp_path: Path) -> None:
    written(tmp_path, "shop/a.toml", 'extends = "b.toml"\n')
    written(tmp_path, "shop/b.toml", 'extends = "./a.toml"\n')
    with pytest.raises(InputError, match=r"goes in a circle: mine.toml extends a.toml extends b.toml extends a.toml"):
        loaded(tmp_path, 'extends = "shop/a"\n')


def test_the_control_of_a_machine_may_lie_in_a_folder_beside_the_file_that_says_so(tmp_path: Path) -> None:
    written(tmp_path, "controls/ours.toml", 'extends = "fanuc_31i"\nname = "Ours"\n[settings]\nprogram = "7"\n')
    path = written(tmp_path, "mill.toml", 'extends = "matsuura_mx330"\n[control]\nextends = "controls/ours"\n')
    control = load_control(load_machine(path).control)
    assert (control.name, control.settings["program"]) == ("Ours", "7")
    above = written(tmp_path, "top/mill.toml", 'extends = "matsuura_mx330"\n[control]\nextends = "../controls/ours"\n')
    with pytest.raises(InputError, match="not a file that a definition may read"):
        load_control(load_machine(above).control)


@pytest.mark.parametrize(
    "name", ["/", "./", "shop/", "shop/..", "/shop/base", "shop\\\\base", "D:shop/base", "shop/base.txt"]
)
def test_a_folder_alone_or_a_path_of_another_kind_is_no_definition(tmp_path: Path, name: str) -> None:
    written(tmp_path, "shop/base.toml", "a = 1\n")
    with pytest.raises(InputError, match=r"not a file that a definition may read|there is no file"):
        loaded(tmp_path, f'extends = "{name}"\n')


def test_a_definition_extends_one_other_and_no_list(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r'extends is \["a", "b"\]; write one name'):
        loaded(tmp_path, 'extends = ["a", "b"]\n')


def test_a_user_file_may_bear_the_name_of_the_shipped_one_that_it_extends(tmp_path: Path) -> None:
    path = written(tmp_path, "yl569.toml", 'extends = "yl569"\nname = "Ours"\n[spindle]\nmax_rpm = 12000\n')
    machine = load_machine(path)
    assert (machine.name, machine.spindle_max_rpm, machine.axis("B").high) == ("Ours", 12000.0, 100.0)
    assert len(machine.files) == 2


def test_a_machine_changes_one_limit_of_a_shipped_one_in_four_lines(tmp_path: Path) -> None:
    path = written(tmp_path, "ours.toml", 'extends = "yl569"\n[[axis]]\nname = "B"\nlimits_deg = [-5, 95]\n')
    ours, shipped_machines = load_machine(path), load_machine("yl569")
    assert ours.names == shipped_machines.names
    assert (ours.axis("B").low, ours.axis("B").high) == (-5.0, 95.0)
    assert ours.axes[0] == shipped_machines.axes[0]


def test_overrides_act_like_a_file_that_extends_this_one() -> None:
    machine = load_machine("yl569", {"axis": [{"name": "B", "limits_deg": [-1, 2]}]})
    assert (machine.axis("B").low, machine.axis("B").high) == (-1.0, 2.0)
    with pytest.raises(InputError) as caught:
        load_machine("yl569", {"axis": [{"name": "B", "limits_deg": [2, -1]}]})
    assert caught.value.problems[0].file == "overrides"


# A table that extends something of another library


def test_the_control_of_a_machine_extends_a_library_of_controls(tmp_path: Path) -> None:
    controls = tmp_path / "controls"
    written(controls, "stock.toml", 'title = "stock"\n[[word]]\nname = "F"\nn = 3\n[[word]]\nname = "S"\nn = 0\n')
    written(tmp_path, "shelf/base.toml", '[control]\nextends = "stock"\n[[control.word]]\nname = "F"\nn = 5\n')
    mine = 'extends = "base"\n[control]\ntitle = "mine"\n[[control.word]]\nname = "S"\nremove = true\n'
    control = loaded(tmp_path, mine).table("control")
    for _ in range(2):  # reading twice must not use anything up
        table = resolve_extends(control, controls)
        assert table.to_dict() == {"title": "mine", "word": [{"name": "F", "n": 5}]}
        table.raise_problems()
    assert table.location("title") == (str(tmp_path / "mine.toml"), 3)


def test_a_control_table_without_extends_is_read_as_it_is(tmp_path: Path) -> None:
    control = loaded(tmp_path, '[control]\nfamily = "fidia"\n').table("control")
    assert resolve_extends(control, tmp_path).to_dict() == {"family": "fidia"}


def test_a_mistake_in_a_control_table_is_told_with_its_path(tmp_path: Path) -> None:
    table = resolve_extends(loaded(tmp_path, "[control]\nfamily = 5\n").table("control"), tmp_path)
    table.text("family")
    with pytest.raises(InputError, match=r"mine.toml:2: error: control.family is 5; write a text in quotes"):
        table.raise_problems()


# Getters
