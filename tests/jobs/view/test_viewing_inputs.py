"""What a view can show: programs, CL files that are posted for it, and set-ups of projects."""

from pathlib import Path

import pytest

from tests.support.locations import GOLDEN, ROOT
from trunnion import InputError, post, read_cl
from trunnion.cl import is_cl_file
from trunnion.jobs.view.viewing import prepare_view
from trunnion.model.toolpath import Phase

CL = GOLDEN / "yl569" / "3_blade_finish.cls"
NC = GOLDEN / "yl569" / "3_blade_finish.expected.mpf"
PLATE = ROOT / "examples" / "simulation" / "plate.toml"

PROGRAMS = [path for path in sorted(GOLDEN.rglob("*")) if path.suffix in (".mpf", ".h", ".nc", ".ngc", ".iso", ".MPF")]
CL_FILES = [path for path in sorted(GOLDEN.rglob("*")) if path.suffix in (".cls", ".apt", ".ncl", ".cl")]


@pytest.mark.parametrize("file", [*PROGRAMS, *CL_FILES], ids=lambda file: file.name)
def test_a_file_is_known_by_its_content(file: Path) -> None:
    assert is_cl_file(file) == (file in CL_FILES)


def test_there_are_files_of_both_kinds() -> None:
    assert len(PROGRAMS) > 5
    assert len(CL_FILES) > 2


def test_a_cl_file_is_posted_for_the_machine() -> None:
    content = prepare_view(CL, machine="dmu65", settings={"program": "BLADE"})
    posted = post(CL, machine="dmu65", settings={"program": "BLADE"})
    assert content.texts == ((posted.text or "").encode(), CL.read_bytes())
    assert len(content.columns["cl"]) == len(posted.run or ())
    assert content.columns["cl"].max() > 20


def test_a_program_that_must_not_run_is_shown_with_what_is_wrong() -> None:
    content = prepare_view(CL, machine="yl569", settings={"zero": "0,0,900", "tool_length": "60"})
    assert any(check["state"] == "FAIL" for check in content.said()["checks"])
    assert b"MUST NOT RUN" in content.texts[0]


def test_a_set_up_of_a_project_states_all() -> None:
    with pytest.raises(InputError, match="choose one with argument setup=NAME: top, bottom"):
        prepare_view(PLATE)
    content = prepare_view(PLATE, setup="top", cell=4.0)
    assert content.scene["machine"]["key"] == "machine"
    assert content.stock is not None
    assert Path(content.scene["files"][0]).name == "plate_top.mpf"
    second = prepare_view(PLATE, setup="2")
    assert Path(second.scene["files"][0]).name == "plate_bottom.mpf"
    assert second.stock is None


def test_what_a_view_cannot_show_is_told() -> None:
    with pytest.raises(InputError, match="no CL file, as others here are"):
        prepare_view([CL, NC], machine="yl569")
    with pytest.raises(InputError, match=r"not called by 3_blade_finish\.expected\.mpf"):
        prepare_view([NC, NC.with_name("2_hub_rough.expected.mpf")], machine="yl569")
    with pytest.raises(InputError, match="settings of posting"):
        prepare_view(NC, machine="yl569", settings={"title": "x"})
    with pytest.raises(InputError, match="machine: error: is missing"):
        prepare_view(NC)
    with pytest.raises(InputError, match="belongs to a project"):
        prepare_view(NC, machine="yl569", setup="top")
    with pytest.raises(InputError, match='has no set-up "3"'):
        prepare_view(PLATE, setup="3")


def test_phases_are_those_of_the_cl_file() -> None:
    content = prepare_view(CL, machine="yl569")
    phase, line = content.columns["phase"], content.columns["cl"]
    moves = read_cl(CL).operations[0].moves
    for row in range(0, len(phase), 5):
        at = [k for k in range(len(moves)) if moves.line[k] == line[row]]
        assert phase[row] == (moves.phase[at[0]] if at else -1)
    assert set(phase.tolist()) > {-1, int(Phase.CUT)}
    assert "phase" not in prepare_view(NC, machine="yl569").columns
