"""What a program has not stated of the tool's place is neither cut nor judged, and what it has stated is."""

from pathlib import Path

import pytest

import trunnion
from tests.support.locations import GOLDEN
from tests.support.machines import five_axis_machines
from trunnion.errors import Severity
from trunnion.model.stated_tips import StatedTips

BEVEL = GOLDEN / "dmu65" / "bevel.cls"
STOCK = "box:60,40,24,-30,-20,-10"
TOOL = "1=flat:10,length=75,flutes=40"

HEAD = "G710 G90 G94 G54\nTRAFOOF\nSUPA G0 Z0 D0\nCYCLE800()\nSUPA G0 X0 Y0 B0 C0 D1\nT=1\nM6\nS4000 M3 D1\n"
TURN = 'G0 B45 C0\nCYCLE800(0,"",0,57,0,0,0,0,45,0,0,0,0,1,0,1)\n'
AWAY = "SUPA G0 Z0 D0\nCYCLE800()\nSUPA G0 X0 Y0 B0 C0 D1\n"
#: In the plane of 45 degrees the edge of the stock is at Z 31.1; the bevel is cut at Z 28.3.
BEVEL_CUT = "G0 X14.14214 Y-30\nG0 Z85\nG1 Z28.28427 F800\nG1 Y30\n"


def simulated(folder: Path, body: str, **given: object) -> trunnion.SimulationResult:
    place = folder / "part.mpf"
    place.write_text(f"{HEAD}{body}M30\n")
    arguments: dict[str, object] = {"machine": "yl569", "stock": STOCK, "tools": [TOOL], "cell": 1.0} | given
    return trunnion.simulate(place, **arguments)  # type: ignore[arg-type]


def told(found: trunnion.SimulationResult) -> list[str]:
    return [each.what for each in found.remarks if each.severity is Severity.ERROR]


def unjudged(found: trunnion.SimulationResult) -> list[tuple[int, str]]:
    return [(each.line, each.what.split(" ")[0]) for each in found.remarks if "not judged" in each.what]


@pytest.mark.third
@pytest.mark.parametrize("machine", five_axis_machines())
def test_a_sound_bevel_has_no_finding_on_any_machine(tmp_path: Path, machine: str) -> None:
    """Plane on, X and Y at the height of home, then Z: the tool comes from above, and the height was never stated."""
    place = tmp_path / "bevel.nc"
    result = trunnion.post(BEVEL, machine=machine, output=place, simulation={"stock": STOCK, "cell": 1.5})
    assert result.passed
    assert result.simulation is not None
    assert result.simulation.removed == pytest.approx(300.0, rel=0.05)
    again = trunnion.simulate(place, machine=machine, stock=STOCK, tools=[TOOL], cell=1.5)
    assert again.passed
    assert again.removed == pytest.approx(result.simulation.removed, rel=1e-9)


def test_what_is_not_judged_is_told_once_with_its_first_block(tmp_path: Path) -> None:
    plane = TURN + BEVEL_CUT + "G0 Z85\n" + AWAY
    found = simulated(tmp_path, plane + plane)
    assert found.passed
    first = (HEAD + TURN).count("\n") + 1
    assert unjudged(found) == [(first, "2")]


@pytest.mark.parametrize(
    ("body", "line", "depth"),
    [
        (TURN + BEVEL_CUT + "G0 Y-30\nG0 Z26\nG0 Y30\nG0 Z85\n" + AWAY, "G0 Y30", 2.3),
        (TURN + "G0 X14.14214 Y0\nG0 Z26\nG1 Z85 F800\n" + AWAY, "G0 Z26", 5.1),
        (TURN + "G1 X14.14214 Y-30 F800\nG1 Z26\nG0 Y30\nG0 Z85\n" + AWAY, "G0 Y30", 5.1),
        ("G0 X0 Y0\nG0 Z-2\nG1 Z50 F800\n", "G0 Z-2", 10.0),
        ("G0 X0 Y0 Z-2\nG1 Z50 F800\n", "G0 X0 Y0 Z-2", 10.0),
        ("TRAORI\nG0 X0 Y0 Z50\nG0 B30 C0\nG0 X0 Y0 Z5\nG1 X0 Y0 Z50 F800\nTRAFOOF\n", "G0 X0 Y0 Z5", 8.0),
    ],
    ids=["along", "down", "across", "plunge", "at once", "tcp"],
)
def test_a_rapid_whose_place_is_stated_is_found(tmp_path: Path, body: str, line: str, depth: float) -> None:
    """The zero is not known, and these blocks go through the stock whatever it is."""
    found = simulated(tmp_path, body)
    rapids = [each for each in found.findings if each.kind == "rapid through stock"]
    lines = (HEAD + body).splitlines()
    assert lines[rapids[0].line - 1] == line
    assert rapids[0].depth >= 0.8 * depth - 1.0


def test_a_missing_retract_between_two_planes_is_found_where_the_zero_is_known(tmp_path: Path) -> None:
    """From the bevel straight to its other side: the swivel and the way there are judged with the zero."""
    second = 'G0 B-10\nCYCLE800(0,"",0,57,0,0,0,0,-10,0,0,0,0,1,0,1)\nG0 X-14 Y30\n'
    body = TURN + BEVEL_CUT.replace("Y30\n", "Y0\n") + "CYCLE800()\n" + second + "G0 Z85\n" + AWAY
    known = simulated(tmp_path, body, zero=(0.0, 0.0, 0.0), tool_length=75.0)
    assert any(each.kind == "rapid through stock" for each in known.findings)
    unknown = simulated(tmp_path, body)
    assert not unknown.passed
    assert any("turns rotary axes without TCP beside the stock" in what for what in told(unknown))


def test_feeds_at_a_place_that_is_never_stated_are_an_error(tmp_path: Path) -> None:
    found = simulated(tmp_path, TURN + "G0 X14.14214 Y-30\nG1 Y30 F800\n" + AWAY)
    assert not found.passed
    assert any(what.startswith("1 block at feed") for what in told(found))
    assert found.removed == 0.0


def test_the_tool_leaves_and_comes_along_the_slide_that_moves(tmp_path: Path) -> None:
    run = trunnion.read_program(_file(tmp_path, HEAD + "G0 X0 Y0\nG0 Z50\nSUPA G0 Z0 D0\nM30\n"), machine="yl569")
    tips = StatedTips.of(run)
    rows = sorted(tips.ways)
    assert [run.line[row] for row in rows] == [HEAD.count("\n") + 2, HEAD.count("\n") + 3]
    for row in rows:
        assert tips.ways[row].tolist() == pytest.approx([0.0, 0.0, 1.0])


def _file(folder: Path, text: str) -> Path:
    place = folder / "run.mpf"
    place.write_text(text)
    return place
