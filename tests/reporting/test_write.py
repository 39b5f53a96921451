"""Reports as files: formats, failures, size and memory."""

import hashlib
import re
import tracemalloc
from collections.abc import Iterator
from importlib.resources import files
from pathlib import Path

import pytest

from tests.support.reports import blade, waves
from trunnion.errors import InputError
from trunnion.reporting import write
from trunnion.reporting.write import write_report


@pytest.mark.parametrize("name", ["report.pdf", "report", "report.html.txt"])
def test_other_forms_are_refused_with_the_cure(name: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"let the name end in \.html or \.json"):
        write_report(blade(), tmp_path / name)
    assert not list(tmp_path.iterdir())


def test_the_suffix_may_be_in_capitals(tmp_path: Path) -> None:
    write_report(blade(), tmp_path / "REPORT.HTML")
    assert (tmp_path / "REPORT.HTML").read_text(encoding="utf-8").startswith("<!DOCTYPE html>")


def test_a_report_that_breaks_off_leaves_the_old_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object) -> Iterator[bytes]:
        yield b"half"
        raise RuntimeError("the power went")

    (tmp_path / "report.html").write_text("old", encoding="utf-8")
    monkeypatch.setitem(write.RENDERERS, ".html", broken)
    with pytest.raises(RuntimeError):
        write_report(blade(), tmp_path / "report.html")
    assert [path.name for path in tmp_path.iterdir()] == ["report.html"]
    assert (tmp_path / "report.html").read_text(encoding="utf-8") == "old"


def test_a_folder_that_is_not_there_is_an_error_of_the_input(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be written"):
        write_report(blade(), tmp_path / "nowhere" / "report.json")


@pytest.mark.nightly
def test_a_million_motions_take_bounded_memory_and_a_file_that_can_be_sent(tmp_path: Path) -> None:
    verification = waves(1_000_000)
    tracemalloc.start()
    try:
        write_report(verification, tmp_path / "report.html")
        _, most = tracemalloc.get_traced_memory()
        write_report(verification, tmp_path / "report.json")
    finally:
        tracemalloc.stop()
    assert most < 200e6
    assert (tmp_path / "report.html").stat().st_size < 40e6
    assert (tmp_path / "report.json").stat().st_size < 100_000


def test_the_plot_library_is_the_one_that_its_note_names() -> None:
    vendor = files("trunnion.reporting").joinpath("vendor")
    sums = re.findall(r"`([\w.]+)` \| `([0-9a-f]{64})`", vendor.joinpath("README.md").read_text(encoding="utf-8"))
    assert len(sums) == 2
    for name, wanted in sums:
        content = vendor.joinpath(name).read_bytes()
        assert hashlib.sha256(content).hexdigest() == wanted
        assert b"</script" not in content.lower()
        assert b"</style" not in content.lower()
