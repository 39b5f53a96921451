"""``trunnion post --watch``: what is posted when files change, and when not; time and changes are those of the test."""

import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Collection
from datetime import datetime
from pathlib import Path
from typing import Any

import pytest

from tests.support.projects import OUT_OF_REACH, PROJECT, TWO, contents, operation, project
from trunnion.cli import main
from trunnion.cli.command_line.parser import parse
from trunnion.cli.process import Ended
from trunnion.cli.watch import follow
from trunnion.jobs.post_project.posting import ProjectResult, post_into
from trunnion.jobs.post_project.watching import FolderNotices

Capture = pytest.CaptureFixture[str]
Step = Callable[[], object]


class Script:
    """Time in which one thing after another happens, each while a watcher waits, and then Ctrl-C."""

    def __init__(self, *steps: Step, resting: list[Step] | None = None) -> None:
        self._steps, self._resting = list(steps), list(resting or [])
        self.watched: set[str] = set()

    def rest(self, seconds: float) -> None:
        assert seconds > 0.0
        if self._resting:
            self._resting.pop(0)()

    def wait(self, files: Collection[str], seconds: float) -> None:
        assert seconds > 0.0
        self.watched = {Path(file).name for file in files}
        if not self._steps:
            raise KeyboardInterrupt
        self._steps.pop(0)()


def watched(capsys: Capture, script: Script, *arguments: object) -> tuple[list[str], str]:
    """The lines of the rounds, and stderr."""
    given = parse(["post", *map(str, arguments), "--watch"])
    assert follow(given, script, lambda: datetime(2026, 1, 2, 3, 4, 5)) == 0
    out, err = capsys.readouterr()
    return [line.removeprefix("03:04:05 ") for line in out.splitlines()], err


def write(file: Path, text: str) -> Step:
    """Write a file as another one, whatever the clock of the file system can tell apart."""

    def step() -> None:
        part = file.with_suffix(".part")
        part.write_text(text)
        part.replace(file)

    return step


def test_a_project_is_posted_again_when_one_of_its_files_changes(tmp_path: Path, capsys: Capture) -> None:
    path = project(tmp_path)
    cl, program = tmp_path / "top.cls", tmp_path / "top.mpf"
    seen: list[str] = []

    def looks() -> None:
        seen.append(program.read_text())

    script = Script(
        looks,
        write(cl, TWO.replace("500.0", "400.0")), looks,
        lambda: (tmp_path / "other.txt").write_text("nothing to it"), looks,
        write(path, PROJECT.replace("TOP", "TITLE")), looks,
    )  # fmt: skip
    rounds, err = watched(capsys, script, path)
    assert rounds == [f"{path}: posted: {program}"] * 3
    assert script.watched == {path.name, "top.cls", "yl569.toml", "sinumerik_840d.toml"}
    assert ["F400." in text for text in seen] == [False, True, True, True]
    assert [";TITLE" in text for text in seen] == [False, False, False, True]
    assert {"part.toml", "top.cls"} <= script.watched
    assert "order" not in err, "what is well is not told each time"


def test_a_file_that_is_still_being_written_is_left_alone(tmp_path: Path, capsys: Capture) -> None:
    path = project(tmp_path, top="")
    cl = tmp_path / "top.cls"
    resting = [write(cl, TWO[:length]) for length in (100, 300, 500)] + [write(cl, TWO)]
    rounds, err = watched(capsys, Script(resting=resting), path)
    assert rounds == [f"{path}: posted: {tmp_path / 'top.mpf'}"]
    assert "error" not in err


def test_what_is_cut_off_leaves_the_last_program_and_says_so(tmp_path: Path, capsys: Capture) -> None:
    path = project(tmp_path)
    cl, program = tmp_path / "top.cls", tmp_path / "top.mpf"
    kept: list[bytes] = []
    script = Script(
        lambda: kept.append(program.read_bytes()),
        write(cl, TWO[:-20]), lambda: kept.append(program.read_bytes()),
        cl.unlink, lambda: kept.append(program.read_bytes()),
        write(cl, TWO),
    )  # fmt: skip
    rounds, err = watched(capsys, script, path)
    assert [line.removeprefix(f"{path}: ")[:10] for line in rounds] == ["posted: " + str(program)[:2]] + [
        "NOT posted"
    ] * 2 + ["posted: " + str(program)[:2]]
    assert kept[0] == kept[1] == kept[2]
    assert err.count(f"{program}: warning: from before this change: do not run it until it is posted again") == 2
    assert "the file is cut off" in err


