"""``trunnion test``: cases that come out as they did, that do not, and that are accepted."""

from pathlib import Path

import pytest

import trunnion
from tests.support.locations import ROOT
from tests.support.projects import PROJECT, TWO, contents, operation, project
from trunnion.cli import main
from trunnion.jobs.post_project.cases import posted_case

Capture = pytest.CaptureFixture[str]


@pytest.fixture
def case(tmp_path: Path) -> Path:
    """A case whose program is there."""
    path = project(tmp_path / "cases" / "one")
    trunnion.post_project(path)
    return path


def tried(capsys: Capture, *arguments: object) -> tuple[int, str, str]:
    code = main(["test", *map(str, arguments)])
    return code, *capsys.readouterr()


def test_what_comes_out_as_it_did_passes_and_changes_nothing(case: Path, capsys: Capture) -> None:
    before = contents(case.parent)
    code, out, err = tried(capsys, case.parent.parent)
    assert (code, err) == (0, "")
    assert out.splitlines() == [f"{case}: same: top.mpf", "1 case: 1 same"]
    assert contents(case.parent) == before


def test_another_text_with_the_same_motion_is_told_and_shown(case: Path, capsys: Capture) -> None:
    program = case.with_name("top.mpf")
    program.write_text(program.read_text().replace(";Cutting", "; CUTTING"))
    before = contents(case.parent)
    code, out, err = tried(capsys, case.parent)
    assert code == 1
    assert f"{case}: DIFFERENT: top.mpf: text: 2 lines removed, 2 added" in out
    assert "motion: same: 9 points" in out
    assert "  -N450 ; CUTTING\n  +N450 ;Cutting\n" in out
    assert "--accept" in err
    assert contents(case.parent) == before


def test_another_motion_is_told_by_what_the_tool_does(case: Path, capsys: Capture) -> None:
    case.with_name("top.cls").write_text(operation("FACE").replace("500.0", "400.0") + operation("SLOT 2", start=""))
    code, out, _ = tried(capsys, case.parent)
    assert code == 1
    assert "motion: different: 1 place" in out
    assert "feed 500 against 400 mm/min" in out


def test_accepting_shows_the_difference_and_takes_it_over(case: Path, capsys: Capture) -> None:
    case.write_text(PROJECT.replace("TOP", "NEW TITLE"))
    old = case.with_name("top.mpf").read_text()
    code, out, _ = tried(capsys, case.parent, "--accept")
    assert code == 0
    assert out.index("+N10 ;NEW TITLE") < out.index("accepted: top.mpf")
    assert case.with_name("top.mpf").read_text() == old.replace(";TOP", ";NEW TITLE")
    assert tried(capsys, case.parent)[0] == 0


def test_a_new_case_is_told_and_written_only_when_accepted(tmp_path: Path, capsys: Capture) -> None:
    path = project(tmp_path, PROJECT + 'divide = "subprograms"\n', name="case.toml")
    before = contents(tmp_path)
    code, out, err = tried(capsys, tmp_path)
    assert (code, contents(tmp_path)) == (1, before)
    assert err.startswith(f"trunnion test {tmp_path} --accept takes")
    assert f"{path}: NEW: top.mpf is new; FACE.spf is new; SLOT_2.spf is new" in out
    code, out, _ = tried(capsys, tmp_path, "--accept")
    assert code == 0
    assert "accepted: FACE.spf, SLOT_2.spf, top.mpf" in out
    # Nobody on this computer has posted the subprograms, as after a clone: a test does not mind.
    assert tried(capsys, tmp_path)[0] == 0
    (tmp_path / "FACE.spf").write_text((tmp_path / "FACE.spf").read_text().replace("F500.", "F400."))
    code, out, _ = tried(capsys, tmp_path)
    assert "DIFFERENT: FACE.spf: text: 1 line removed, 1 added" in out
    assert "feed 400 against 500 mm/min" in out


def test_a_program_that_must_not_run_is_never_accepted(case: Path, capsys: Capture) -> None:
    case.with_name("top.cls").write_text(
        operation("A").replace("10.0,0.0,5.0", "10.0,0.0,5.0,0.0,0.7071068,-0.7071068")
    )
    before = contents(case.parent)
    code, out, err = tried(capsys, case.parent, "--accept")
    assert code == 1
    assert f"{case}: REFUSED: a program must not run" in out
    assert "top.cls:" in err
    assert contents(case.parent) == before


