"""A program that was edited by hand is not replaced unseen: by no output, project or subprogram."""

import os
from datetime import datetime
from pathlib import Path
from typing import Any
from unittest.mock import patch

import pytest

import trunnion
from tests.support.locations import YL569
from trunnion.files import atomic_output, edited

HUB = YL569 / "2_hub_rough.cls"
EDIT = "; feed lowered at the machine\n"


def post(folder: Path, **settings: Any) -> Any:
    return trunnion.post(HUB, machine="yl569", output=folder / "hub.mpf", settings=settings)


def edit(file: Path) -> bytes:
    """Edit a file on a day that is known."""
    file.write_text(file.read_text(encoding="utf-8") + EDIT, encoding="utf-8")
    os.utime(file, (1_700_000_000, 1_700_000_000))
    return file.read_bytes()


def test_an_edited_output_is_refused_kept_or_replaced_as_is_said(tmp_path: Path) -> None:
    file = tmp_path / "hub.mpf"
    post(tmp_path)
    written = file.read_bytes()
    post(tmp_path)
    edited = edit(file)
    for settings in ({}, {"edited": "refuse"}):
        with pytest.raises(trunnion.InputError, match="was edited since it was written") as refused:
            post(tmp_path, **settings)
        assert "edited=keep" in refused.value.problems[0].cure
        assert file.read_bytes() == edited
    result = post(tmp_path, edited="keep")
    kept = tmp_path / "hub.mpf.edited-2023-11-14"
    assert (file.read_bytes(), kept.read_bytes()) == (written, edited)
    assert f"it is kept as {kept.name}" in "\n".join(map(str, result.problems))
    edit(file)
    post(tmp_path, edited="keep")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["hub.mpf", kept.name, f"{kept.name}-2"]
    edit(file)
    post(tmp_path, edited="replace")
    assert file.read_bytes() == written
    assert len(list(tmp_path.iterdir())) == 3


def test_an_edited_subprogram_stays_with_its_program(tmp_path: Path) -> None:
    post(tmp_path, programs="operations")
    (subprogram,) = (path for path in tmp_path.iterdir() if path.suffix.lower() == ".spf")
    edited = edit(subprogram)
    there = (tmp_path / "hub.mpf").read_bytes()
    with pytest.raises(trunnion.InputError, match=rf"{subprogram.name}: error: was edited since"):
        post(tmp_path, programs="operations", title="NEW")
    assert (subprogram.read_bytes(), (tmp_path / "hub.mpf").read_bytes()) == (edited, there)
    post(tmp_path, programs="operations", edited="keep")
    assert subprogram.read_bytes() != edited
    assert subprogram.with_name(f"{subprogram.name}.edited-2023-11-14").read_bytes() == edited


def test_an_edited_program_of_a_project_is_refused_and_kept_where_it_says_so(tmp_path: Path) -> None:
    project = tmp_path / "part.toml"
    (tmp_path / "hub.cls").write_bytes(HUB.read_bytes())
    text = 'machine = "yl569"\ncl = ["hub.cls"]\noutput = "hub.mpf"\n'
    project.write_text(text, encoding="utf-8")
    trunnion.post_project(project)
    edited = edit(tmp_path / "hub.mpf")
    with pytest.raises(trunnion.InputError, match="was edited since it was written"):
        trunnion.post_project(project)
    assert (tmp_path / "hub.mpf").read_bytes() == edited
    project.write_text(f'{text}[settings]\nedited = "keep"\n', encoding="utf-8")
    trunnion.post_project(project)
    assert (tmp_path / "hub.mpf.edited-2023-11-14").read_bytes() == edited


def test_a_program_that_was_written_by_hand_is_refused_kept_or_replaced_as_is_said(tmp_path: Path) -> None:
    file = tmp_path / "hub.mpf"
    file.write_text("N10 M30\n", encoding="utf-8")
    by_hand = edit(file)
    for settings in ({}, {"edited": "refuse"}):
        with pytest.raises(trunnion.InputError, match="although no post or conversion has written it") as refused:
            post(tmp_path, **settings)
        assert "edited=keep" in refused.value.problems[0].cure
    assert [path.read_bytes() for path in tmp_path.iterdir()] == [by_hand]
    result = post(tmp_path, edited="keep")
    assert (tmp_path / "hub.mpf.edited-2023-11-14").read_bytes() == by_hand
    assert "it is kept as hub.mpf.edited-2023-11-14" in "\n".join(map(str, result.problems))
    assert post(tmp_path).passed
    (tmp_path / "other.mpf").write_text("N10 M30\n", encoding="utf-8")
    file.unlink()
    (tmp_path / "other.mpf").rename(file)
    assert post(tmp_path, edited="replace").passed