def test_what_changes_while_it_is_posted_is_posted_again(
    tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = project(tmp_path)
    program = tmp_path / "top.mpf"
    write_again = write(tmp_path / "top.cls", TWO.replace("500.0", "400.0"))

    posts = list[int]()

    def slow(*arguments: Any, **named: Any) -> ProjectResult:
        found = post_into(*arguments, **named)
        if not posts:
            write_again()
        posts.append(len(posts))
        return found

    monkeypatch.setattr("trunnion.cli.watch.post_into", slow)
    rounds, _ = watched(capsys, Script(), path)
    assert ["changed while it was posted" in line for line in rounds] == [True, False]
    assert "F400." in program.read_text()


def test_a_project_that_is_broken_is_posted_when_what_it_names_comes(tmp_path: Path, capsys: Capture) -> None:
    path = project(tmp_path, PROJECT.replace("top.cls", "late.cls"))
    rounds, err = watched(capsys, Script(write(tmp_path / "late.cls", TWO)), path)
    assert ["NOT posted" in line for line in rounds] == [True, False]
    assert "there is no such file" in err
    path.unlink()
    rounds, err = watched(capsys, Script(write(path, "= broken"), write(path, PROJECT)), path)
    assert ["NOT posted" in line for line in rounds] == [True, True, False]


def test_cl_files_are_posted_again_and_so_are_definitions(tmp_path: Path, capsys: Capture) -> None:
    project(tmp_path)
    base, machine = tmp_path / "base.toml", tmp_path / "own.toml"
    base.write_text('extends = "yl569"\n')
    machine.write_text('extends = "./base.toml"\n')
    program = tmp_path / "x.mpf"
    script = Script(
        write(base, 'extends = "yl569"\n[control.settings]\nwork_offset = "G57"\n'),
        lambda: kept.append(program.read_text()),
        write(machine, "extends = "), write(machine, 'extends = "yl569"\n'),
    )  # fmt: skip
    kept: list[str] = []
    rounds, err = watched(capsys, script, tmp_path / "top.cls", "--machine", machine, "--output", program)
    assert ["NOT posted" in line for line in rounds] == [False, False, True, False]
    assert "G57" in kept[0]
    assert "G54" in program.read_text()
    assert "own.toml:1: error: is not TOML" in err


def test_programs_of_a_folder_appear_together(tmp_path: Path, capsys: Capture) -> None:
    project(tmp_path)
    (tmp_path / "out").mkdir()
    arguments = [tmp_path / "top.cls", tmp_path / "bottom.cls", "--machine", "yl569", "--output", tmp_path / "out"]
    bad = write(tmp_path / "bottom.cls", operation("B")[:-20])
    old: list[dict[str, bytes]] = []
    script = Script(
        lambda: old.append(contents(tmp_path / "out")),
        lambda: (write(tmp_path / "top.cls", operation("OTHER"))(), bad()),
    )
    rounds, _ = watched(capsys, script, *arguments)
    assert ["NOT posted" in line for line in rounds] == [False, True]
    assert sorted(old[0]) == ["bottom.mpf", "top.mpf"]
    assert contents(tmp_path / "out") == old[0]


def test_a_program_that_is_forced_is_said_to_be(tmp_path: Path, capsys: Capture) -> None:
    project(tmp_path, top=OUT_OF_REACH)
    arguments = [tmp_path / "top.cls", "--machine", "yl569", "--output", tmp_path / "x.mpf", "--force"]
    (line,), _ = watched(capsys, Script(), *arguments)
    assert f"written by force, and must not run: {tmp_path / 'x.mpf'}" in line


@pytest.mark.parametrize("stream", [["-", "--output", "x.mpf"], ["a.cls", "--output", "-"]])
def test_streams_cannot_be_watched(stream: list[str], capsys: Capture) -> None:
    with pytest.raises(SystemExit):
        main(["post", "--machine", "yl569", "--watch", *stream])
    assert "--watch reads files again and again" in capsys.readouterr().err


def test_the_system_tells_of_changes_in_the_folders(tmp_path: Path) -> None:
    """Without the notice this waits for as long as a test may, and fails."""
    notices = FolderNotices()
    file = tmp_path / "top.cls"
    writing = threading.Event()

    def write_until_seen() -> None:
        number = 0
        while not writing.wait(0.05):
            number += 1
            file.write_text(str(number))

    writer = threading.Thread(target=write_until_seen)
    writer.start()
    try:
        ended = threading.Event()

        def wait() -> None:
            notices.wait({str(file)}, 300.0)
            ended.set()

        threading.Thread(target=wait, daemon=True).start()
        assert ended.wait(240.0)
    finally:
        writing.set()
        writer.join()
        notices.close()


@pytest.mark.skipif(sys.platform == "win32", reason="sends a signal")
def test_ctrl_c_ends_the_command_as_nothing_else_does(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "trunnion", "post", str(project(tmp_path)), "--watch"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        assert "watched; Ctrl-C ends it" in process.stderr.readline()
        process.send_signal(signal.SIGINT)
        assert process.wait() == 0
        assert "Traceback" not in process.stderr.read()


def test_a_signal_that_ends_the_process_is_not_taken_for_ctrl_c(tmp_path: Path) -> None:
    def end() -> None:
        raise Ended(signal.SIGTERM)

    with pytest.raises(Ended):
        follow(parse(["post", str(project(tmp_path)), "--watch"]), Script(end))
