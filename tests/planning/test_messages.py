"""Refusals name the place, the axis and the nearest remedy."""

import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.support.operations import moves_of, operation_of
from tests.support.path_strategies import BC, CA, directions, winding, with_limits
from tests.support.rewind_paths import round_part
from tests.support.without_tcp import NAMES
from tests.support.without_tcp import machine as roomy
from trunnion.errors import InputError, Problem, RefusedError, Severity
from trunnion.machines import Machine, inverse, load_machine
from trunnion.model.motion import MachiningMode
from trunnion.model.toolpath import CutterComp, Moves, Operation, Toolpath
from trunnion.planning import Clearance, ClearanceSurface, PlanOptions, plan
from trunnion.planning.poses.limit_lookahead import degrees_out_of_reach

NUTATED = load_machine("generic_nutated_b45_c")
OFF = PlanOptions(tcp=False)


def against(machine: Machine, operation: Operation, options: PlanOptions | None = None) -> list[Problem]:
    """The problems of a plan, worst first."""
    try:
        problems = plan([Toolpath("part.cls", (operation,))], machine, 0.001, options).problems
    except (RefusedError, InputError) as error:
        problems = tuple(error.problems)
    return [problem for problem in problems if problem.severity is Severity.ERROR]


def cut(tilt: float, azimuth: float = 0.0) -> Moves:
    return moves_of(np.zeros((1, 3)), directions(np.array([tilt]), np.array([azimuth])))


def slides(machine: Machine, **limits: tuple[float, float]) -> Machine:
    """The machine with limits for some slides and none for the others."""
    axes = (
        axis
        if axis.is_rotary
        else replace(axis, low=limits.get(axis.name, (-np.inf, 0))[0], high=limits.get(axis.name, (0, np.inf))[1])
        for axis in machine.axes
    )
    return replace(machine, axes=tuple(axes))


def two_points(first: tuple[float, float], last: tuple[float, float]) -> Moves:
    axis = directions(np.array([first[0], last[0]]), np.array([first[1], last[1]]))
    return moves_of(np.array([[0.0, 0.0, 0.0], [30.0, 0.0, 0.0]]), axis)


