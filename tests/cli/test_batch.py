"""``trunnion batch``: the results of the single commands, and a table of what failed."""

import shutil
import sqlite3
from collections.abc import Sequence
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest

from tests.support.batch_work import simple_work
from tests.support.batches import AsTheyCome, run_simply, simple_batch, write_files
from tests.support.locations import ROOT, YL569
from trunnion.batch.stores import FolderStore
from trunnion.batch.worker_task import Outcome, Task
from trunnion.cli import main
from trunnion.cli.many_files.batch import result_lines
from trunnion.cli.progress import progress_lines

CL = (YL569 / "2_hub_rough.cls").read_bytes()


def test_the_example_runs_as_the_page_prints_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = (ROOT / "docs" / "batch.md").read_text("utf-8")
    jobs = (ROOT / "examples" / "batch" / "jobs.toml").read_text("utf-8")
    assert f"```toml\n{jobs}```" in text
    shutil.copytree(ROOT / "examples" / "batch", tmp_path / "batch", ignore=shutil.ignore_patterns("programs"))
    printed = []
    for _ in range(2):
        assert main(["batch", str(tmp_path / "batch" / "jobs.toml"), "--workers", "1"]) == 0
        out = capsys.readouterr().out
        printed.append(out.replace(str(tmp_path / "batch" / "programs"), "examples/batch/programs"))
    command = "$ trunnion batch examples/batch/jobs.toml\n"
    assert f"```\n{command}{printed[0]}{command}{printed[1]}```" in text


def test_a_folder_is_posted_as_the_single_command_does(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name in ("a/x.cls", "b/x.cls"):
        (tmp_path / "in" / name).parent.mkdir(parents=True)
        (tmp_path / "in" / name).write_bytes(CL if name < "b" else CL.replace(b"RPM,2000", b"RPM,2100"))
    (tmp_path / "in/bad.cls").write_bytes(b"GOTO/1,2\n")
    out = tmp_path / "in/out"
    command = ["batch", str(tmp_path / "in"), "--action", "post", "--machine", "yl569", "--set", "title=X"]
    command += ["--results", str(out), "--workers", "2", "--summary", str(tmp_path / "s.sqlite")]
    assert main(command) == 1
    printed = capsys.readouterr()
    head, row, written, last = printed.out.splitlines()
    assert written == "written now: a/x.mpf, b/x.mpf"
    assert head.split() == ["file", "code", "line", "message"]
    assert row.split()[:3] == ["bad.cls", "CL310", "1"]
    assert "GOTO has 2 numbers" in row
    assert last == f"3 files: 2 passed, 1 unusable; results in {out}"
    assert printed.err == ""
    for name in ("a", "b"):
        single = tmp_path / f"{name}.mpf"
        assert (
            main(
                [
                    "post",
                    str(tmp_path / f"in/{name}/x.cls"),
                    "--machine",
                    "yl569",
                    "--set",
                    "title=X",
                    "--output",
                    str(single),
                ]
            )
            == 0
        )
        assert (out / name / "x.mpf").read_bytes() == single.read_bytes()
    capsys.readouterr()
    (tmp_path / "in/bad.cls").unlink()
    assert main(command) == 0
    assert capsys.readouterr().out == f"2 files: 2 passed; 2 of them done before; results in {out}\n"


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ([], "--action: error: is missing"),
        (["--action", "post"], "--machine: error: is missing"),
        (["--action", "convert", "--machine", "yl569"], "--to-machine: error"),
        (["--action", "post", "--machine", "yl569"], "--results: error: is missing"),
        (["--action", "post", "--machine", "dmu66", "--results", "x"], "dmu65"),
        (
            ["--action", "post", "--machine", "yl569", "--results", "x", "--scheduler", "tcp://h:1", "--workers", "2"],
            "--workers",
        ),
        (["--action", "post", "--machine", "yl569", "--results", "x", "--tls-ca", "x"], "--tls-ca"),
        (["--action", "post", "--machine", "yl569", "--results", "x", "--wait", "9"], "--wait"),
        (["--action", "post", "--machine", "yl569", "--results", "x", "--set", "nosuch=1"], "nosuch"),
        (["--action", "post", "--machine", "yl569", "--results", "x", "--summary", "s.csv"], ".sqlite or .parquet"),
        (["--action", "verify", "--machine", "yl569", "--results", "x"], "has no files .mpf"),
    ],
)
def test_what_cannot_be_done_ends_with_2_before_any_work(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, arguments: list[str], told: str
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "in").mkdir()
    (tmp_path / "in/x.cls").write_bytes(CL)
    assert main(["batch", "in", *arguments]) == 2
    assert told in capsys.readouterr().err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["in"]