def test_what_a_program_holds_already_and_an_empty_file_are_replaced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As after a clone, and where nothing can be remembered."""
    post(tmp_path)
    (tmp_path / "cache").mkdir()
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path / "cache"))
    assert post(tmp_path).passed
    edit(tmp_path / "hub.mpf")
    with pytest.raises(trunnion.InputError, match="was edited since it was written"):
        post(tmp_path)
    (tmp_path / "hub.mpf").write_bytes(b"")
    assert post(tmp_path).passed
    edit(tmp_path / "hub.mpf")
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path / "none"))
    assert post(tmp_path).passed


def test_a_program_by_hand_is_not_replaced_by_a_project_or_a_conversion(tmp_path: Path) -> None:
    project, file = tmp_path / "part.toml", tmp_path / "hub.mpf"
    (tmp_path / "hub.cls").write_bytes(HUB.read_bytes())
    project.write_text('machine = "yl569"\ncl = ["hub.cls"]\noutput = "hub.mpf"\n', encoding="utf-8")
    file.write_text("N10 M30\n", encoding="utf-8")
    match = "although no post or conversion has written it"
    with pytest.raises(trunnion.InputError, match=match) as refused:
        trunnion.post_project(project)
    assert (refused.value.problems[0].file, refused.value.problems[0].line) == (str(project), 3)
    with pytest.raises(trunnion.InputError, match=match):
        trunnion.convert(YL569 / "2_hub_rough.expected.mpf", machine="yl569", to_cl=True, output=file)
    assert file.read_text(encoding="utf-8") == "N10 M30\n"
    trunnion.post_project(project, settings={"edited": "keep"})
    assert len([path for path in tmp_path.iterdir() if path.name.startswith("hub.mpf.edited-")]) == 1


def test_an_edited_program_of_a_conversion_is_kept(tmp_path: Path) -> None:
    source, file = YL569 / "2_hub_rough.expected.mpf", tmp_path / "hub.h"
    for settings in ({}, {"edited": "keep"}):
        edited = edit(file) if file.exists() else b""
        trunnion.convert(source, machine="yl569", to_machine="dmu65", output=file, settings=settings)
    edit(file)
    with pytest.raises(trunnion.InputError, match="was edited since it was written"):
        trunnion.convert(source, machine="yl569", to_machine="dmu65", output=file)
    assert (tmp_path / "hub.h.edited-2023-11-14").read_bytes() == edited


@pytest.mark.parametrize("name", ["hub.mpf", "SUB.SPF"])
def test_a_program_that_is_edited_while_the_next_is_made_is_not_replaced_unseen(name: str, tmp_path: Path) -> None:
    file = tmp_path / name

    def write(text: bytes, edited: str = "", *, by_hand: bool) -> None:
        with atomic_output(tmp_path / "hub.mpf", is_job=True, edited=edited) as files:
            for sink in (files.main, files.add_file("SUB.SPF")):
                sink.write(text)
            if by_hand:
                file.write_bytes(b"by hand")
                os.utime(file, (1_700_000_000, 1_700_000_000))

    write(b"1", by_hand=False)
    with pytest.raises(trunnion.InputError, match="was edited since it was written"):
        write(b"2", by_hand=True)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == {
        "hub.mpf": b"1", "SUB.SPF": b"1", name: b"by hand"
    }  # fmt: skip
    write(b"3", "keep", by_hand=True)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == {
        "hub.mpf": b"3", "SUB.SPF": b"3", f"{name}.edited-2023-11-14": b"by hand"
    }  # fmt: skip


def test_an_edit_of_a_year_that_no_calendar_has_is_kept(tmp_path: Path) -> None:
    post(tmp_path)
    edit(tmp_path / "hub.mpf")
    with patch.object(edited, "datetime") as clock:
        clock.fromtimestamp.side_effect = ValueError("year 33658 is out of range")
        clock.side_effect = datetime
        post(tmp_path, edited="keep")
    assert (tmp_path / "hub.mpf.edited-1970-01-01").exists()
