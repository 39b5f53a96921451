"""Arcs that go beyond the travel of a slide between their ends only."""

import asyncio
from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.verifying import check
from trunnion.errors import RefusedError
from trunnion.jobs.twin.serving import twin_program
from trunnion.machines import Machine, load_machine
from trunnion.model.subdivision import subdivide
from trunnion.reporting.content import collect_content
from trunnion.twin.playback import Playback
from trunnion.twin.running import Twin

#: A half circle of R20 about 0, 0 from Y-20 over X20 to Y20, by family; the arc is on the line given.
PROGRAMS = {
    "yl569": ("G54 D1\nG0 X0 Y-20 Z0\nG1 F500\nG3 X0 Y20 I0 J20\nM30\n", 4),
    "matsuura_mx330": ("%\nO1\nG90 G54\nG0 X0. Y-20. Z0.\nG3 X0. Y20. I0. J20. F500.\nM30\n%\n", 5),
    "linuxcnc_5axis": ("%\nG21 G90 G54\nG0 X0 Y-20 Z0\nG3 X0 Y20 I0 J20 F500\nM2\n%\n", 4),
    "dmu65": (
        "BEGIN PGM P MM\nTOOL CALL 1 Z S1000\nL X+0 Y-20 Z+0 R0 FMAX\nCC X+0 Y+0\nC X+0 Y+20 DR+ F500\n"
        "M30\nEND PGM P MM\n",
        5,
    ),
}
WHOLE = "G54 D1\nG0 X-20 Y0 Z0\nG1 F500\nG3 I20 J0\nM30\n"


def zero_of(file: Path, machine: Machine, room: float) -> tuple[float, float, float]:
    """A workpiece zero with so much room to the upper limit of X when the program is at X0, and all room elsewhere."""
    run = trunnion.verify(file, machine=machine, zero=(0, 0, 0), tool_length=0).run
    columns = [machine.column(name) for name in "XYZ"]
    start, (low, high) = run.joints[run.arcs.row[0] - 1, columns], machine.limits[columns].T
    _, y, z = (0.5 * (low + high) - start).tolist()
    return float(high[0] - room - start[0]), y - 20.0, z


def program(folder: Path, text: str) -> Path:
    file = folder / "P.MPF"
    file.write_text(text, encoding="utf-8")
    return file


@pytest.mark.parametrize("key", PROGRAMS)
def test_the_proof_refuses_it_in_every_family(key: str, tmp_path: Path) -> None:
    text, line = PROGRAMS[key]
    machine, file = load_machine(key), program(tmp_path, text)
    limit = machine.axes[machine.column("X")].high
    found = check(trunnion.verify(file, machine=machine, zero=zero_of(file, machine, 10.0), tool_length=0), "travel")
    assert not found.passed
    assert f"X goes to {limit + 10:.3f}, its limit is {limit:g} mm, 10.000 too far" in found.summary
    assert found.places[0].nc_line == line
    enough = check(trunnion.verify(file, machine=machine, zero=zero_of(file, machine, 20.001), tool_length=0), "travel")
    assert enough.passed, enough.summary


def test_a_circle_that_names_no_axis_needs_its_diameter(tmp_path: Path) -> None:
    found = trunnion.verify(program(tmp_path, WHOLE), machine="yl569")
    assert [place.text for place in check(found, "travel").places if place.text.startswith(("X", "Y"))] == [
        "Y needs 40.000 of 300 mm, 260.000 left",
        "X needs 40.000 of 500 mm, 460.000 left",
    ]
    content = collect_content(found)
    for name in "XY":
        for extents in (
            [e.whole for e in content.tip if e.name == name],
            [a.extremes for a in content.axes if a.name == name],
        ):
            (extremes,) = extents
            assert extremes is not None
            assert (round(extremes.low, 9), round(extremes.high, 9)) == (-20.0, 20.0)
            assert extremes.high_at.nc_line == 4