def test_a_folder_that_is_not_there_is_told_as_such(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["batch", "NOPE", "--action", "post", "--machine", "yl569", "--results", "x"]) == 2
    told = capsys.readouterr().err
    assert told.startswith("NOPE: error: there is no such folder")
    assert "file of jobs" not in told


def test_the_query_of_the_page_shows_margins_and_files_of_which_nothing_is_known(tmp_path: Path) -> None:
    text = (ROOT / "docs" / "batch.md").read_text("utf-8")
    query = text.split('sqlite3 programs.sqlite "')[1].split('"')[0]
    shutil.copytree(ROOT / "examples" / "batch", tmp_path / "batch", ignore=shutil.ignore_patterns("programs"))
    summary = tmp_path / "programs.sqlite"
    jobs = str(tmp_path / "batch" / "jobs.toml")
    assert main(["batch", jobs, "--workers", "1", "--summary", str(summary)]) == 0
    with closing(sqlite3.connect(summary)) as table:
        assert table.execute(query).fetchall() == [("released/hub.mpf", None)]
        margins = table.execute(query.replace("< 5", "< 500")).fetchall()
    assert [file for file, _ in margins] == ["released/hub.mpf", "blades/finish.cls", "blades/hub.cls"]
    assert all(margin > 100.0 for _, margin in margins[1:])


def test_a_file_of_jobs_states_everything_itself(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "jobs.toml").write_text('[[job]]\nmachine = "yl569"\nfiles = ["*.cls"]\n', encoding="utf-8")
    (tmp_path / "x.cls").write_bytes(CL)
    assert main(["batch", str(tmp_path / "jobs.toml"), "--machine", "yl569"]) == 2
    assert "states it itself" in capsys.readouterr().err


@pytest.mark.parametrize("outputs", [["one"], ["one", "another"]])
def test_the_table_names_the_jobs_where_there_are_several(tmp_path: Path, outputs: Sequence[str]) -> None:
    write_files(tmp_path / "in", {"x.cls": "fail"})
    batch = simple_batch(tmp_path / "in")
    jobs = [replace(batch.jobs[0], name=f"job {output}", output=output) for output in outputs]
    head, *rows, last = result_lines(run_simply(replace(batch, jobs=jobs), FolderStore(tmp_path / "out")))
    assert [row.split()[: len(outputs) + 1] for row in rows] == (
        [["x.cls", "CL310"]] if len(outputs) == 1 else [["job", "another", "x.cls"], ["job", "one", "x.cls"]]
    )
    assert head.split()[0] == ("file" if len(outputs) == 1 else "job")
    assert {row.index("x.cls") for row in rows} == {head.index("file")}
    assert (
        last == f"{len(outputs)} file{'s'[: len(outputs) - 1]}: {len(outputs)} unusable; results in {tmp_path / 'out'}"
    )


def test_how_far_work_is_comes_line_by_line_in_a_pipe(capsys: pytest.CaptureFixture[str]) -> None:
    told = ""
    with progress_lines("batch", 3, "files", every=0.001) as advance:
        advance(2)
        while "batch: 2 of 3 files after" not in told:
            told += capsys.readouterr().err
    capsys.readouterr()
    with progress_lines("batch", 3, "files", every=600.0) as advance:
        advance(3)
    assert capsys.readouterr().err == ""


def test_reports_of_what_failed_are_told_as_written(tmp_path: Path) -> None:
    def reporting(task: Task) -> Outcome:
        return replace(simple_work(task), files={f"{task.result}.html": b"why"})

    write_files(tmp_path / "in", {"x.cls": "refuse"})
    team = AsTheyCome(function=reporting)
    lines = [*result_lines(run_simply(simple_batch(tmp_path / "in"), FolderStore(tmp_path / "out"), team))]
    assert "written now: x.mpf.html" in lines
