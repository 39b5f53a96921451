"""Programs in several work offsets with zeros of their own cut the stock where the table has them."""

from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.recordings import recorded
from tests.support.verifying import check
from trunnion.jobs.inputs.settings import Settings
from trunnion.jobs.inputs.stated_setup import ZeroLike
from trunnion.jobs.simulate.result import SimulationResult
from trunnion.jobs.twin.serving import twin_program
from trunnion.jobs.view.viewing import prepare_view
from trunnion.machines import load_machine
from trunnion.readers import reader_of
from trunnion.verification.results import Check

#: A machine of each family of controls.
MACHINES = ("yl569", "dmu65", "hs664rt", "matsuura_mx330", "haas_umc750", "xyzac_trt")

HEAD = "MSYS/0,0,0,1,0,0,0,1,0\nINTOL/0.01\nOUTTOL/0.01\n"
#: Where the second offset is from the first: no multiple of a cell, and in Z as well.
APART = (31.0, 7.0, -1.5)
FIRST = (0.0, 0.0, 60.0)
STOCK = "box:90,50,12,-20,-15,-12"


def operation(name: str, shift: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> str:
    """A slot with an arc, 2 mm deep."""
    x, y, z = shift
    return (
        f"TOOL PATH/{name},TOOL,D10\nTLDATA/MILL,10.0,0.0,75.0,0.0,0.0\n{HEAD}LOAD/TOOL,1,ADJUST,1\n"
        f"SPINDL/RPM,4000,CLW\nRAPID\nGOTO/{x},{y},{z + 20.0},0.0,0.0,1.0\nFEDRAT/MMPM,500.0\nGOTO/{x},{y},{z - 2.0}\n"
        f"GOTO/{x + 12.0},{y},{z - 2.0}\nCIRCLE/{x + 12.0},{y + 6.0},{z - 2.0},0.0,0.0,1.0,6.0\n"
        f"GOTO/{x + 18.0},{y + 6.0},{z - 2.0}\nRAPID\nGOTO/{x + 18.0},{y + 6.0},{z + 20.0}\nEND-OF-PATH\n"
    )


def offsets(machine: str) -> tuple[str, str]:
    """Two work offsets as the setting has them."""
    words = reader_of(load_machine(machine)).work_offsets
    found = [words.setting(value) for value in range(1, 1200) if words.value_of(words.setting(value)) == value]
    return found[0], found[1]


def zeros(machine: str) -> dict[str, tuple[float, float, float]]:
    one, two = offsets(machine)
    x, y, z = (a + b for a, b in zip(FIRST, APART, strict=True))
    return {one: FIRST, two: (x, y, z)}


def posted(machine: str, folder: Path, *, shifted: bool) -> Path:
    """Two slots: in one offset, the second shifted; or each in an offset of its own."""
    one, two = offsets(machine)
    cl, program = folder / f"{shifted}.cls", folder / f"{shifted}.nc"
    cl.write_text(operation("ONE") + operation("TWO", APART if shifted else (0.0, 0.0, 0.0)), encoding="utf-8")
    chosen = one if shifted else f"{one},TWO:{two}"
    trunnion.post(cl, machine=machine, output=program, settings={"work_offset": chosen})
    return program


def simulated(machine: str, program: Path, **given: object) -> SimulationResult:
    return trunnion.simulate(
        program, machine=machine, stock=STOCK, tools=["1=flat:10,length=60", "D10=flat:10,length=60"], cell=1.0,
        **given,  # type: ignore[arg-type]
    )  # fmt: skip


@pytest.mark.third
@pytest.mark.parametrize("length", [None, 110.0])
@pytest.mark.parametrize("machine", MACHINES)
def test_two_places_of_the_table_are_cut_as_one_program_cuts_them(
    machine: str, length: float | None, tmp_path: Path
) -> None:
    at_two = posted(machine, tmp_path, shifted=False)
    shifted = posted(machine, tmp_path, shifted=True)
    found = simulated(machine, at_two, zero=zeros(machine), tool_length=length)
    wanted = simulated(machine, shifted, zero=FIRST, tool_length=length)
    assert found.removed == pytest.approx(wanted.removed, rel=1e-9)
    for k in range(3):
        one, other = found.simulation.stock.spans(k), wanted.simulation.stock.spans(k)
        assert np.array_equal(one.first, other.first)
        assert np.allclose(one.ends, other.ends, atol=1e-6)
    assert [each.kind for each in found.findings] == [each.kind for each in wanted.findings]
    over_each_other = simulated(machine, at_two, zero=FIRST, tool_length=length)
    assert over_each_other.removed < 0.7 * found.removed


@pytest.mark.third
@pytest.mark.parametrize("machine", MACHINES)
def test_view_and_twin_stand_where_one_program_stands(machine: str, tmp_path: Path) -> None:
    pairs: list[tuple[Path, ZeroLike]] = [
        (posted(machine, tmp_path, shifted=False), zeros(machine)),
        (posted(machine, tmp_path, shifted=True), FIRST),
    ]
    views = [prepare_view(program, machine=machine, zero=zero, tool_length=110.0) for program, zero in pairs]
    assert views[0].scene["machine"]["zero"] == views[1].scene["machine"]["zero"] == FIRST
    for k in range(5):
        assert np.abs(views[0].columns[f"axis-{k}"] - views[1].columns[f"axis-{k}"]).max() <= 1
    twins = [twin_program(program, machine=machine, zero=zero, tool_length=110.0) for program, zero in pairs]
    seconds = np.linspace(0.0, 0.999 * twins[1].timed.duration, 300)
    seen = [each.at(seconds, np.full(len(seconds), -1)) for each in twins]
    assert np.allclose(seen[0].joints, seen[1].joints, atol=2e-3)
    assert np.allclose(seen[0].tip, seen[1].tip, atol=2e-3)


HAND = (
    "%\nO0001\nG21 G17 G40 G80 G90 G94\nG49 G53 G0 Z0.\nT1 M6\nS1500 M3\n{first}G0 X0. Y0.\nG43 H1 Z20.\n"
    "G1 Z-2. F200.\n"
    "X12.\nG0 Z20.\n{second}G0 {back}Z20.\nG1 Z-2. F200.\n{cut}\nG0 Z20.\nM5\nG49 G53 G0 Z0.\nM30\n%\n"
)


def by_hand(folder: Path, **words: str) -> Path:
    program = folder / f"{len(list(folder.iterdir()))}.nc"
    program.write_text(HAND.format(**words), encoding="utf-8")
    return program


def test_an_axis_that_is_not_named_stays_on_the_machine(tmp_path: Path) -> None:
    """Behind G55 alone Y stays where G54 has left it: that is another Y in G55."""
    machine = "matsuura_mx330"
    x, _, z = APART
    two = by_hand(tmp_path, first="G54\n", second="G55\n", back="X5. ", cut="X9.")
    same = by_hand(tmp_path, first="G54\n", second="", back=f"X{x + 5.0} Z{z + 20.0}\n", cut=f"Z{z - 2.0}\nX{x + 9.0}")
    same.write_text(same.read_text().replace("Z20.\nG1 Z-2. F200.\nZ-3.5", "\nG1 Z-3.5 F200."))
    found = simulated(machine, two, zero=zeros(machine), tool_length=110.0)
    wanted = simulated(machine, same, zero=FIRST, tool_length=110.0)
    assert found.removed == pytest.approx(wanted.removed, rel=1e-9)


def test_the_stock_is_in_the_work_offset_of_the_set_up(tmp_path: Path) -> None:
    machine = "matsuura_mx330"
    program = by_hand(tmp_path, first="G55\n", second="G54\n", back="X5. Y0. ", cut="X9.")
    in_first = simulated(machine, program, zero=zeros(machine))
    project = tmp_path / "p.toml"
    project.write_text(
        f'machine = "{machine}"\nstock = "{STOCK}"\ncell_mm = 1.0\ntools = ["1=flat:10,length=60"]\n'
        f'[[setup]]\nprograms = ["{program.name}"]\nwork_offset = "G54"\n'
        "zero_mm = { G54 = [0, 0, 60], G55 = [31, 7, 58.5] }\n",
        encoding="utf-8",
    )
    in_other = trunnion.simulate(project)
    assert [each.code for each in in_other.remarks if each.code == "SIM141"] == ["SIM141"]
    assert in_first.removed != pytest.approx(in_other.removed)
    assert not [each for each in in_first.remarks if each.code == "SIM141"]


def test_a_cut_in_an_offset_that_nobody_has_placed_is_an_error(tmp_path: Path) -> None:
    machine = "matsuura_mx330"
    program = by_hand(tmp_path, first="G54\n", second="G55\n", back="X5. Y0. ", cut="X9.")
    for zero, codes in (({"G54": FIRST}, ["SIM141"]), ({"G55": FIRST}, ["SIM141"]), (FIRST, []), (None, [])):
        found = simulated(machine, program, zero=zero)
        wrong = [each for each in found.remarks if each.code == "SIM141"]
        assert [each.code for each in wrong] == codes
        if wrong:
            assert not found.passed
            assert wrong[0].what == "cuts in G55, and nobody has stated where it is from G54, in which the stock stands"
            assert wrong[0].line == 15


@pytest.mark.parametrize(("offset", "first", "line"), [("no work offset", "", 7), ("G55", "G54\nG0 Z40.\nG55\n", 10)])
def test_a_rapid_in_an_offset_that_nobody_has_placed_is_not_judged(
    offset: str, first: str, line: int, tmp_path: Path
) -> None:
    """It leads through the stock if the offset's zero is that of the stock."""
    there = f"{first}G43 H1 G0 X5. Y0. Z20.\nZ-5.\nZ20.\nG49 G53 Z0.\nG54\n"
    program = by_hand(tmp_path, first=there, second="", back="X5. Y0. ", cut="X9.")
    found = simulated("matsuura_mx330", program, zero={"G54": FIRST}, tool_length=110.0)
    told = [each for each in found.remarks if each.wording.variant == "motion_elsewhere"]
    assert [(each.line, each.wording.parameter("offset")) for each in told] == [(line, offset)]
    assert "SIM146" in str([str(each) for each in found.not_judged])
    assert "rapid through stock" not in [each.kind for each in found.findings]
    if offset == "G55":
        stated = simulated("matsuura_mx330", program, zero={"G54": FIRST, "G55": FIRST}, tool_length=110.0)
        assert "rapid through stock" in [each.kind for each in stated.findings]


def test_slides_that_have_gone_to_the_machine_stay_where_they_are(tmp_path: Path) -> None:
    """Before an offset is selected, G53 says where they stand, whatever the offset."""
    program = by_hand(tmp_path, first="G53 G0 X0. Y0.\nG54\n", second="", back="X5. Y0. ", cut="X9.")
    found = simulated("matsuura_mx330", program, zero={"G54": FIRST}, tool_length=110.0)
    assert not [each for each in found.remarks if each.code in ("SIM141", "SIM146")]


@pytest.mark.parametrize("machine", ["yl569", "dmu65"])
def test_a_post_is_simulated_at_both_places(machine: str, tmp_path: Path) -> None:
    one, two = offsets(machine)
    cl = tmp_path / "two.cls"
    cl.write_text(operation("ONE") + operation("TWO"), encoding="utf-8")
    given = {"stock": STOCK, "tools": ["1=flat:10,length=60", "D10=flat:10,length=60"], "cell": 1.0}
    settings: Settings = {"work_offset": f"{one},TWO:{two}", "zero": zeros(machine)}
    result = trunnion.post(cl, machine=machine, output=tmp_path / "two.nc", settings=settings, simulation=given)
    assert result.simulation is not None
    wanted = simulated(machine, posted(machine, tmp_path, shifted=True), zero=FIRST)
    assert result.simulation.removed == pytest.approx(wanted.removed, rel=1e-9)


def test_each_tool_stands_with_its_own_length(tmp_path: Path) -> None:
    """Without TCP the slides follow from the length: of both tools it is that of the tool."""
    cl, program = tmp_path / "two.cls", tmp_path / "two.nc"
    leaning = operation("ONE") + operation("TWO").replace("LOAD/TOOL,1,ADJUST,1", "LOAD/TOOL,2,ADJUST,2")
    cl.write_text(leaning, encoding="utf-8")
    trunnion.post(cl, machine="matsuura_mx330", output=program)
    lengths = {"1": 110.0, "2": 85.0}
    run = trunnion.verify(program, machine="matsuura_mx330", zero=FIRST, tool_length=lengths).run
    assert [run.length_of(name) for name in ("1", "2")] == [110.0, 85.0]
    tools = ["1=flat:10,length=60", "2=flat:10,length=60"]
    for given, told in ((lengths, []), ({"1": 110.0}, [("tool 2",)])):
        found = trunnion.simulate(
            program, machine="matsuura_mx330", stock=STOCK, tools=tools, cell=2.0, zero=FIRST, tool_length=given
        )
        missing = [each.wording for each in found.remarks if each.wording.variant == "length_of_some_tools"]
        assert [each.parameter("names") for each in missing] == told
    view = prepare_view(program, machine="matsuura_mx330", zero=FIRST, tool_length=lengths)
    assert {each["name"]: each["length"] for each in view.scene["tools"] if each["name"]} == lengths
    column = run.machine.column("Z")
    z, rows = 1e-5 * view.columns[f"axis-{column}"][1:], view.columns["row"]
    assert np.allclose(z[np.searchsorted(rows, np.arange(len(run)), "right") - 1], run.joints[:, column], atol=1e-3)
    twin = twin_program(program, machine="matsuura_mx330", zero=FIRST, tool_length=lengths)
    slots = np.flatnonzero((run.tip[1:, 2] == -2.0) & (run.tip[:-1, 2] == -2.0)) + 1
    assert {run.tools[k] for k in run.tool[slots]} == {"1", "2"}
    seen = twin.at(0.5 * (twin.timed.begins + twin.timed.ends)[slots], np.full(len(slots), -1))
    assert np.allclose(seen.tip[:, 2], -2.0, atol=1e-3)


@pytest.mark.parametrize("with_lines", [True, False])
def test_a_recording_is_compared_at_both_places(with_lines: bool, tmp_path: Path) -> None:
    program = posted("yl569", tmp_path, shifted=False)
    twin = twin_program(program, machine="yl569", zero=zeros("yl569"), tool_length=110.0)
    recording = recorded(twin.timed, np.arange(0.0, twin.timed.duration, 0.05), with_lines=with_lines)

    def judged(zero: ZeroLike) -> Check:
        found = trunnion.verify(program, machine="yl569", zero=zero, tool_length=110.0, recorded=recording)
        return check(found, "recorded")

    assert judged(zeros("yl569")).passed
    at_one_place = judged(dict.fromkeys(zeros("yl569"), FIRST))
    assert not at_one_place.passed
    assert "(X+31.0000, Y+7.0000" in str(at_one_place)