@pytest.mark.parametrize("turned", ["G0 B90\n", "G0 B90 C30\nTRAORI\n", "TRAORI\nG0 B90 C30\n"])
def test_rotary_axes_elsewhere_than_at_zero(turned: str, tmp_path: Path) -> None:
    """The summary agrees with dense samples of the run."""
    text = f"G54 D1\n{turned}G0 X0 Y-20 Z0\nG18 G1 F500\nG17 G3 X0 Y20 I0 J20\nG19 G2 Y20 Z-8 J-10 K0 TURN=2\nM30\n"
    found = trunnion.verify(program(tmp_path, text), machine="yl569")
    samples = subdivide(found.run, 5000, slice(len(found.run) - 2, len(found.run)))
    for extent in collect_content(found).axes[2:]:
        values = samples.joints[:, found.machine.column(extent.name)]
        assert extent.extremes is not None
        assert extent.extremes.low <= values.min() + 1e-9
        assert extent.extremes.high >= values.max() - 1e-9


CL = """TOOL PATH/HALF,TOOL,MILL
TLDATA/MILL,10.0000,0.0000,75.0000,0.0000,0.0000
MSYS/0.0000,0.0000,0.0000,1.0000000,0.0000000,0.0000000,0.0000000,1.0000000,0.0000000
LOAD/TOOL,1
SPINDL/RPM,1000,CLW
FEDRAT/MMPM,500
GOTO/{x},-{r},0.0000,0.0000000,0.0000000,1.0000000
CIRCLE/{x},0.0000,0.0000,0.0000000,0.0000000,1.0000000,{r},0.0600,0.5000,10.0000,0.0000
GOTO/{x},{end},0.0000
END-OF-PATH
"""


def cl(folder: Path, x: float, r: float, end: float) -> Path:
    file = folder / "half.cls"
    file.write_text(CL.format(x=f"{x:.4f}", r=f"{r:.4f}", end=f"{end:.4f}"), encoding="utf-8")
    return file


def test_the_planner_refuses_it_with_axis_value_limit_and_line(tmp_path: Path) -> None:
    file, settings = cl(tmp_path, 235.0, 20.0, 20.0), {"zero": "0,0,0", "tool_length": "0"}
    with pytest.raises(RefusedError) as refused:
        trunnion.post(file, machine="yl569", output=tmp_path / "p.mpf", settings=settings)
    problem = refused.value.problems[0]
    assert problem.what == "on this arc axis X would go to 255.00000, above its limit 250 mm"
    assert problem.line == 9
    fits = trunnion.post(
        cl(tmp_path, 229.999, 20.0, 20.0), machine="yl569", output=tmp_path / "p.mpf", settings=settings
    )
    assert fits.verification is not None


def test_the_planner_counts_a_whole_circle_where_no_zero_is_known(tmp_path: Path) -> None:
    with pytest.raises(RefusedError) as refused:
        trunnion.post(cl(tmp_path, 0.0, 151.0, -151.0), machine="yl569", output=tmp_path / "p.mpf")
    assert "axis Y would go from -151.000 to 151.000, 302.000 mm" in refused.value.problems[0].what
    assert refused.value.problems[0].line == 9


def test_the_description_has_what_arcs_pass(tmp_path: Path) -> None:
    (operation,) = trunnion.describe_cl(cl(tmp_path, 5.0, 20.0, 20.0)).operations
    assert operation.extents is not None
    assert np.round(operation.extents, 9).tolist() == [[5.0, -20.0, 0.0], [25.0, 20.0, 0.0]]


class _Alarms:
    def __init__(self) -> None:
        self.texts: list[str] = []

    async def alarm(self, identifier: str, text: str, stamp: object) -> None:
        self.texts.append(text)

    async def alarm_over(self, *_: object) -> None: ...

    async def show(self, *_: object) -> None: ...

    async def changed(self, *_: object) -> None: ...

    async def message(self, *_: object) -> None: ...

    def lagging(self) -> dict[object, int]:
        return {}


def test_the_twin_tells_of_it_however_seldom_it_looks(tmp_path: Path) -> None:
    machine = load_machine("yl569")
    file = program(tmp_path, PROGRAMS["yl569"][0])
    model = twin_program(file, machine=machine, zero=zero_of(file, machine, 10.0), tool_length=0)
    alarms, playback = _Alarms(), Playback(model.timed, speed=None)
    twin = Twin(model, playback, 1e6)
    twin.outlets.append(alarms)

    async def whole() -> None:
        task = asyncio.create_task(twin.run())
        while not alarms.texts and not task.done() and playback.seconds < playback.duration:
            await asyncio.sleep(0.001)
        await asyncio.sleep(0.01)
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)

    asyncio.run(whole())
    assert alarms.texts == ["axis X is beyond its travel of -250 to 250 in line 4"]