#: Request -> machine, operation, options, beginning of the message, beginning of its remedy.
IMPOSSIBLE: dict[str, tuple[Machine, Operation, PlanOptions | None, str, str]] = {
    "out of reach": (
        NUTATED, operation_of(cut(110.0)), None,
        r"part.cls:10: error: no rotary position of \S+ gives the tool axis 0.9\d+, ",
        r"tilt the workpiece by 20.000 degrees, or post for a machine that reaches it",
    ),
    "beyond a rotary limit": (
        load_machine("yl569"), operation_of(cut(110.0)), None,
        "part.cls:10: error: axis B would go to 110.00000, above its limit 100 degrees",
        r"tilt the workpiece by 10.000 degrees \(in the other pose B would go to -110.0+\), or post for another",
    ),
    "beyond a slide's limit": (
        slides(roomy("generic_head_head_ca"), X=(-20.0, 20.0)),
        operation_of(moves_of(np.array([[0.0, 0.0, 0.0]]), directions(np.zeros(1), np.zeros(1)))), None,
        "part.cls:10: error: axis X would go to 37.0+, above its limit 20 mm",
        r"bring X back by 17.000 mm: shift the workpiece zero",
    ),
    "more than a slide's travel": (
        BC, operation_of(moves_of(np.array([[0.0] * 3, [9000.0, 0.0, 0.0]]), np.array([[0.0, 0.0, 1.0]] * 2))), None,
        "part.cls:11: error: axis X would go from 0.000 to 9000.000, 9000.000 mm; its travel",
        "move or turn the workpiece, or post for another machine",
    ),
    "a rewind that is forbidden": (
        CA, operation_of(round_part()), PlanOptions(allow_rewinds=False),
        r"part.cls:\d\d+: error: axis C would go to 36\d\.\d+, above its limit 360 degrees in the cut",
        r"allow rewinds \(setting rewind=insert\), split the operation, or turn the workpiece",
    ),
    "a turn over within one step": (
        with_limits(BC, C=(-80, 80), B=(-110, 110)),
        operation_of(moves_of(np.zeros((3, 3)), directions(np.full(3, 40.0), np.array([60.0, 70.0, 110.0])))), None,
        "part.cls:12: error: the rotary axes flip between these two points, C 70.000 B 40.000 to C -70.000",
        "output the toolpath with points nearer to each other, or tilt the workpiece",
    ),
    "a rewind that leads nowhere": (
        CA, operation_of(replace(winding(89.5, 100.0, 1100.0), tip=40.0 * winding(89.5, 100.0, 1100.0).axis)),
        PlanOptions(clearance=Clearance(90.0, ClearanceSurface.PLANE)),
        r"part.cls:\d+: error: the tool must rewind here, and its axis does not lead to the clearance plane:90",
        "setting clearance=MM draws back by a distance",
    ),
    "a rewind under radius compensation": (
        CA, replace(operation_of(round_part()), events=(CutterComp(3, 13, "LEFT"),)), None,
        r"part.cls:\d+: error: a rewind within cutter radius compensation",
        "output the path without CUTCOM, or split the operation",
    ),
    "a way beyond a slide's limit": (
        slides(roomy("generic_head_head_ca"), Y=(-170.0, 170.0)),
        operation_of(two_points((40.0, 60.0), (40.0, 120.0))), OFF,
        "part.cls:11: error: on the way to this point axis Y would go to 175.168\\d+, above its limit 170 mm",
        "bring Y back by 5.168 mm",
    ),
    "a step across the pole": (
        roomy("generic_head_head_ca"), operation_of(two_points((0.3, 0.0), (0.3, 150.0))),
        PlanOptions(tcp=False, axis_tolerance=0.001),
        "part.cls:11: error: in this step of the cut the tool axis leaves its path by more than 0.001 degrees",
        "setting axis_tolerance=DEGREES allows more; or output the toolpath with points nearer to each other",
    ),
    "a plane whose axis changes": (
        BC, operation_of(two_points((10.0, 0.0), (20.0, 0.0))), PlanOptions(mode=MachiningMode.TILTED),
        "part.cls:11: error: operation OP: the tool axis changes, and mode is tilted",
        "leave the setting mode out, or split the operation",
    ),
    "without TCP and a place": (
        replace(roomy("yl569"), workpiece_zero=None), operation_of(two_points((10.0, 0.0), (20.0, 0.0))), OFF,
        "part.cls:1: error: without TCP the program holds positions of the linear axes, and the workpiece zero on the",
        "write setting zero=X,Y,Z",
    ),
}  # fmt: skip


@pytest.mark.parametrize("request_", sorted(IMPOSSIBLE))
def test_an_impossible_request_names_place_axis_and_remedy(request_: str) -> None:
    machine, operation, options, what, cure = IMPOSSIBLE[request_]
    problems = against(machine, operation, options)
    assert problems, "it can be done"
    said = f"{problems[0].file}:{problems[0].line}: error: {problems[0].what}"
    assert re.match(what, said), said
    assert re.match(cure, problems[0].cure), problems[0].cure


@given(st.sampled_from(NAMES), st.floats(0.0, 180.0), st.floats(-180.0, 180.0))
def test_a_tool_axis_tilted_by_the_missing_angle_is_within_reach(name: str, tilt: float, azimuth: float) -> None:
    machine = load_machine(name)
    (axis,) = directions(np.array([tilt]), np.array([azimuth]))
    lacking = degrees_out_of_reach(machine, axis)
    assume(abs(lacking) > 1e-4)
    assert bool(inverse(machine, np.zeros((1, 3)), axis[None]).reachable[0]) is (lacking < 0.0)
    if lacking > 0.0:
        first = np.array(machine.axes[machine.rotary[0]].direction)
        across = np.cross(first, axis)
        assume(np.linalg.norm(across) > 1e-6)
        across /= np.linalg.norm(across)
        ways = [np.cos(a) * axis + np.sin(a) * np.cross(across, axis) for a in np.radians([lacking, -lacking]) * 1.0001]
        assert inverse(machine, np.zeros((2, 3)), np.array(ways)).reachable.any()
