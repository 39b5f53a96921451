"""Papers and subprograms of the program before: a post that does not write them again names them."""

from pathlib import Path

import pytest

import trunnion
from trunnion.cli import main
from trunnion.files.earlier_job import EarlierJob

BLADE = Path("tests/golden/yl569/3_blade_finish.cls")
HUB = Path("tests/golden/yl569/2_hub_rough.cls")


@pytest.fixture
def part(tmp_path: Path) -> Path:
    """The place of a program that was posted with a sheet and a listing."""
    place = tmp_path / "part.mpf"
    post(place, HUB, sheet=tmp_path / "part.sheet.html", listing=tmp_path / "part.lst")
    return place


def post(place: Path, *files: Path, settings: dict[str, str] | None = None, **papers: Path) -> list[str]:
    """Post, and return what is told of files of the program before."""
    result = trunnion.post(files, machine="yl569", output=place, settings=settings, **papers)  # type: ignore[arg-type]
    return [problem.what for problem in result.problems if problem.code == "FIL280"]


def test_papers_that_stay_of_another_program_are_named(part: Path) -> None:
    assert post(part, BLADE) == ["part.sheet.html, part.lst are of the program before"]
    assert post(part, BLADE), "they are still of the program before"
    assert post(part, BLADE, listing=part.with_suffix(".lst")) == ["part.sheet.html is of the program before"]
    assert post(part, BLADE) == ["part.sheet.html is of the program before"]
    part.with_suffix(".sheet.html").unlink()
    assert post(part, BLADE) == []
    assert post(part, HUB) == ["part.lst is of the program before"]


def test_nothing_is_told_where_nothing_is_stale(part: Path) -> None:
    papers = {"sheet": part.with_suffix(".sheet.html"), "listing": part.with_suffix(".lst")}
    assert post(part, HUB) == [], "the same program"
    assert post(part, BLADE, sheet=papers["sheet"], listing=papers["listing"]) == []
    assert post(part.with_name("other.mpf"), HUB) == [], "another program of the folder"
    papers["sheet"].write_text("by hand")
    papers["listing"].unlink()
    assert post(part, HUB) == [], "nobody knows of which program it is"


def test_a_paper_in_another_folder_is_named_with_its_path(tmp_path: Path) -> None:
    (tmp_path / "papers").mkdir()
    report, place = tmp_path / "papers" / "part.html", tmp_path / "part.mpf"
    post(place, HUB, report=report)
    assert post(place, BLADE) == [f"{report} is of the program before"]
    assert post(place, HUB) == []


def test_subprograms_that_the_new_program_does_not_have_are_named(tmp_path: Path) -> None:
    place = tmp_path / "part.mpf"
    assert post(place, HUB, BLADE, settings={"programs": "operations"}) == []
    files = {file.name for file in tmp_path.iterdir()}
    told = post(place, HUB, settings={"programs": "operations"})
    again = {file.name for file in tmp_path.iterdir()}
    assert files == again
    assert len(told) == 1
    assert "part.mpf" not in told[0]
    assert post(place, HUB, BLADE, settings={"programs": "operations"}) == []
    assert len(post(place, HUB)) == 1, "no subprogram at all is written now"


def test_the_report_of_a_refusal_is_stale_when_a_program_is_written(tmp_path: Path) -> None:
    place, report = tmp_path / "part.mpf", tmp_path / "part.json"
    wild = {"zero": "0,0,100000"}
    with pytest.raises(trunnion.RefusedError):
        post(place, HUB, settings=wild, report=report)
    assert report.exists()
    assert post(place, HUB) == ["part.json is of the program before"]


def test_the_command_warns(part: Path, capsys: pytest.CaptureFixture[str]) -> None:
    part.with_suffix(".lst").unlink()
    assert main(["post", str(BLADE), "--machine", "yl569", "--output", str(part)]) == 0
    told = [line for line in capsys.readouterr().err.splitlines() if "FIL280" in line]
    assert told == [
        f"{part}: warning: part.sheet.html is of the program before; write it with this one, or delete it [FIL280]"
    ]