def test_what_a_simulation_refuses_is_told_by_the_names_of_the_case(tmp_path: Path, capsys: Capture) -> None:
    into_stock = operation("A").replace("GOTO/0.0,0.0,50.0", "GOTO/0.0,0.0,-5.0")
    checked = 'stock = "box:60,60,20,-10,-30,-20"\ncell_mm = 2.0\n[checks]\nsimulate = "refuse"\n'
    path = project(tmp_path, PROJECT + checked, top=into_stock)
    code, out, err = tried(capsys, path)
    assert (code, "REFUSED" in out) == (1, True)
    assert f"{tmp_path / 'top.mpf'}:" in err
    assert "trunnion-" not in err


def test_one_case_does_not_stop_the_others(case: Path, capsys: Capture) -> None:
    broken = project(case.parent.parent / "broken", PROJECT.replace("yl569", "none"))
    code, out, err = tried(capsys, case.parent.parent)
    assert code == 2
    assert out.splitlines() == [
        f"{broken}: NOT TESTED: it cannot be posted", f"{case}: same: top.mpf", "2 cases: 1 not tested, 1 same",
    ]  # fmt: skip
    assert f"{broken}:1: error: machine" in err


def test_programs_of_operations_that_are_gone_fail(tmp_path: Path, capsys: Capture) -> None:
    path = project(tmp_path, PROJECT + 'divide = "operations"\n')
    trunnion.post_project(path)
    path.with_name("top.cls").write_text(operation("FACE"))
    path.with_name("top_3_MINE.mpf").write_text("M30\n")
    assert tried(capsys, path)[0] == 1
    code, out, _ = tried(capsys, path, "--accept")
    assert (code, out.splitlines()[-1]) == (1, "1 case: 1 different")
    assert f"{path}: GONE: top_2_SLOT_2.mpf" in out
    assert f"{path}: removed: top_2_SLOT_2.mpf" in out
    assert sorted(file.name for file in tmp_path.glob("*.mpf")) == ["top_1_FACE.mpf", "top_3_MINE.mpf"]
    path.with_name("top_3_MINE.mpf").unlink()
    assert tried(capsys, path)[0] == 0


def test_accepting_a_renamed_operation_leaves_nothing_to_cure(tmp_path: Path, capsys: Capture) -> None:
    path = project(tmp_path, PROJECT + 'divide = "operations"\n')
    trunnion.post_project(path)
    path.with_name("top.cls").write_text(operation("FACE") + operation("POCKET", start=""))
    code, out, _ = tried(capsys, path, "--accept")
    assert (code, out.splitlines()[-1]) == (0, "1 case: 1 accepted")
    assert sorted(file.name for file in tmp_path.glob("*.mpf")) == ["top_1_FACE.mpf", "top_2_POCKET.mpf"]
    assert tried(capsys, path)[0] == 0


PAPERS = 'manifest = "m.json"\nlisting = "top.txt"\nsheet = "sheet.json"\nreport = "top.html"\n'


