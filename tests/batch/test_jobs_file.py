"""Files of jobs, and folders: which files are taken, and what is refused with its line."""

import re
from pathlib import Path

import pytest

from tests.support.batches import write_files
from trunnion.batch.jobs import Batch, folder_batch
from trunnion.batch.jobs_file import load_batch
from trunnion.batch.worker_task import Action
from trunnion.errors import InputError


def load(folder: Path, text: str, *names: str) -> Batch:
    write_files(folder, dict.fromkeys(names or ("a/x.cls", "b/x.cls", "b/y.nc"), "") | {"jobs.toml": text})
    return load_batch(folder / "jobs.toml")


def problems(folder: Path, text: str) -> list[str]:
    with pytest.raises(InputError) as caught:
        load(folder, text)
    return [str(each).removeprefix(f"{folder}/jobs.toml:") for each in caught.value.problems]


def test_defaults_hold_for_jobs_that_state_nothing_else(tmp_path: Path) -> None:
    text = """
results = "out"
[defaults]
machine = "yl569"
settings = {title = "ALL", part = "P"}
tolerance_mm = 0.01
[[job]]
files = ["**/*.cls"]
settings = {title = "OWN"}
[[job]]
name = "check"
action = "verify"
files = ["b/*.nc"]
machine = "dmu65"
cl = ["{folder}/x.cls"]
"""
    batch = load(tmp_path, text)
    post, check = batch.jobs
    assert batch.results == tmp_path / "out"
    assert (post.name, post.action, list(post.files)) == ("job 1", Action.POST, ["a/x.cls", "b/x.cls"])
    assert post.arguments == {"machine": "yl569", "settings": {"title": "OWN", "part": "P"}}
    assert post.extension == ".mpf"
    assert (check.name, list(check.files)) == ("check", ["b/y.nc"])
    assert check.arguments == {"machine": "dmu65", "tolerance": 0.01}
    assert check.beside == {"cl": ["{folder}/x.cls"]}


SIMULATE = '[[job]]\nmachine = "yl569"\nfiles = ["**"]\naction = "simulate"\n'
CONVERT = SIMULATE.replace("simulate", "convert")


def test_tools_whose_diameters_cl_files_state_are_no_mistakes(tmp_path: Path) -> None:
    text = SIMULATE + 'stock = "box:9,9,9"\ntools = ["1=ball:length=60,flutes=20"]\ncl = ["{folder}/{stem}.cls"]\n'
    assert load(tmp_path, text).jobs[0].arguments["tools"] == ["1=ball:length=60,flutes=20"]


@pytest.mark.parametrize(
    ("pattern", "told"),
    [
        ("link.cls", "link.cls is a link that leads out"), ("*.nc", "gone.nc is no file"), (".hid.cls", "is hidden"),
        ("results/*.cls", "results/x.cls lies in a folder of results"), ("**/old/*", "lies in a folder of results"),
        ("inner/x.cls", "links to folders are not followed"),
    ],
)  # fmt: skip
def test_why_a_pattern_matches_no_file_is_told(tmp_path: Path, pattern: str, told: str) -> None:
    names = ("in/a.cls", "in/.hid.cls", "in/results/x.cls", "in/old/x.apt", "in/old/.trunnion-batch/r", "far/x.cls")
    write_files(tmp_path, dict.fromkeys(names, ""))
    (tmp_path / "in/link.cls").symlink_to(tmp_path / "far/x.cls")
    (tmp_path / "in/gone.nc").symlink_to(tmp_path / "in/no")
    (tmp_path / "in/inner").symlink_to(tmp_path / "far", target_is_directory=True)
    (found,) = problems(tmp_path / "in", f'[[job]]\nmachine = "yl569"\nfiles = ["{pattern}"]\n')
    assert "matches no file" in found
    assert told in found
    with pytest.raises(InputError, match=re.escape(told)):
        folder_batch(tmp_path / "in", Action.POST, {"machine": "yl569"}, tmp_path / "in/results", [pattern])


def test_the_file_of_jobs_is_no_input(tmp_path: Path) -> None:
    batch = load(tmp_path, '[[job]]\nmachine = "yl569"\nfiles = ["**"]\n')
    assert batch.jobs[0].files == ["a/x.cls", "b/x.cls", "b/y.nc"]