def test_a_project_warns_of_a_paper_that_it_no_longer_asks_for(tmp_path: Path) -> None:
    project = tmp_path / "project.toml"
    text = 'machine = "yl569"\ncl = ["part.cls"]\noutput = "part.mpf"\n'
    (tmp_path / "part.cls").write_bytes(HUB.read_bytes())
    project.write_text(text + 'sheet = "part.html"\n')

    def told() -> list[str]:
        (result,) = trunnion.post_project(project).results
        return [problem.what for problem in result.problems if problem.code == "FIL280"]

    assert told() == []
    (tmp_path / "part.cls").write_bytes(BLADE.read_bytes())
    assert told() == []
    project.write_text(text)
    assert told() == []
    (tmp_path / "part.cls").write_bytes(HUB.read_bytes())
    assert told() == ["part.html is of the program before"]


def test_a_record_of_an_older_release_is_read(tmp_path: Path) -> None:
    program, paper = tmp_path / "part.mpf", tmp_path / "part.html"
    for file in (program, paper):
        file.write_text(file.name)
    job = EarlierJob(program)
    job.remember([program], [paper])
    assert job._record is not None
    text = job._record.read_text()
    for parts in (2, 1):
        older = EarlierJob(program)
        older._digests = {name: ":".join(known.split(":")[2 - parts : 2]) for name, known in job._read().items()}
        assert older.wrote(paper)
        assert older.left_over([program], [program]) == [paper]
    assert text == job._record.read_text()
    assert EarlierJob(program).left_over([program], [program]) == []


HEAD = 'machine = "yl569"\n'
FIRST = '[[setup]]\nname = "first"\ncl = ["one.cls"]\noutput = "one.mpf"\nsheet = "one.html"\n'
SECOND = '[[setup]]\nname = "second"\ncl = ["two.cls"]\noutput = "two.mpf"\nsheet = "two.html"\nlisting = "two.lst"\n'


def post_setups(folder: Path, *setups: str) -> list[str]:
    """Post a project of these set-ups, and return what is told of set-ups that are gone."""
    (folder / "one.cls").write_bytes(HUB.read_bytes())
    (folder / "two.cls").write_bytes(BLADE.read_bytes())
    (folder / "project.toml").write_text(HEAD + "".join(setups))
    result = trunnion.post_project(folder / "project.toml")
    assert {problem.code for problem in result.problems} <= {"PRJ155"}
    return [problem.what for problem in result.problems]


def test_files_of_a_setup_that_is_gone_are_named_as_long_as_they_stay(tmp_path: Path) -> None:
    assert post_setups(tmp_path, FIRST, SECOND) == []
    assert post_setups(tmp_path, FIRST) == ["two.html, two.lst, two.mpf are of a set-up that it no longer has"]
    (tmp_path / "two.mpf").unlink()
    for _ in range(2):
        assert post_setups(tmp_path, FIRST) == ["two.html, two.lst are of a set-up that it no longer has"]
    (tmp_path / "two.lst").write_text("with notes of the operator")
    assert post_setups(tmp_path, FIRST) == ["two.html is of a set-up that it no longer has"]
    (tmp_path / "two.html").unlink()
    assert post_setups(tmp_path, FIRST) == []
    (tmp_path / "two.lst").unlink()
    assert post_setups(tmp_path, FIRST, SECOND) == [], "it is back"


def test_a_setup_that_writes_to_other_files_leaves_the_old_ones(tmp_path: Path) -> None:
    assert post_setups(tmp_path, FIRST, SECOND) == []
    renamed = SECOND.replace('"two.', '"three.').replace("three.cls", "two.cls")
    told = "two.html, two.lst, two.mpf are of set-up {} under its earlier name"
    assert post_setups(tmp_path, FIRST, renamed) == [told.format("second")]
    assert post_setups(tmp_path, FIRST, renamed.replace("second", "other")) == [told.format("other")], "of the same CL"
    changed = renamed.replace("two.cls", "one.cls")
    assert post_setups(tmp_path, FIRST, changed) == [told.format("second")], "of the same name"
    other = changed.replace("second", "other")
    assert post_setups(tmp_path, "", other)[0].endswith("under its earlier name"), "one.cls is posted by another set-up"


def test_projects_of_one_folder_know_nothing_of_each_other(tmp_path: Path) -> None:
    assert post_setups(tmp_path, FIRST, SECOND) == []
    other = tmp_path / "other.toml"
    other.write_text(HEAD + FIRST.replace("one.mpf", "other.mpf").replace("one.html", "other.html"))
    assert trunnion.post_project(other).problems == ()


