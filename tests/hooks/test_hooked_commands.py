"""Hooks of commands that read CL files besides post and verify: they see what a post would cut."""

from pathlib import Path

import pytest

import trunnion
from tests.support.locations import DOCS, YL569
from trunnion.jobs.registry import JOBS, WITHOUT_HOOKS
from trunnion.jobs.view.viewing import prepare_view
from trunnion.options.kinds import FileIn

CL = YL569 / "2_hub_rough.cls"


@pytest.fixture
def lifted(tmp_path: Path) -> Path:
    """Hooks that lift all points by 5 mm."""
    file = tmp_path / "shop.py"
    file.write_text(
        "from dataclasses import replace\n"
        "def on_operation(operation, context):\n"
        "    moves = operation.moves\n"
        "    return replace(operation, moves=replace(moves, tip=moves.tip + (0.0, 0.0, 5.0)))\n",
        encoding="utf-8",
    )
    return file


def test_commands_that_read_cl_files_take_hooks() -> None:
    reads = {
        job.name
        for job in JOBS.values()
        if any(isinstance(each.kind, FileIn) and "CL" in each.value_name.split("|") for each in job.options)
    }
    assert {name for name in reads if JOBS[name].option("hooks") is None} == {*WITHOUT_HOOKS} - {
        "batch",
        "impeller",
        "survey",
    }
    page = (DOCS / "hooks.md").read_text(encoding="utf-8")
    for name, why in WITHOUT_HOOKS.items():
        assert JOBS[name].option("hooks") is None
        assert f"`{name}` ({why})" in page


def test_a_place_is_that_of_the_lifted_path_and_its_program_is_lifted_once(lifted: Path) -> None:
    plain = trunnion.place(CL, machine="yl569", turns=[0.0])
    found = trunnion.place(CL, machine="yl569", turns=[0.0], hooks=[lifted])
    assert plain.best is not None
    assert found.best is not None
    assert found.best.axes[2].least_mm - found.best.zero_mm[2] == pytest.approx(
        plain.best.axes[2].least_mm - plain.best.zero_mm[2] + 5.0
    )
    posted = trunnion.post_placed(found, machine="yl569", hooks=[lifted])
    whole = trunnion.post(CL, machine="yl569", settings={"zero": found.best.zero_mm}, hooks=[lifted])
    assert posted.run is not None
    assert whole.run is not None
    assert posted.run.tip[-1].tolist() == whole.run.tip[-1].tolist()


def test_what_is_reached_is_that_of_the_lifted_path(lifted: Path) -> None:
    reached = trunnion.reach("yl569", cl=CL, zero=(0, 0, -400), tool_length=100, step=45.0, hooks=[lifted])
    assert len(reached.paths) == 1


def test_a_view_shows_the_lifted_program(lifted: Path) -> None:
    plain, found = (prepare_view(CL, machine="yl569", hooks=hooks) for hooks in ([], [lifted]))
    assert plain.texts != found.texts


def test_hooks_without_cl_files_are_refused(lifted: Path) -> None:
    program = YL569 / "2_hub_rough.expected.mpf"
    for call in (
        lambda: trunnion.place(program, machine="yl569", turns=[0.0], hooks=[lifted]),
        lambda: trunnion.reach("yl569", step=45.0, hooks=[lifted]),
        lambda: trunnion.verify(program, machine="yl569", hooks=[lifted]),
    ):
        with pytest.raises(trunnion.InputError, match="change CL files, and there are none"):
            call()