@pytest.mark.parametrize("name", ["../{stem}.cls", "{nope}.cls", "?.cls", "/x.cls", ""])
def test_names_of_cl_files_are_judged_before_any_work(tmp_path: Path, name: str) -> None:
    write_files(tmp_path, {"x.mpf": ""})
    with pytest.raises(InputError, match="cl"):
        folder_batch(tmp_path, Action.VERIFY, {"machine": "yl569", "cl": [name]}, None)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "job is missing"),
        ('[[job]]\nfiles = ["**/*.cls"]', "machine is missing"),
        ('[[job]]\nmachine = "yl569"\nfiles = ["../*"]', "leads out of the folder"),
        ('[[job]]\nmachine = "yl569"\nfiles = []', "is []"),
        ('[[job]]\nmachine = "yl569"\nfiles = ["*.apt"]', "matches no file"),
        ('[[job]]\nmachine = "yl569"\nfiles = ["**"]\noutput = "../x"', "leads out of the folder"),
        ('[[job]]\nmachine = "yl569"\nfiles = ["**"]\noutput = ".git"', "begins with a point"),
        ('results = "/tmp"\n[[job]]\nmachine = "yl569"\nfiles = ["**"]', "leads out of the folder"),
        ('[[job]]\nmachine = "../m.toml"\nfiles = ["**"]', "leads out of the folder"),
        ('[[job]]\nmachine = "yl569"\nfiles = ["**"]\nstock = "box:1,1,1"', 'has no meaning with action = "post"'),
        ('[[job]]\nmachine = "yl569"\nfiles = ["**"]\nsettings = {nosuch = 1}', "nosuch"),
        ('[[job]]\nmachine = "yl569"\nfiles = ["**"]\naction = "convert"', "to_machine"),
        ('[[job]]\nmachine = "yl569"\nfiles = ["**"]\naction = "simulate"', "stock is missing"),
        ('[[job]]\nmachine = "yl569"\nfiles = ["**"]\nname = "a"\n' * 2, "twice"),
        ('[[job]]\nmachine = "yl569"\nfiles = ["**"]\nhooks = ["x.py"]', "hooks is not a key"),
        ('[[job]]\nmachine = "yl569"\nfiles = ["**"]\naction = "verify"\ncl = ["../{stem}.cls"]', "leads out"),
        ('[[job]]\nmachine = "yl569"\nfiles = ["**"]\naction = "verify"\ncl = ["{nope}.cls"]', "has { or }"),
        ('[[job]]\nmachine = "yl569"\nfiles = ["**"]\naction = "verify"\ncl = ["*.cls"]', "is a pattern"),
        ('results = "~/x"\n[[job]]\nmachine = "yl569"\nfiles = ["**"]', "begins with ~"),
        ('results = "CON"\n[[job]]\nmachine = "yl569"\nfiles = ["**"]', 'results "CON" is a device'),
        ('[[job]]\nmachine = "yl569"\nfiles = ["jobs.toml"]', "is the file of jobs itself"),
        (SIMULATE + 'stock = "box:1,2"', "has 2 numbers"),
        (SIMULATE + 'stock = "box:9,9,9"\ncell_mm = 1e-9', "of memory"),
        (SIMULATE + 'stock = "box:9,9,9"\ntools = ["1=bell:9"]', "1=bell:9"),
        (CONVERT + 'to_machine = "dmu65"\nsettings = {cl_units = "mm"}', "cl_units has no meaning"),
        (CONVERT + "to_cl = true\nsettings = {nosuch = 1}", "nosuch"),
        (CONVERT + 'to_cl = true\nsettings = {units = "inch"}', "units has no meaning"),
    ],
)
def test_mistakes_are_told(tmp_path: Path, text: str, told: str) -> None:
    found = problems(tmp_path, text)
    assert any(told in each for each in found), found


def test_mistakes_are_told_together_with_their_lines(tmp_path: Path) -> None:
    text = '[defaults]\nmachine = "nosuch"\n[[job]]\nfiles = ["*.apt"]\nhooks = []\n'
    assert [each.partition(":")[0] for each in problems(tmp_path, text)] == ["2", "4", "5"]


def test_results_are_no_inputs(tmp_path: Path) -> None:
    text = '[[job]]\nmachine = "yl569"\nfiles = ["**/*.cls"]\n'
    batch = load(tmp_path, text + "")
    write_files(tmp_path, {"results/old.cls": ""})
    assert batch.jobs[0].files == load_batch(tmp_path / "jobs.toml").jobs[0].files


def test_a_folder_gives_the_files_of_its_action(tmp_path: Path) -> None:
    write_files(tmp_path, dict.fromkeys(("a.cls", "B.APT", "c.mpf", "d/e.MPF", "f.txt"), ""))
    posted = folder_batch(tmp_path, Action.POST, {"machine": "yl569"}, None)
    assert posted.jobs[0].files == ["B.APT", "a.cls"]
    checked = folder_batch(tmp_path, Action.VERIFY, {"machine": "yl569"}, None)
    assert checked.jobs[0].files == ["c.mpf", "d/e.MPF"]
    named = folder_batch(tmp_path, Action.VERIFY, {"machine": "yl569"}, None, ["*.txt"])
    assert named.jobs[0].files == ["f.txt"]
    with pytest.raises(InputError, match="BAT120"):
        folder_batch(tmp_path, Action.VERIFY, {"machine": "haas_umc750"}, None, ["*.x"])


def test_a_definition_goes_with_all_that_it_extends(tmp_path: Path) -> None:
    write_files(
        tmp_path, {"in/a.cls": "", "lib/base.toml": 'extends = "yl569"\n', "lib/m.toml": 'extends = "base.toml"\n'}
    )
    batch = folder_batch(tmp_path / "in", Action.POST, {"machine": str(tmp_path / "lib/m.toml")}, None)
    assert batch.jobs[0].arguments["machine"] == "definitions/m.toml"
    assert sorted(batch.jobs[0].shared) == ["definitions/base.toml", "definitions/m.toml"]
