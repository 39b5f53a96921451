"""Commands that are killed at a file operation: what they write is all old or all new after the next command."""

import os
import shutil
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

import pytest

from tests.support.command_lines import fill_folder
from tests.support.stopped_jobs import needs_fork
from trunnion.cli import main
from trunnion.jobs.registry import JOBS
from trunnion.options.option import outputs

#: Commands with all files that they write.
LINES: Final = {
    "post": (
        "post part.cls --machine yl569 --output a.mpf --set programs=operations --report r.html --sheet s.html"
        " --listing l.txt --manifest m.json --json j.json",
        "MULTI_BLADE_ROUGH.spf a.mpf r.html s.html l.txt m.json j.json",
    ),
    "convert": ("convert part.mpf --machine yl569 --to-machine dmu65 --output c.h --json c.json", "c.h c.json"),
    "verify": ("verify part.mpf --machine yl569 --report v.html --json v.json", "v.html v.json"),
    "info": ("info part.cls --json i.json --plot i.html", "i.html i.json"),
    "sensitivity": ("sensitivity part.mpf --machine yl569 --report t.html --json t.json", "t.html t.json"),
    "curve": ("curve impeller/blade_points.csv --picture c.svg --json c.json", "c.svg c.json"),
    "view": ("view part.mpf --machine yl569 --output v.html", "v.html"),
    "twin": ("twin part.mpf --machine yl569 --device-xml t.xml", "t.xml"),
    "place": (
        "place part.cls --machine yl569 --turns 90 --apply a.mpf --sheet s.html --plot p.svg --json p.json",
        "a.mpf s.html p.svg p.json",
    ),
    "diff": ("diff part.mpf part.mpf --machine yl569 --json d.json", "d.json"),
    "kinematics": ("kinematics yl569 --json k.json", "k.json"),
    "machines": ("machines --json m.json", "m.json"),
    "controls": ("controls --json c.json", "c.json"),
    "check": ("check yl569 --json c.json", "c.json"),
    "explain": ("explain FIL250 --json e.json", "e.json"),
    "new": ("new ours --like yl569 --json n.json", "ours.toml trunnion-machine.schema.json n.json"),
    "freecad": ("freecad install --folder .", "trunnion_post.py trunnion_post.json"),
}  # fmt: skip

#: Commands that are left out, and why.
LEFT_OUT: Final = {
    "simulate": "its files are written as those of verify", "reach": "as sensitivity", "fit": "as diff",
    "survey": "as sensitivity", "impeller": "its program is written as that of post", "import": "as new",
    "batch": "it goes on where it was stopped: tests/batch/test_resuming.py", "test": "tests/cli/test_cases.py",
    "record": "what was recorded stays: tests/twin/recording/test_files.py", "build": "it writes one file at a time",
}  # fmt: skip

_CHANGES: Final = frozenset(("os.rename", "os.remove", "os.link", "os.mkdir", "os.rmdir"))


def _is_change(event: str, given: tuple[Any, ...]) -> bool:
    """Whether the system is asked to change a file or a name."""
    if event == "open":
        return isinstance(given[0], str | bytes) and bool(given[2] & (os.O_WRONLY | os.O_RDWR | os.O_CREAT))
    return event in _CHANGES


def _killed(words: str, number: int) -> bool:
    """Run a command in a copy of this process, which is killed before an operation; whether it came to that."""
    process = os.fork()
    if not process:
        count = [0]

        def watch(event: str, given: tuple[Any, ...]) -> None:
            if _is_change(event, given):
                count[0] += 1
                if count[0] == number:
                    os._exit(9)

        sys.addaudithook(watch)
        with suppress(BaseException):
            main(words.split())
        os._exit(0)
    return os.waitstatus_to_exitcode(os.waitpid(process, 0)[1]) == 9


def _left(names: str) -> dict[str, bytes]:
    return {name: Path(name).read_bytes() for name in names.split() if Path(name).exists()}


def _hidden() -> Iterator[Path]:
    yield from (path for path in Path().rglob(".*") if path.is_dir())


def test_every_command_that_writes_is_killed_or_left_out_for_a_reason() -> None:
    writing = {name for name, job in JOBS.items() if outputs(job.options)}
    assert writing <= LINES.keys() | LEFT_OUT.keys()
    assert not LINES.keys() & LEFT_OUT.keys()


@needs_fork
@pytest.mark.parametrize(
    ("name", "step"),
    [("post", 19), ("freecad", 3), ("info", 1), *(pytest.param(name, 1, marks=pytest.mark.nightly) for name in LINES)],
)
def test_a_command_that_is_killed_leaves_old_files_or_new_ones(
    name: str, step: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    words, names = LINES[name]
    monkeypatch.chdir(tmp_path)
    fill_folder(tmp_path)
    main(words.split())
    complete = _left(names)
    assert len(complete) == len(names.split())
    older = tmp_path / "older"
    number, outcomes = 1, set[bool]()
    while True:
        shutil.rmtree(older, ignore_errors=True)
        older.mkdir()
        monkeypatch.chdir(older)
        fill_folder(older)
        came = _killed(words, number)
        monkeypatch.chdir(older)
        main(["info", "part.cls"])
        capsys.readouterr()
        found = _left(names)
        assert found.keys() in (set(), complete.keys()), (number, sorted(found))
        assert all(found.values()), (number, "half a file")
        assert not list(_hidden()), number
        outcomes.add(bool(found))
        if not came:
            break
        number += step
    assert len(outcomes) == 2
