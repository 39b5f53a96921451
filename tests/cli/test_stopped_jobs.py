"""A command first settles what a stopped job has left, and one that is stopped says what it has replaced."""

import signal
from pathlib import Path

import pytest

from tests.support.locations import YL569
from tests.support.stopped_jobs import OLD, left, needs_fork, old_job, stopped_between_moves
from trunnion.cli import main
from trunnion.files.moves import Moves


@needs_fork
def test_any_command_in_the_folder_settles_a_stopped_job_and_says_which(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = old_job(tmp_path)
    stopped_between_moves(folder)
    main(["verify", str(folder / "nc" / "one.mpf"), "--machine", "yl569"])
    told = capsys.readouterr().err
    assert "warning: a job that was stopped has been rolled back: " in told
    assert "one.mpf" in told
    assert left(folder) == OLD


def test_a_post_that_is_stopped_says_what_it_has_replaced(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    cl = YL569 / "2_hub_rough.cls"
    carry_out = Moves._move_all

    def stopped(self: Moves) -> None:
        signal.raise_signal(signal.SIGINT)
        carry_out(self)

    monkeypatch.setattr(Moves, "_move_all", stopped)
    code = main(["post", str(cl), "--machine", "yl569", "--output", str(tmp_path / "part.mpf")])
    assert code == 2
    assert capsys.readouterr().err.splitlines()[-1] == (
        "stopped: complete before that, all files of the new job: part.mpf"
    )
    assert (tmp_path / "part.mpf").exists()


@needs_fork
@pytest.mark.parametrize(
    "words",
    [
        "check part.toml",
        "survey . --machine yl569",
        "test part.toml",
        "test .",
        "batch . --action verify --machine yl569",
    ],
)
def test_a_project_and_a_folder_settle_what_stands_in_the_folders_within(
    words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = old_job(tmp_path)
    stopped_between_moves(folder)
    monkeypatch.chdir(folder)
    Path("part.toml").write_text('machine = "yl569"\n[[setup]]\ncl = ["a.cls"]\noutput = "nc/one.mpf"\n')
    Path("a.cls").write_bytes((YL569 / "2_hub_rough.cls").read_bytes())
    main(words.split())
    assert "warning: a job that was stopped has been rolled back: " in capsys.readouterr().err
    assert {name: text for name, text in left(folder).items() if name in OLD} == OLD