def test_papers_are_compared_and_accepted_with_their_program(
    tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = project(tmp_path, PROJECT + PAPERS)
    trunnion.post_project(path)
    before = contents(tmp_path)
    monkeypatch.chdir(tmp_path)  # how files are called is nothing of the papers
    assert tried(capsys, path.name)[0] == 0
    for name in ("m.json", "top.txt", "sheet.json", "top.html"):
        for change in (path.with_name(name).unlink, lambda name=name: path.with_name(name).write_text("{}\n")):
            change()
            code, out, _ = tried(capsys, path)
            assert (code, f"{path}: PAPER: {name} " in out) == (1, True)
            assert tried(capsys, path, "--accept")[0] == 0
            assert contents(tmp_path) == before
    path.with_name("top.cls").write_text(TWO.replace("10.0,0.0,5.0", "10.0,0.0,4.0"))
    assert tried(capsys, path, "--accept")[0] == 0
    assert trunnion.verify_manifest(tmp_path / "m.json").passed
    now = contents(tmp_path)
    assert all(now[name] != before[name] for name in ("m.json", "top.txt", "sheet.json", "top.html", "top.mpf"))
    trunnion.post_project(path)  # papers count as what the project has written
    assert contents(tmp_path) == now


def test_what_changes_after_the_comparison_is_not_accepted(tmp_path: Path) -> None:
    path = project(tmp_path)
    with posted_case(path) as case:
        path.with_name("top.cls").write_text(TWO.replace("10.0,0.0,5.0", "10.0,0.0,4.0"))
        before = contents(tmp_path)
        with pytest.raises(trunnion.InputError, match="has changed since it was compared"):
            case.accept()
    assert contents(tmp_path) == before


def test_a_huge_file_in_place_of_a_program_is_not_read(case: Path, capsys: Capture) -> None:
    with case.with_name("top.mpf").open("r+b") as file:
        file.truncate(1 << 25)
    code, out, _ = tried(capsys, case)
    assert code == 1
    assert "33554432 bytes are there" in out
    assert "motion: not compared: top.mpf is far larger" in out


def test_a_link_to_a_file_elsewhere_is_not_read(case: Path, tmp_path: Path, capsys: Capture) -> None:
    (tmp_path / "secret").write_text("SECRET\n")
    case.write_text(PROJECT + 'divide = "subprograms"\n')
    case.with_name("FACE.spf").symlink_to(tmp_path / "secret")
    code, out, err = tried(capsys, case.parent)
    assert code == 2
    assert "SECRET" not in out + err
    assert "FACE.spf: error: leads out of the folder" in err


def test_an_old_program_that_nobody_can_read_is_told(case: Path, capsys: Capture) -> None:
    case.with_name("top.mpf").write_bytes(b"\x00\xff nonsense\n")
    code, out, _ = tried(capsys, case.parent)
    assert code == 1
    assert "motion: the program that is there cannot be read" in out


@pytest.mark.parametrize(
    ("place", "words"),
    [
        ("", "has no case: no case.toml, part.toml or file that ends in .case.toml"),
        ("none", "is no folder, and no project"),
    ],
)
def test_a_folder_without_cases_is_an_error(tmp_path: Path, place: str, words: str, capsys: Capture) -> None:
    (tmp_path / ".hidden").mkdir()
    project(tmp_path / ".hidden")
    code, _, err = tried(capsys, tmp_path / place)
    assert code == 2
    assert words in err


def test_the_example_comes_out_and_is_what_the_page_shows(capsys: Capture) -> None:
    folder = ROOT / "examples" / "project"
    code, out, _ = tried(capsys, folder)
    assert (code, out.splitlines()[-1]) == (0, "1 case: 1 same")
    shown = (folder / "part.toml").read_text(encoding="utf-8").split("\n", 2)[2]
    assert f"```toml\n{shown}```" in (ROOT / "docs" / "projects.md").read_text(encoding="utf-8")
    found = trunnion.simulate(folder / "part.toml")
    assert found.passed
    assert [one.removed for one in found.operations] == pytest.approx([8000.0, 5000.0, 6400.0], rel=1e-3)


def test_accepting_makes_the_programs_of_a_clone_those_of_the_project(tmp_path: Path, capsys: Capture) -> None:
    first = project(tmp_path / "first", PROJECT + 'divide = "subprograms"\n')
    trunnion.post_project(first)
    clone = project(tmp_path / "clone", first.read_text())
    for program in (*first.parent.glob("*.mpf"), *first.parent.glob("*.spf")):
        clone.with_name(program.name).write_bytes(program.read_bytes())
    with pytest.raises(trunnion.InputError, match=r"FACE\.spf would be replaced, although top\.mpf"):
        trunnion.post_project(clone)
    code, out, _ = tried(capsys, clone, "--accept")
    assert (code, "accepted" in out) == (0, False)
    assert len(trunnion.post_project(clone).files) == 3


def test_cases_that_share_a_definition_stand_above_it(tmp_path: Path, capsys: Capture) -> None:
    own = tmp_path / "machines" / "own.toml"
    own.parent.mkdir()
    own.write_text('extends = "yl569"\n')
    for name in ("blade", "flange"):
        project(tmp_path / name)
        text = PROJECT.replace("yl569", "machines/own.toml").replace("top.", f"{name}/top.")
        (tmp_path / f"{name}.case.toml").write_text(text)
        (tmp_path / name / "part.toml").unlink()
    assert tried(capsys, tmp_path, "--accept")[0] == 0
    own.write_text('extends = "yl569"\n[control.settings]\nwork_offset = "G57"\n')
    code, out, _ = tried(capsys, tmp_path)
    assert code == 1
    assert out.count("DIFFERENT: top.mpf: text: ") == out.count("and block numbers behind them") == 2
    assert out.count("motion: different: ") == 2
