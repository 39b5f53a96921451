"""Where output goes: what cannot be written is found out before any work, and nothing that is read is written over."""

import os
import sys
from pathlib import Path

import pytest

from trunnion.errors import InputError
from trunnion.files import check_outputs, resolve_output

NO_FILES: dict[str, tuple[object, str]] = {
    "bytes": (b"p.mpf", "is no name of a file"),
    "a number": (7, "is no name of a file"),
    "nothing": ("", "cannot be the name of a file"),
    "NUL": ("p\0.mpf", "cannot be the name of a file"),
    "a folder that is not there": ("missing/", "it names a folder"),
    "a folder": (".", "it is a folder"),
    "in a folder that is not there": ("missing/p.mpf", "there is no folder"),
    "in a file": ("file/p.mpf", "cannot be written"),
    "too long": ("x" * 300, "cannot be written"),
    "a circle of links": ("circle", "cannot be written"),
}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a file, a link to it, a hard link, and links in a circle."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").write_bytes(b"old")
    (tmp_path / "link").symlink_to("file")
    (tmp_path / "circle").symlink_to("circle")
    os.link(tmp_path / "file", tmp_path / "hard")
    (tmp_path / "sub").mkdir()
    return tmp_path


@pytest.mark.parametrize("case", NO_FILES)
def test_what_cannot_be_written_is_an_input_error_with_its_cure(case: str, folder: Path) -> None:
    named, what = NO_FILES[case]
    with pytest.raises(InputError, match=what) as refused:
        resolve_output(named)
    assert refused.value.problems[0].cure


@pytest.mark.skipif(sys.platform == "win32", reason="bytes name files, and names are Unicode, only here")
def test_a_path_of_bytes_and_a_name_that_the_system_cannot_hold_are_no_names(folder: Path) -> None:
    class Bytes:
        def __fspath__(self) -> bytes:
            return b"p.mpf"

    for named in (Bytes(), "p\ud800.mpf"):
        with pytest.raises(InputError, match=r"is no name of a file|cannot be the name of a file"):
            resolve_output(named)


def test_links_lead_to_the_file_itself(folder: Path) -> None:
    assert resolve_output("link").path == (folder / "file").resolve()
    (folder / "coming").symlink_to(folder / "sub" / "new")
    place = resolve_output(Path("coming"))
    assert (place.name, place.path, place.is_stream) == ("coming", (folder / "sub" / "new").resolve(), False)


@pytest.mark.parametrize("name", ["file", "./file", "sub/../file", "link", "hard"])
def test_a_file_that_is_read_is_not_written(name: str, folder: Path) -> None:
    spellings: list[str | Path] = ["file", Path("sub") / ".." / "file", "hard", str(folder / "link")]
    for each in spellings:
        with pytest.raises(InputError, match="would be written over, although"):
            check_outputs([name], [each])
    assert check_outputs([name], ["sub", "nothing", "p\0"])[0].name == name


def test_two_outputs_are_two_files(folder: Path) -> None:
    for one, other in (("new", "./new"), ("new", "NEW"), ("link", "file"), ("file", "sub/../file")):
        with pytest.raises(InputError, match=f"{one} is the same file"):
            check_outputs([one, other], [])
    assert len(check_outputs(["file", "new", "sub/new"], [])) == 3


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs pipes with names")
def test_a_pipe_is_a_stream(folder: Path) -> None:
    os.mkfifo("pipe")
    (folder / "to pipe").symlink_to("pipe")
    assert resolve_output("pipe").is_stream
    assert resolve_output("to pipe").is_stream