def test_a_project_that_is_refused_forgets_nothing(tmp_path: Path) -> None:
    assert post_setups(tmp_path, FIRST, SECOND) == []
    with pytest.raises(trunnion.RefusedError):
        post_setups(tmp_path, "zero_mm = [0, 0, 100000]\n", FIRST)
    assert post_setups(tmp_path, FIRST) == ["two.html, two.lst, two.mpf are of a set-up that it no longer has"]


def test_the_command_warns_of_a_setup_that_is_gone(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    post_setups(tmp_path, FIRST, SECOND)
    (tmp_path / "project.toml").write_text(HEAD + FIRST)
    assert main(["post", str(tmp_path / "project.toml")]) == 0
    told = [line for line in capsys.readouterr().err.splitlines() if "PRJ155" in line]
    assert told == [
        f"{tmp_path / 'project.toml'}: warning: two.html, two.lst, two.mpf are of a set-up that it no longer has;"
        " delete them, here and on the control [PRJ155]"
    ]


def test_a_paper_that_a_setup_no_longer_asks_for_is_not_of_one_that_is_gone(tmp_path: Path) -> None:
    assert post_setups(tmp_path, FIRST, SECOND) == []
    assert post_setups(tmp_path, FIRST, SECOND.replace('listing = "two.lst"\n', "")) == []


def test_an_unnamed_setup_that_writes_to_another_file_is_named_as_the_program(tmp_path: Path) -> None:
    text = 'cl = ["one.cls"]\noutput = "{}.mpf"\n'
    assert post_setups(tmp_path, text.format("one")) == []
    assert post_setups(tmp_path, text.format("two")) == ["one.mpf is of its program under the earlier name"]


def test_a_program_that_somebody_else_has_written_since_is_live(tmp_path: Path) -> None:
    assert post_setups(tmp_path, FIRST, SECOND) == []
    other = tmp_path / "other.toml"
    other.write_text(HEAD + SECOND)
    assert trunnion.post_project(other).problems == ()
    for _ in range(2):
        assert post_setups(tmp_path, FIRST) == [], "the other project has it now"
    assert post_setups(tmp_path, FIRST, SECOND) == []
    post(tmp_path / "two.mpf", BLADE)
    assert post_setups(tmp_path, FIRST) == [], "it was posted alone"


def test_a_program_that_a_setup_still_uses_is_live(tmp_path: Path) -> None:
    assert post_setups(tmp_path, FIRST, SECOND) == []
    kept = '[[setup]]\nname = "second"\nprograms = ["two.mpf"]\n'
    assert post_setups(tmp_path, FIRST, kept) == []
    released = FIRST + 'released = ["two.mpf"]\n'
    (tmp_path / "project.toml").write_text(HEAD + released)
    result = trunnion.post_project(tmp_path / "project.toml")
    assert not [problem for problem in result.problems if problem.code == "PRJ155"]
    assert post_setups(tmp_path, FIRST) == ["two.html, two.lst, two.mpf are of a set-up that it no longer has"]


def test_papers_may_go_on_with_a_program_of_another_name(tmp_path: Path) -> None:
    post_setups(tmp_path, FIRST, SECOND)
    post_setups(tmp_path, FIRST, SECOND.replace("two.mpf", "bottom.mpf"))
    told = post_setups(tmp_path, FIRST, SECOND.replace("two.mpf", "Two.mpf"))
    assert told
    assert all(each.endswith(".mpf is of set-up second under its earlier name") for each in told)
    (tmp_path / "two.html").write_text("with notes of the operator")
    with pytest.raises(trunnion.InputError, match="no post has written it"):
        post_setups(tmp_path, FIRST, SECOND.replace("two.mpf", "four.mpf"))


def test_setups_may_swap_their_outputs(tmp_path: Path) -> None:
    assert post_setups(tmp_path, FIRST, SECOND) == []
    swapped = FIRST.replace("one.mpf", "two.mpf"), SECOND.replace("two.mpf", "one.mpf")
    assert post_setups(tmp_path, *swapped) == []


def test_a_program_is_no_paper(tmp_path: Path) -> None:
    post(tmp_path / "one.html", HUB)
    with pytest.raises(trunnion.InputError, match="no post has written it"):
        post_setups(tmp_path, FIRST)
