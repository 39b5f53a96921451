"""Holes whose bottom alone is beyond the travel of a slide."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.verifying import check
from trunnion.arrays import Floats
from trunnion.errors import RefusedError, Severity
from trunnion.machines import Machine, kinematic_parameters, load_machine
from trunnion.model.axis_positions import joints_from_rows
from trunnion.model.toolpath import Kind
from trunnion.reporting.content import collect_content
from trunnion.reporting.listing import listing

#: One hole from a point above it, its axis along ``axis``, drilled in line 9.
CL = """TOOL PATH/DR,TOOL,DRILL_10
TLDATA/DRILL,MILL,10.0000,0.0000,60.0000,118.0000,50.0000
MSYS/0.0,0.0,0.0,1.0,0.0,0.0,0.0,1.0,0.0
LOAD/TOOL,1,ADJUST,1
SPINDL/RPM,1500.0,CLW
RAPID
GOTO/{above},{axis}
CYCLE/{cycle},RAPTO,3.0,FEDTO,-{depth},RTRCTO,{retract},MMPM,400.0
GOTO/{point}
CYCLE/OFF
RAPID
GOTO/{above}
END-OF-PATH
"""
POINT = np.array([10.0, 0.0, 20.0])

#: A machine of each family, and tool axes that slides of its own drill along.
CASES = [
    (key, axis)
    for key in ("yl569", "matsuura_mx330", "haas_umc750", "linuxcnc_5axis", "dmu65", "hs664rt")
    for axis in ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0))
] + [("yl569", (0.6, 0.0, 0.8)), ("generic_head_head_ca", (0.0, -1.0, 0.0))]  # fmt: skip


def machine_of(key: str) -> Machine:
    """A shipped machine; slides whose travel it does not state have some."""
    machine = load_machine(key)
    axes = [
        replace(axis, low=-400.0, high=400.0) if not axis.is_rotary and not axis.has_limits else axis
        for axis in machine.axes
    ]
    return replace(machine, axes=tuple(axes))


def hole(
    folder: Path,
    axis: tuple[float, ...] = (0, 0, 1),
    *,
    depth: float = 40.0,
    retract: float = 3.0,
    above: float = 20.0,
    cycle: str = "DRILL",
) -> Path:
    texts = [",".join(f"{x:.7f}" for x in at) for at in (POINT, POINT + above * np.array(axis), axis)]
    text = CL.format(point=texts[0], above=texts[1], axis=texts[2], depth=depth, retract=retract, cycle=cycle)
    (folder / "hole.cls").write_text(text, encoding="utf-8")
    return folder / "hole.cls"


def post(file: Path, machine: Machine | str, folder: Path, force: bool = False, **settings: str) -> trunnion.PostResult:
    return trunnion.post(file, machine=machine, output=folder / "p.nc", settings=settings, force=force)


def refused(file: Path, machine: Machine | str, folder: Path, **settings: str) -> tuple[str, int]:
    with pytest.raises(RefusedError) as error:
        post(file, machine, folder, False, **settings)
    problem = next(each for each in error.value.problems if each.severity is Severity.ERROR)
    return problem.what, problem.line


def placed(zero: Floats) -> str:
    return ",".join(map(repr, zero.tolist()))


def at_hole(machine: Machine, zero: Floats, tips: Floats, rotary: Floats) -> Floats:
    """Axis values at tips (k, 3) for a tool 0 mm long."""
    x, y, z = zero.tolist()
    there, every = replace(machine, workpiece_zero=(x, y, z), tool_length=0.0), np.ones(len(tips), np.bool_)
    return joints_from_rows(there, kinematic_parameters(there), every, tips, np.tile(rotary, (len(tips), 1)))


def zero_beyond(machine: Machine, tips: Floats, rotary: Floats, beyond: float) -> tuple[Floats, int, float]:
    """A zero with which one slide goes so far beyond a limit at the first of two tips, which slide, and where to.

    The others stand in the middle of their travel.
    """
    origin = np.zeros(3)
    bottom, top = at_hole(machine, origin, tips, rotary)
    slides = list(machine.linear)
    column = slides[int(np.argmax(np.abs(bottom - top)[slides]))]
    axis = machine.axes[column]
    goal = np.zeros(5)
    goal[slides] = machine.limits[slides].mean(axis=1)
    goal[column] = axis.low - beyond if bottom[column] < top[column] else axis.high + beyond
    shifts = np.array([at_hole(machine, shift, tips[:1], rotary)[0] - bottom for shift in np.eye(3)])[:, slides]
    return np.linalg.solve(shifts.T, (goal - bottom)[slides]), column, float(goal[column])


@pytest.mark.third
@pytest.mark.parametrize(("key", "axis"), CASES)
def test_planner_and_proof_refuse_it_in_every_family_and_plane(
    key: str, axis: tuple[float, ...], tmp_path: Path
) -> None:
    machine, file = machine_of(key), hole(tmp_path, axis)
    verification = post(file, machine, tmp_path).verification
    assert verification is not None
    run = verification.run
    rotary = run.rotary[np.flatnonzero(run.kind == Kind.LINEAR)[-1]]
    tips = POINT + np.array([[-40.0], [20.0]]) * np.array(axis)
    zero, column, value = zero_beyond(machine, tips, rotary, 10.0)
    moved = machine.axes[column]
    name, (limit, side) = moved.name, (moved.low, "below") if value < moved.low else (moved.high, "above")
    what, line = refused(file, machine, tmp_path, zero=placed(zero), tool_length="0")
    in_hole = "" if key == "linuxcnc_5axis" and axis[2] == 0.0 else "in this hole "  # there it is motion
    assert what == f"{in_hole}axis {name} would go to {value:.5f}, {side} its limit {limit:g} mm"
    assert line == 9
    forced = post(file, machine, tmp_path, True, zero=placed(zero), tool_length="0").verification
    assert forced is not None
    found = check(forced, "travel")
    assert not found.passed
    assert f"{name} goes to {value:.3f}, its limit is {limit:g} mm, 10.000 too far" in found.summary
    (extent,) = (extent for extent in collect_content(forced).axes if extent.name == name)
    assert extent.margin == pytest.approx(-10.0, abs=2e-3)
    zero, *_ = zero_beyond(machine, tips, rotary, -0.01)
    fits = post(file, machine, tmp_path, zero=placed(zero), tool_length="0").verification
    assert fits is not None
    assert check(fits, "travel").passed


def test_the_retract_counts_as_well(tmp_path: Path) -> None:
    what, line = refused(hole(tmp_path, retract=60.0), "yl569", tmp_path, zero="0,0,180", tool_length="0")
    assert (what, line) == ("in this hole axis Z would go to 260.00000, above its limit 250 mm", 9)
    post(hole(tmp_path, retract=60.0), "yl569", tmp_path, zero="0,0,169", tool_length="0")


def test_the_planner_counts_holes_where_no_zero_is_known(tmp_path: Path) -> None:
    what, line = refused(hole(tmp_path, depth=485.0), "yl569", tmp_path)
    assert "axis Z would go from -465.000 to 40.000, 505.000 mm" in what
    assert line == 9
    post(hole(tmp_path, depth=479.9), "yl569", tmp_path)


def test_extents_have_holes_from_the_bottom_to_where_the_tool_goes_on(tmp_path: Path) -> None:
    description = trunnion.describe_cl(hole(tmp_path, (0.6, 0.0, 0.8), retract=30.0))
    assert description.extents is not None
    assert np.round(description.extents, 9).tolist() == [[-14.0, 0.0, -12.0], [28.0, 0.0, 44.0]]


#: Programs whose slides go as far as it says, mm, without a zero: mostly in cycles, which name no axis of their own.
PROGRAMS = {
    "modal": ("haas_umc750",
        "%\nO1\nG54\nG0 X0. Y0.\nG43 Z50. H1\nG99 G83 Z-40. R3. Q5. F100.\nX10.\n{end}", "Z90 X10 Y0"),
    "repeated": ("haas_umc750",
        "%\nO1\nG54\nG0 X0. Y0.\nG43 Z50. H1\nG91 G99 G81 X10. Z-43. R-47. F100. L3\n{end}", "Z90 X30 Y0"),
    "from home": ("matsuura_mx330",
        "%\nO1\nG91 G28 Z0.\nG90 G54 G43 H1\nG99 G81 X0. Y0. Z-40. R3. F100.\nX10.\n{end}", "Z43 X10 Y0"),
    "along Y": ("linuxcnc_5axis", "%\nG21 G54\nG0 X0 Y5\nZ0\nG18 G99 G81 Y-40 R3 F100\nX10\n{end}", "Y45 X10 Z0"),
    "along X": ("linuxcnc_5axis", "%\nG21 G54\nG0 X5 Y0\nZ0\nG19 G99 G81 X-40 R3 F100\nY10\n{end}", "X45 Y10 Z0"),
    "MCALL": ("yl569", "G54 D1\nG0 X0 Y0 Z50\nF100\nMCALL CYCLE81(50,0,3,-40)\nX0\nX10\nMCALL\nM30\n", "Z90 X10 Y0"),
    "lift": ("yl569", "G54 D1\nG0 X0 Y0 Z50\nF100 M3 S99\nCYCLE86(50,0,3,-40,,,3,7,0,0,90)\nM30\n", "Z90 X7 Y0"),
    "M99": ("dmu65", "BEGIN PGM P MM\nTOOL CALL 1 Z S99\nL X+0 Y+0 Z+50 R0 FMAX\n"
        "CYCL DEF 202 Q200=3 Q201=-40 Q206=100 Q211=0 Q208=100 Q203=+0 Q204=50 Q214=1 Q336=0\nCYCL CALL\n"
        "L X+10 R0 FMAX M99\nM30\nEND PGM P MM\n", "Z90 X10.2 Y0"),
    "bore milling": ("dmu65", "BEGIN PGM P MM\nTOOL CALL 1 Z S99\nL X+0 Y+0 Z+50 R0 FMAX\n"
        "CYCL DEF 208 Q200=3 Q201=-40 Q206=100 Q334=5 Q203=+0 Q204=50 Q335=60 Q342=0 Q351=1\nCYCL CALL\n"
        "M30\nEND PGM P MM\n", "Z90 X60 Y60"),
}  # fmt: skip


@pytest.mark.parametrize("name", PROGRAMS)
def test_cycles_need_what_they_move(name: str, tmp_path: Path) -> None:
    key, text, needs = PROGRAMS[name]
    file, wanted = tmp_path / "P.NC", {need[0]: float(need[1:]) for need in needs.split()}
    file.write_text(text.format(end="G80\nM30\n%\n" if "O1" in text else "G80\nM2\n%\n"), encoding="utf-8")
    found = trunnion.verify(file, machine=key)
    places = [place.text for place in check(found, "travel").places if place.text[0] in wanted]
    assert sorted(text.split(" of ")[0] for text in places) == sorted(
        f"{axis} needs {value:.3f}" for axis, value in wanted.items()
    )
    for extent in collect_content(found).axes:
        if extent.name in wanted:
            assert extent.extremes is not None
            assert extent.extremes.high - extent.extremes.low == pytest.approx(wanted[extent.name], abs=1e-9)


@pytest.mark.parametrize(("zero", "length"), [(None, None), ((1.0, 2.0, -300.0), None)])
def test_what_has_no_place_counts_from_the_workpiece_zero(
    zero: tuple[float, float, float] | None, length: float | None, tmp_path: Path
) -> None:
    """The gauge point of this machine is not at the zero of its slides."""
    file = tmp_path / "P.NC"
    file.write_text(
        "%\nO1\nG91 G28 Z0.\nG90 G54 G43 H1\nG0 X0. Y0.\nZ3.\nG1 Z-40. F100.\nG0 Z3.\nX10.\nM30\n%\n", encoding="utf-8"
    )
    found = trunnion.verify(file, machine="matsuura_mx330", zero=zero, tool_length=length)
    extents = {each.name: each for each in collect_content(found).axes}
    for name, low, high in (("X", 0.0, 10.0), ("Z", -40.0, 3.0)):
        extremes, is_placed = extents[name].extremes, zero is not None and name == "X"
        assert extremes is not None
        assert extents[name].zero_known == is_placed
        start = found.run.joints[-1, found.machine.column(name)] - (10.0 if name == "X" else 3.0) if is_placed else 0.0
        assert (extremes.low, extremes.high) == pytest.approx((start + low, start + high), abs=1e-9)
    lines = b"".join(listing(found.run, "P", [], slides=True)).decode().splitlines()
    assert "; SX SY SZ: linear axes, mm, counted from the workpiece zero" in lines
    bottom = next(words for words in map(str.split, lines) if words[-1] == "line")
    assert bottom[-7:-4] == ["0.0000", "0.0000", "-40.0000"]
