"""Programs of ours turned into CL files, and posted again: the same bytes."""

import io
from pathlib import Path

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.convert.toolpaths import SAYABLE, toolpaths
from trunnion.cl import read_cl
from trunnion.cl.write import write_cl
from trunnion.control import Program, check_program, load_control, write_program
from trunnion.convert import convert
from trunnion.errors import Severity
from trunnion.machine import load_machine
from trunnion.plan import plan
from trunnion.reader import run_program
from trunnion.toolpath import Toolpath

MACHINE = load_machine("yl569")
CONTROL = load_control(MACHINE.control)

#: Tool axes that the YL569 reaches, upright ones among them.
AXES = st.one_of(
    st.just((0.0, 0.0, 1.0)),
    st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.floats(0.01, 1)),
)


def posted(toolpath: Toolpath, given: dict[str, str]) -> bytes | None:
    """The program; None where there can be none."""
    planned = plan([toolpath], MACHINE, CONTROL.chord_tolerance)
    program = Program(MACHINE, CONTROL, planned.motions, given, toolpath.file)
    if any(problem.severity is Severity.ERROR for problem in check_program(program)):
        return None
    sink = io.BytesIO()
    write_program(program, sink)
    return sink.getvalue()


def there_and_back(program: bytes, folder: Path) -> bytes | None:
    """Program to CL file to program."""
    (folder / "a.mpf").write_bytes(program)
    run = run_program(folder / "a.mpf", MACHINE)
    assert run.errors == ()
    converted = convert(run, CONTROL)
    with (folder / "a.cls").open("wb") as sink:
        write_cl(converted.toolpath, sink)
    back = read_cl(folder / "a.cls")
    assert back.remarks == ()
    return posted(back, converted.settings)


SETTINGS = st.fixed_dictionaries(
    {"tool": st.just("")},
    optional={
        "title": st.just("轮毂"),
        "date": st.just("Tue Apr 30"),
        "method": st.sampled_from(["MILL_FINISH", "SEMI", "x"]),
        "stock": st.just("0.35"),
        "tolerance": st.just("0.02"),
        "three_axis_tolerance": st.just("0.05"),
        "work_offset": st.just("G505"),
        "edge": st.just("2"),
        "cycle832": st.just("_ORI_PRECISION"),
        "tool_call": st.just("name"),
    },
)


@settings(deadline=None, max_examples=300)
@given(toolpaths(SAYABLE, AXES), SETTINGS)
def test_a_program_of_ours_comes_back_with_the_same_bytes(
    tmp_path_factory: pytest.TempPathFactory, toolpath: Toolpath, given: dict[str, str]
) -> None:
    with_tool = given | {"tool": "7"} if given.get("tool_call") != "name" else given
    first = posted(toolpath, with_tool)
    assume(first is not None)
    assert first is not None
    second = there_and_back(first, tmp_path_factory.getbasetemp())
    assert second is not None
    assert second.decode().splitlines() == first.decode().splitlines()
