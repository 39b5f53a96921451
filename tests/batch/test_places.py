"""Places of results and patterns of names."""

import os
import unicodedata
from fnmatch import fnmatchcase
from pathlib import Path, PurePosixPath

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.support.locations import YL569
from trunnion.batch.batch_run import run_batch
from trunnion.batch.jobs import BatchJob, folder_files
from trunnion.batch.patterns import matches, pattern_fault
from trunnion.batch.places import units_of
from trunnion.batch.worker_task import Action
from trunnion.errors import InputError
from trunnion.files import name_fault

NAMES = st.text(st.sampled_from("aAbé.:*<~ \u202e-"), min_size=1, max_size=6).filter(
    lambda name: name not in (".", "..")
)
FILES = st.lists(st.lists(NAMES, min_size=1, max_size=3).map("/".join), max_size=12, unique=True)


def places(*files: str, action: Action = Action.POST, output: str = "") -> list[str]:
    return [unit.place for unit in units_of([BatchJob("job", action, files, {}, output=output, extension=".mpf")])]


def test_results_lie_as_their_files_do() -> None:
    assert places("b/x.cls", "a/x.cls", "top.cls.gz") == ["a/x.mpf", "b/x.mpf", "top.mpf"]
    assert places("a/x.cls", output="out/five") == ["out/five/a/x.mpf"]
    assert places("a/x.mpf", action=Action.VERIFY) == ["a/x.mpf.verification"]


@pytest.mark.parametrize(
    ("files", "clashing"),
    [
        (("x.cls", "x.ncl", "y.cls"), {"x.cls": "x.mpf", "x.ncl": "x.mpf", "y.cls": ""}),
        (("x.cls", "X.cls"), {"x.cls": "x.mpf", "X.cls": "X.mpf"}),
        (("a.cls", "a.mpf/b.cls", "b.cls"), {"a.cls": "a.mpf", "a.mpf/b.cls": "a.mpf/b.mpf", "b.cls": ""}),
        (("a.cls", "A.MPF/c/b.cls"), {"a.cls": "a.mpf", "A.MPF/c/b.cls": "A.MPF/c/b.mpf"}),
    ],
)
def test_files_whose_results_would_have_one_place_have_none(files: tuple[str, ...], clashing: dict[str, str]) -> None:
    units = units_of([BatchJob("job", Action.POST, files, {}, extension=".mpf")])
    assert {unit.file: unit.clash for unit in units} == clashing


def test_files_of_which_nothing_is_written_share_no_place() -> None:
    jobs = [BatchJob(name, Action.VERIFY, ["x.mpf"], {}) for name in ("one", "other")]
    assert [unit.clash for unit in units_of(jobs)] == ["", ""]
    reported = [BatchJob(name, Action.VERIFY, ["x.mpf"], {}, report="html") for name in ("one", "other")]
    assert [unit.clash for unit in units_of(reported)] == ["x.mpf.verification"] * 2


def test_names_that_some_system_does_not_take_are_replaced() -> None:
    (place,) = places("con.cls")
    assert place.startswith("con-")
    assert place.endswith(".mpf")
    assert not name_fault(PurePosixPath(place))


@given(FILES, FILES)
def test_places_are_unique_and_safe_on_every_system(one: list[str], other: list[str]) -> None:
    jobs = [
        BatchJob(name, Action.POST, files, {}, extension=".mpf") for name, files in (("one", one), ("other", other))
    ]
    units = units_of(jobs)
    folded = [unicodedata.normalize("NFC", unit.place).casefold() for unit in units]
    assert len(set(folded)) == len(units) == len(one) + len(other)
    assert not [unit for unit in units if name_fault(PurePosixPath(unit.place))]
    alone = [
        unit
        for job in jobs
        for file in job.files
        for unit in units_of([BatchJob(job.name, job.action, [file], {}, extension=".mpf")])
    ]
    assert {unit.place for unit in units if not unit.clash} <= {unit.place for unit in alone}
    assert {unit.clash for unit in units if unit.clash} <= {unit.place for unit in alone}
    turned = units_of([BatchJob(job.name, job.action, job.files[::-1], {}, extension=".mpf") for job in jobs])
    assert turned == units


@pytest.mark.parametrize(
    ("name", "pattern", "is_one"),
    [
        ("x.cls", "*.cls", True), ("a/x.cls", "*.cls", False), ("a/x.cls", "*/*.cls", True),
        ("x.cls", "**/*.cls", True), ("a/b/x.cls", "**/*.cls", True), ("a/b/x.cls", "a/**", True),
        ("a/b/x.cls", "a/**/x.cls", True), ("a/x.cls", "a/**/x.cls", True), ("b/x.cls", "a/**", False),
        ("a/b/c/d", "**/b/**/d", True), ("x.CLS", "*.cls", False), ("x.cls", "./x.cls", True),
        ("x1.cls", "x?.cls", True), ("a", "a/**", False), ("a/b", "**", True),
    ],
)  # fmt: skip
def test_patterns(name: str, pattern: str, is_one: bool) -> None:
    assert matches(name, pattern) is is_one


@given(
    st.text(st.sampled_from("ab*?."), min_size=1, max_size=6), st.text(st.sampled_from("ab."), min_size=1, max_size=6)
)
def test_a_pattern_without_folders_is_that_of_the_shell(pattern: str, name: str) -> None:
    assert matches(name, pattern) is (fnmatchcase(name, pattern) or pattern == "**")


def test_patterns_of_many_folders_take_no_time() -> None:
    assert not matches("/".join("a" * 400), "/".join(["**", "a"] * 200) + "/b")


@pytest.mark.parametrize("pattern", ["", "/x", "../x", "a/../x", "a//x", "a/", "c:x", "a\\x", "x" * 1001])
def test_patterns_that_lead_out_of_the_folder_are_refused(pattern: str) -> None:
    assert pattern_fault(pattern)


def test_files_of_a_folder_are_those_within(tmp_path: Path) -> None:
    for name in (
        "in/a/x.cls",
        "in/.hidden/y.cls",
        "in/out/z.cls",
        "in/.y.cls",
        "secret.cls",
        "in/other/.trunnion-batch/r",
    ):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    (tmp_path / "in/link.cls").symlink_to(tmp_path / "secret.cls")
    (tmp_path / "in/same.cls").symlink_to(tmp_path / "in/a/x.cls")
    (tmp_path / "in/nowhere.cls").symlink_to(tmp_path / "in/no")
    (tmp_path / "in/folder.cls").mkdir()
    if hasattr(os, "mkfifo"):
        os.mkfifo(tmp_path / "in/pipe.cls")
    (tmp_path / "in/loop").symlink_to(tmp_path / "in", target_is_directory=True)
    assert folder_files(tmp_path / "in", tmp_path / "in/out") == ["a/x.cls", "same.cls"]


def test_results_never_take_the_places_of_files_that_are_read(tmp_path: Path) -> None:
    """Not even where an earlier run of the same batch has written them."""
    nc = tmp_path / "nc"
    nc.mkdir()
    program = (YL569 / "2_hub_rough.expected.mpf").read_bytes()
    (nc / "part.mpf").write_bytes(program)
    for results in (nc, f"file://{nc}"):
        with pytest.raises(InputError, match=r"^results: error: would hold part\.mpf, which a job reads .*FIL240"):
            run_batch(nc, results=results, action="convert", machine="yl569", to_machine="yl569", workers=1)
    assert (nc / "part.mpf").read_bytes() == program
