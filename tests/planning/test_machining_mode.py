"""Machining modes: the rule, the user's setting, and the tilted plane."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.support.operations import moves_of, operation_of
from trunnion.arrays import Floats
from trunnion.errors import InputError, RefusedError
from trunnion.machines import load_machine
from trunnion.model.frames import relative_frame
from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.toolpath import Arcs, Frame, Kind, Operation, Toolpath
from trunnion.planning import PlanOptions, plan
from trunnion.planning.machining_mode import tilted_plane

YL569 = load_machine("yl569")

unit_vectors = (
    st.tuples(*[st.floats(-1.0, 1.0)] * 3)
    .filter(lambda v: float(np.linalg.norm(v)) > 0.1)
    .map(lambda v: np.array(v) / np.linalg.norm(v))
)
points = st.tuples(*[st.floats(-500.0, 500.0)] * 3)


@st.composite
def frames(draw: st.DrawFn) -> Frame:
    """Any right-handed coordinate system."""
    x, y = draw(unit_vectors), draw(unit_vectors)
    assume(float(np.linalg.norm(np.cross(x, y))) > 0.1)
    y = y - (x @ y) * x
    return Frame(draw(points), tuple(x.tolist()), tuple((y / np.linalg.norm(y)).tolist()))


def motion_of(axis: Floats, *, frame: Frame | None = None, requested: MachiningMode | None = None) -> Motion:
    """The motion of the second of two operations; the first is upright in the absolute system."""
    axis = np.atleast_2d(axis)
    tip = np.arange(3.0 * len(axis)).reshape(-1, 3)
    first = operation_of(moves_of(np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]])), "TOP")
    second = operation_of(moves_of(tip, axis), "SIDE")
    second = Operation("SIDE", second.tool, frame or Frame(), second.moves, Arcs.empty(), (), 1)
    return plan([Toolpath("a.cls", (first, second))], YL569, 0.001, PlanOptions(mode=requested)).motions[1]


TILTED = np.array([0.6, 0.0, 0.8])
UPRIGHT = np.array([0.0, 0.0, 1.0])


@pytest.mark.parametrize(
    ("axes", "mode"),
    [
        ([UPRIGHT, UPRIGHT], MachiningMode.THREE_AXIS),
        ([TILTED], MachiningMode.TILTED),
        ([TILTED, TILTED], MachiningMode.TILTED),
        ([TILTED, UPRIGHT], MachiningMode.TCP),
        ([TILTED, UPRIGHT, TILTED], MachiningMode.TCP),
        ([UPRIGHT, TILTED, UPRIGHT], MachiningMode.TCP),
    ],
)
def test_by_rule_the_tool_axis_decides(axes: list[Floats], mode: MachiningMode) -> None:
    assert motion_of(np.array(axes)).mode is mode


def test_an_axis_that_is_z_of_a_tilted_coordinate_system_is_a_tilted_plane_there() -> None:
    frame = Frame((10.0, 20.0, -5.0), (0.8, 0.0, -0.6), (0.0, 1.0, 0.0))
    motion = motion_of(UPRIGHT, frame=frame)
    assert motion.mode is MachiningMode.TILTED
    assert motion.plane is not None
    assert motion.plane.origin == frame.origin
    np.testing.assert_allclose(motion.plane.matrix(), frame.matrix(), atol=1e-15)
    np.testing.assert_allclose(motion.as_written().moves.tip, [[0.0, 1.0, 2.0]], atol=1e-12)


def test_the_setting_takes_precedence() -> None:
    assert motion_of(TILTED, requested=MachiningMode.TCP).mode is MachiningMode.TCP
    assert motion_of(UPRIGHT, requested=MachiningMode.TCP).mode is MachiningMode.TCP
    upright = motion_of(np.array([TILTED, TILTED]), requested=MachiningMode.TILTED)
    assert upright.plane is not None


def test_the_setting_for_one_operation_takes_precedence_over_that_for_all() -> None:
    def modes(options: PlanOptions) -> list[MachiningMode]:
        operations = tuple(operation_of(moves_of(np.zeros((2, 3)), np.array([TILTED] * 2)), name) for name in "ABC")
        return [motion.mode for motion in plan([Toolpath("a.cls", operations)], YL569, 0.001, options).motions]

    assert modes(PlanOptions(mode_by_operation={"B": MachiningMode.TCP})) == [
        MachiningMode.TILTED,
        MachiningMode.TCP,
        MachiningMode.TILTED,
    ]
    everywhere = PlanOptions(mode=MachiningMode.TCP, mode_by_operation={"A": None, "C": MachiningMode.TILTED})
    assert modes(everywhere) == [MachiningMode.TILTED, MachiningMode.TCP, MachiningMode.TILTED]
    with pytest.raises(InputError, match=r"mode is set for operation D, and the program has none.*A, B, C"):
        modes(PlanOptions(mode_by_operation={"D": None}))


@pytest.mark.parametrize(
    ("axes", "requested", "line"),
    [
        ([TILTED, UPRIGHT], MachiningMode.TILTED, 10),
        ([UPRIGHT, TILTED], MachiningMode.THREE_AXIS, 11),
    ],
)
def test_a_mode_that_the_tool_axis_does_not_fit_is_refused_with_the_line(
    axes: list[Floats], requested: MachiningMode, line: int
) -> None:
    operation = operation_of(moves_of(np.zeros((2, 3)), np.array(axes)))
    if requested is MachiningMode.TILTED:
        line = 11
    with pytest.raises(RefusedError) as refused:
        plan([Toolpath("a.cls", (operation,))], YL569, 0.001, PlanOptions(mode=requested))
    assert [problem.line for problem in refused.value.problems] == [line]


@given(unit_vectors, frames())
def test_a_planes_z_is_the_tool_axis_and_its_matrix_is_square(axis: Floats, own: Frame) -> None:
    for frame in (own, relative_frame(own, own)):
        plane = tilted_plane(axis, frame)
        matrix = plane.matrix()
        np.testing.assert_allclose(matrix.T @ matrix, np.eye(3), atol=1e-12)
        np.testing.assert_allclose(matrix[:, 2], axis, atol=1e-12)


@given(frames(), st.floats(-1e-7, 1e-7))
def test_a_coordinate_system_along_the_axis_gives_origin_and_x(own: Frame, off: float) -> None:
    axis = own.matrix()[:, 2] + off * np.array(own.x)
    plane = tilted_plane(axis / np.linalg.norm(axis), own)
    np.testing.assert_allclose(plane.origin, own.origin, atol=0.5e-4 + 1e-12)
    np.testing.assert_allclose(plane.x, own.x, atol=2e-7)


@given(frames(), frames(), points)
def test_a_frame_seen_from_another_holds_the_same_points(one: Frame, other: Frame, point: tuple[float, ...]) -> None:
    seen = relative_frame(one, other)
    there = seen.matrix() @ np.array(point) + seen.origin
    absolute = other.matrix() @ there + other.origin
    np.testing.assert_allclose(absolute, one.matrix() @ np.array(point) + one.origin, atol=1e-9)


def test_arcs_are_checked_in_the_plane() -> None:
    c, s = 0.8, 0.6
    across = np.array([c, 0.0, -s])
    tip = np.array([[0.0, 0.0, 0.0], 20.0 * across])
    moves = moves_of(tip, np.array([[s, 0.0, c]] * 2))
    kinds = moves.kind.copy()
    kinds[1] = Kind.ARC
    moves = type(moves)(moves.tip, moves.axis, kinds, moves.phase, moves.feed, moves.per_rev, moves.line)
    arcs = Arcs(np.array([1]), (10.0 * across)[None], np.array([[s, 0.0, c]]), np.array([10.0]), np.zeros(1, np.int64))
    operation = Operation("OP", operation_of(moves).tool, Frame(), moves, arcs, (), 1)
    planned = plan([Toolpath("a.cls", (operation,))], YL569, 0.001).motions[0]
    written = planned.as_written()
    assert len(written.arcs.row) == 1
    np.testing.assert_allclose(written.arcs.normal, [[0.0, 0.0, 1.0]], atol=1e-12)
    tcp = plan([Toolpath("a.cls", (operation,))], YL569, 0.001, PlanOptions(mode=MachiningMode.TCP)).motions[0]
    assert len(tcp.operation.arcs.row) == 0
    assert len(tcp.operation.moves) > 10
