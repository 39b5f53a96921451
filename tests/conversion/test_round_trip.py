"""Programs of ours converted to CL files and posted again: the same bytes."""

import io
from pathlib import Path

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

import trunnion
from tests.support.examples import examples
from tests.support.posting import FOOT, HEAD
from tests.support.toolpath_strategies import SAYABLE, sensible, skips_are_unsafe, toolpaths
from trunnion.cl import read_cl
from trunnion.cl.write import write_cl
from trunnion.controls import load_control
from trunnion.conversion import Conversion, convert
from trunnion.errors import RefusedError, Severity
from trunnion.machines import load_machine
from trunnion.model.motion import MachiningMode
from trunnion.model.toolpath import Toolpath
from trunnion.output.program import Program
from trunnion.output.program_writer import write_program
from trunnion.output.validation import check_program
from trunnion.planning import PlanOptions, plan
from trunnion.readers import run_program
from trunnion.verification.comparison import compare

MACHINE = load_machine("yl569")
CONTROL = load_control(MACHINE.control)

#: Tool axes that the YL569 reaches: upright, or clear of its pole. Nearer to it, the printed angles of a tilted plane
#: leave C open.
AXES = st.one_of(
    st.just((0.0, 0.0, 1.0)),
    st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.floats(0.01, 1)).filter(
        lambda axis: abs(axis[0]) + abs(axis[1]) > 0.01
    ),
)


def posted(toolpath: Toolpath, given: dict[str, str], planes: bool = True) -> bytes | None:
    """The program; None if it is refused. Without ``planes``, one with tilted planes is posted with TCP instead."""
    try:
        planned = plan([toolpath], MACHINE, CONTROL.arcs.chord_tolerance)
    except RefusedError as refused:
        if not skips_are_unsafe(refused):
            raise
        return None
    if not planes and any(motion.plane is not None for motion in planned.motions):
        planned = plan([toolpath], MACHINE, CONTROL.arcs.chord_tolerance, PlanOptions(mode=MachiningMode.TCP))
    given = {"standing_spindle": "allowed", **given}
    program = Program(MACHINE, CONTROL, planned.motions, given, toolpath.file)
    if any(problem.severity is Severity.ERROR for problem in check_program(program)):
        return None
    sink = io.BytesIO()
    write_program(program, sink)
    return sink.getvalue()


def back_again(program: bytes, folder: Path) -> Conversion:
    """The program converted."""
    (folder / "a.mpf").write_bytes(program)
    run = run_program(folder / "a.mpf", MACHINE)
    assert run.errors == ()
    return convert(run, CONTROL)


def there_and_back(program: bytes, folder: Path, planes: bool = True) -> bytes | None:
    """The program converted to a CL file and posted again."""
    converted = back_again(program, folder)
    with (folder / "a.cls").open("wb") as sink:
        write_cl(converted.toolpath, sink)
    back = read_cl(folder / "a.cls")
    assert back.remarks == ()
    return posted(back, converted.settings, planes)


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


def with_tool(given: dict[str, str]) -> dict[str, str]:
    """The settings, with a tool unless it is called by its name."""
    return given if given.get("tool_call") == "name" else given | {"tool": "7"}


@settings(
    deadline=None, max_examples=examples(70), suppress_health_check=[HealthCheck.filter_too_much, HealthCheck.too_slow]
)
@given(sensible(toolpaths(SAYABLE, AXES)), SETTINGS)
def test_a_program_of_ours_comes_back_with_the_same_bytes(
    tmp_path_factory: pytest.TempPathFactory, toolpath: Toolpath, given: dict[str, str]
) -> None:
    """If points differ as printed from those before them, and no kind of event happens twice between two of them.

    Besides, block skip goes on and off in turn, and cutter radius compensation changes on a motion. Several events at
    one place, and feeds or phases of a tool at rest, print blocks that only the program's text tells apart; the test
    below covers what they do. It covers tilted planes too: near the pole their printed angles leave the last digit of a
    rotary axis open. So do printed angles between two poses that are as good as each other, which the conversion tells.
    """
    first = posted(toolpath, with_tool(given), planes=False)
    assume(first is not None)
    assert first is not None
    told = [warning.what for warning in back_again(first, tmp_path_factory.getbasetemp()).warnings]
    assume(not any(what.startswith("other rotary positions") for what in told))
    second = there_and_back(first, tmp_path_factory.getbasetemp(), planes=False)
    assert second is not None
    assert second.decode().splitlines() == first.decode().splitlines()


@settings(deadline=None, max_examples=examples(70))
@given(toolpaths(SAYABLE, AXES), SETTINGS)
def test_whatever_the_toolpath_the_tool_does_the_same(
    tmp_path_factory: pytest.TempPathFactory, toolpath: Toolpath, given: dict[str, str]
) -> None:
    folder = tmp_path_factory.getbasetemp()
    first = posted(toolpath, with_tool(given))
    assume(first is not None)
    assert first is not None
    second = there_and_back(first, folder)
    assert second is not None
    (folder / "b.mpf").write_bytes(second)
    found = compare(run_program(folder / "a.mpf", MACHINE), run_program(folder / "b.mpf", MACHINE), 1e-6)
    assert found.same, "\n".join(found.lines())


def test_a_tool_whose_name_is_a_number_is_called_by_its_name_again(tmp_path: Path) -> None:
    text = HEAD.replace("TOOL,D10", "TOOL,7").replace("LOAD/TOOL,1,ADJUST,1\n", "") + FOOT
    (tmp_path / "part.cls").write_text(text + text.replace("OP1", "OP2"))
    first = posted(read_cl(tmp_path / "part.cls"), {"tool_call": "name"})
    assert first is not None
    assert first.count(b'T="7"') == 1
    assert there_and_back(first, tmp_path) == first


@pytest.mark.third
@pytest.mark.parametrize("machine", ["yl569", "dmu65", "matsuura_mx330", "hs664rt", "xyzac_trt", "haas_umc750"])
def test_a_stop_behind_the_last_point_stays_in_its_operation(machine: str, tmp_path: Path) -> None:
    text = HEAD + FOOT.replace("END-OF-PATH", "STOP\nEND-OF-PATH")
    (tmp_path / "part.cls").write_text(text + text.replace("OP1", "OP2"))
    first, second = tmp_path / "a.nc", tmp_path / "b.nc"
    trunnion.post(tmp_path / "part.cls", machine=machine, output=first)
    trunnion.convert(first, machine=machine, to_machine=machine, output=second)
    around = []
    for path in (first, second):
        lines = [line.split(" ", 1)[-1] for line in path.read_text(encoding="utf-8").splitlines()]
        around.append([lines[n - 2 : n + 3] for n, line in enumerate(lines) if line == "M0"])
    assert len(around[0]) == 2
    assert around[1] == around[0]
