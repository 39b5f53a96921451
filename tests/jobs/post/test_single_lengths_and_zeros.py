"""A length for each tool, and a zero for each work offset: in the planner, in the proof, and in ``verify``."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import trunnion
from trunnion.jobs.inputs.stated_setup import set_up_machine
from trunnion.machines import Machine, load_machine, slide_positions
from trunnion.readers import reader_of
from trunnion.verification import Check, Verification

#: A machine of each family of controls.
MACHINES = ("yl569", "dmu65", "hs664rt", "matsuura_mx330", "haas_umc750", "xyzac_trt")

HEAD = "MSYS/0,0,0,1,0,0,0,1,0\nINTOL/0.01\nOUTTOL/0.01\n"
WAY = (
    "SPINDL/RPM,4000,CLW\nRAPID\nGOTO/0.0,0.0,20.0,0.0,0.0,1.0\nFEDRAT/MMPM,500.0\nGOTO/10.0,0.0,5.0\n"
    "RAPID\nGOTO/10.0,0.0,20.0\nEND-OF-PATH\n"
)
TWO_TOOLS = "".join(
    f"TOOL PATH/{name},TOOL,D10\nTLDATA/MILL,10.0,0.0,75.0,0.0,0.0\n{HEAD}LOAD/TOOL,{number},ADJUST,{number}\n{WAY}"
    for number, name in ((1, "ROUGH"), (2, "FINISH"))
)


@pytest.fixture(scope="module")
def two_tools(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("two_tools") / "two.cls"
    file.write_text(TWO_TOOLS)
    return file


def limited(machine: str) -> Machine:
    """A machine whose linear axes have limits: the definition of one states none."""
    loaded = load_machine(machine)
    axes = [
        axis if axis.is_rotary or axis.has_limits else replace(axis, low=-300.0, high=300.0) for axis in loaded.axes
    ]
    return replace(loaded, axes=tuple(axes))


def near_low_end(machine: str) -> tuple[float, float, float]:
    """A zero with which Z of a tool of 110 mm stays 10 mm above its low limit."""
    loaded = limited(machine)
    placed = replace(loaded, workpiece_zero=(0.0, 0.0, 0.0), tool_length=110.0)
    z = float(slide_positions(placed, np.array([[0.0, 0.0, 5.0]]), np.zeros((1, 2)))[0, loaded.column("Z")])
    middle = [0.5 * (loaded.axis(name).low + loaded.axis(name).high) for name in "XY"]
    at = slide_positions(placed, np.zeros((1, 3)), np.zeros((1, 2)))[0]
    x, y = (want - float(at[loaded.column(name)]) for name, want in zip("XY", middle, strict=True))
    return x, y, loaded.axis("Z").low + 10.0 - z


def offsets(machine: str) -> tuple[str, str]:
    """Two work offsets as the setting has them."""
    words = reader_of(load_machine(machine)).work_offsets
    found = [words.setting(value) for value in range(1, 1200) if words.value_of(words.setting(value)) == value]
    return found[0], found[1]


def travel(found: Verification) -> Check:
    return next(check for check in found.checks if check.key == "travel")


def posted(cl: Path, machine: str, out: Path, **settings: object) -> trunnion.PostResult:
    given: Mapping[str, object] = {"tool_length": {"1": 110.0, "2": 110.0}, **settings}
    return trunnion.post(cl, machine=limited(machine), output=out, settings=given)  # type: ignore[arg-type]


@pytest.mark.third
@pytest.mark.parametrize("machine", MACHINES)
def test_the_travel_of_a_tool_is_that_with_its_own_length(two_tools: Path, tmp_path: Path, machine: str) -> None:
    zero, out = near_low_end(machine), tmp_path / "two.nc"
    assert posted(two_tools, machine, out, zero=zero).passed
    with pytest.raises(trunnion.RefusedError, match=r"Z would go to \S+ with tool 2 of 85 mm, below its limit"):
        posted(two_tools, machine, tmp_path / "other.nc", zero=zero, tool_length={"1": 110.0, "2": 85.0})
    found = travel(trunnion.verify(out, machine=limited(machine), zero=zero, tool_length="1=110,2=85"))
    assert not found.passed
    assert " with tool 2 of 85 mm, its limit is" in found.summary
    unknown = travel(trunnion.verify(out, machine=limited(machine), zero=zero, tool_length={"1": 110.0}))
    assert "no tool length stated for tool 2" in [wording.what for wording in unknown.missing]


@pytest.mark.third
@pytest.mark.parametrize("machine", MACHINES)
def test_the_travel_in_a_work_offset_is_that_with_its_own_zero(two_tools: Path, tmp_path: Path, machine: str) -> None:
    one, two = offsets(machine)
    zero, out = near_low_end(machine), tmp_path / "two.nc"
    far, selected = (zero[0] + 3000.0, *zero[1:]), f"{one},FINISH:{two}"
    assert posted(two_tools, machine, out, zero={one: zero, two: zero}, work_offset=selected).passed
    with pytest.raises(trunnion.RefusedError, match=rf"X would go to \S+ with .*the zero of {two}, "):
        posted(two_tools, machine, tmp_path / "other.nc", zero={one: zero, two: far}, work_offset=selected)
    found = travel(trunnion.verify(out, machine=limited(machine), zero={one: zero, two: far}, tool_length=110))
    assert not found.passed
    assert f" in {reader_of(load_machine(machine)).work_offsets.name(_value(machine, two))}, its limit" in found.summary
    unknown = travel(trunnion.verify(out, machine=limited(machine), zero={one: zero}, tool_length=110))
    assert any(wording.what.startswith("no workpiece zero stated for") for wording in unknown.missing)
    assert unknown.passed
    assert unknown.coverage is not None
    assert unknown.coverage.checked < unknown.coverage.motions


@pytest.mark.third
@pytest.mark.parametrize("machine", MACHINES)
def test_work_offsets_that_are_swapped_fail_with_the_cl_file_and_are_not_checked_without(
    two_tools: Path, tmp_path: Path, machine: str
) -> None:
    one, two = offsets(machine)
    right, swapped = tmp_path / "right.nc", tmp_path / "swapped.nc"
    asked = f"{one},FINISH:{two}"
    posted(two_tools, machine, right, work_offset=asked)
    posted(two_tools, machine, swapped, work_offset=f"{two},FINISH:{one}")
    assert right.read_text() != swapped.read_text()
    zero = {one: (0.0, 0.0, 60.0), two: (5.0, 0.0, 60.0)}
    for program, state in ((right, "ok"), (swapped, "FAIL")):
        with_cl = trunnion.verify(program, machine=machine, cl=two_tools, work_offset=asked, zero=zero)
        alone = trunnion.verify(program, machine=machine, zero=zero)
        assert [each.state for each in with_cl.checks if each.key == "offset"] == [state]
        offset = next(each for each in alone.checks if each.key == "offset")
        assert offset.state == "not checked"
        names = [reader_of(load_machine(machine)).work_offsets.name(_value(machine, each)) for each in (one, two)]
        assert [str(each) for each in offset.missing] == [
            f"no CL file says which of {', '.join(names)} a cut is to be in"
        ]
    assert not trunnion.verify(swapped, machine=machine, cl=two_tools, zero=zero).passed  # one offset is the default


def _value(machine: str, offset: str) -> int:
    value = reader_of(load_machine(machine)).work_offsets.value_of(offset)
    assert value is not None
    return value


@pytest.mark.parametrize("machine", ["matsuura_mx330", "haas_umc750", "xyzac_trt"])
def test_the_length_of_another_tool_is_found_where_both_are_stated(
    two_tools: Path, tmp_path: Path, machine: str
) -> None:
    out = tmp_path / "two.nc"
    posted(two_tools, machine, out)
    wrong = tmp_path / "wrong.nc"
    wrong.write_text(out.read_text().replace("H2", "H1"))
    for lengths, words in (({"1": 110.0, "2": 85.0}, False), ({"1": 110.0, "2": 110.0}, True)):
        found = trunnion.verify(wrong, machine=machine, tool_length=lengths)
        told = [place.text for check in found.checks for place in check.places if place.code == "NC361"]
        assert bool(told) is not words, told
        assert not told or told[0].startswith("H1 counts 110 mm, and tool 2 in the spindle is 85 mm long")


def test_an_offset_that_is_another_ones_moves_the_tip_without_tcp(tmp_path: Path) -> None:
    """Positions of the slides of a tilted table hold for one zero alone."""
    cl = tmp_path / "leaning.cls"
    cl.write_text(TWO_TOOLS.replace("GOTO/10.0,0.0,5.0\n", "GOTO/10.0,0.0,5.0,0.0,0.5,0.8660254\n"))
    zeros = {"G54": (0.0, 0.0, 60.0), "G55": (0.0, 20.0, 60.0)}
    out = tmp_path / "out.nc"
    result = posted(cl, "matsuura_mx330", out, zero=zeros, work_offset="G54,FINISH:G55", tcp="off")
    assert result.passed
    wrong = tmp_path / "wrong.nc"
    wrong.write_text(out.read_text().replace("G55", "G54"))
    checks = {}
    for program in (out, wrong):
        found = trunnion.verify(program, machine="matsuura_mx330", cl=cl, zero=zeros, tool_length=110)
        checks[program] = {check.key: check.passed for check in found.checks}
    assert checks[out]["tip"]
    assert not checks[wrong]["tip"]


def test_a_length_of_the_cl_file_is_used_and_named(tmp_path: Path) -> None:
    cl = tmp_path / "part.aptsource"
    cl.write_text(
        "$$ CATIA APTSOURCE\nPARTNO PART\nUNITS/MM\nMULTAX\nCUTTER/10.0\nLOADTL/3,LENGTH,85.0\n"
        "SPINDL/1000,RPM,CLW\nRAPID\nGOTO/0,0,20,0,0,1\nFEDRAT/500,MMPM\nGOTO/10,0,5,0,0,1\nRAPID\nGOTO/10,0,20,0,0,1\nFINI\n"
    )
    zero, out = near_low_end("matsuura_mx330"), tmp_path / "part.nc"
    given: dict[str, str | tuple[float, float, float]] = {"zero": zero, "dialect": "catia"}
    with pytest.raises(trunnion.RefusedError, match=r"with tool 3 of 85 mm \(CL file\), below its limit"):
        trunnion.post(cl, machine="matsuura_mx330", output=out, settings=given)
    assert trunnion.post(cl, machine="matsuura_mx330", output=out, settings={**given, "tool_length": "110"}).passed
    found = travel(trunnion.verify(out, machine="matsuura_mx330", cl=cl, dialect="catia", zero=zero))
    assert " with tool 3 of 85 mm (CL file), its limit is" in found.summary


def test_a_length_of_a_tool_library_is_used_and_named(two_tools: Path, tmp_path: Path) -> None:
    zero, out, library = near_low_end("dmu65"), tmp_path / "two.h", tmp_path / "tools.toml"
    posted(two_tools, "dmu65", out, zero=zero)
    library.write_text(
        "".join(
            f'[[tool]]\nnumber = {number}\nkind = "flat"\ndiameter_mm = 10\nlength_mm = 60\n'
            f"flute_length_mm = 20\ngauge_length_mm = {gauge}\n"
            for number, gauge in ((1, 110), (2, 85))
        )
    )
    found = travel(trunnion.verify(out, machine="dmu65", zero=zero, tool_libraries=[library]))
    assert f" with tool 2 of 85 mm ({library}), its limit is" in found.summary


def test_g43_1_takes_the_place_of_the_length(tmp_path: Path) -> None:
    program = tmp_path / "part.ngc"
    program.write_text("G21 G90 G17 G40 G49\nT1 M6\nG54\nG0 X0 Y0 S1000 M3\nG43.1 Z50\nG0 Z20\nG1 Z5 F500\nM2\n")
    run = trunnion.read_program(program, machine=set_up_machine(load_machine("xyzac_trt"), (0, 0, 0), None))
    long = trunnion.read_program(program, machine=set_up_machine(load_machine("xyzac_trt"), (0, 0, 0), 50.0))
    z = run.machine.column("Z")
    assert run.joints[-1, z] == pytest.approx(long.joints[-1, z])
    assert run.tip[-1, 2] == pytest.approx(5.0)
    assert not run.errors
    other = trunnion.read_program(program, machine=set_up_machine(load_machine("xyzac_trt"), (0, 0, 0), 110.0))
    assert [each.code for each in other.errors] == ["NC361"]


@pytest.mark.parametrize(
    ("name", "value", "told"),
    [
        ("zero", "G54=0,0", "write X,Y,Z"),
        ("zero", "G99=0,0,0", "write G54"),
        ("tool_length", "1=long", "write MM"),
        ("tool_length", {"1": "long"}, "write MM"),
    ],
)
def test_a_value_that_cannot_be_is_told(two_tools: Path, name: str, value: object, told: str) -> None:
    with pytest.raises(trunnion.InputError, match=told):
        trunnion.verify(two_tools, machine="matsuura_mx330", **{name: value})  # type: ignore[arg-type]


ZEROS = {"G54": (0.0, 0.0, 0.0), "G55": (9.0, 0.0, 0.0)}


def test_points_are_reached_with_the_tool_of_their_operation(two_tools: Path) -> None:
    machine = limited("generic_head_head_ca")
    short, long = 100.0, 250.0
    for lengths in ({"1": short, "2": long}, {"1": long, "2": short}, {"D10": short}):
        found = trunnion.reach(machine, cl=two_tools, zero=(0, 0, 5), tool_length=lengths, step=45)
        assert found.machine.tool_length == max(lengths.values())
        told = [each.what for each in found.remarks if each.code == "RCH140"]
        assert told == [
            f"tilts, volumes and the part are judged with the longest tool, {max(lengths.values()):g} mm; points of CL "
            "files each with their own"
        ]
    each = {
        length: trunnion.reach(machine, cl=two_tools, zero=zero, tool_length=length, step=45).paths[0].no_travel
        for zero in [(0.0, 0.0, 400.0)]
        for length in (short, long)
    }
    both = trunnion.reach(machine, cl=two_tools, zero=(0, 0, 400), tool_length={"1": short, "2": long}, step=45)
    assert each[short] != each[long]
    assert both.paths[0].no_travel == sum(each.values()) // 2
    only = trunnion.reach(machine, tool_length={"1": short, "2": long}, step=45)
    assert only.machine.tool_length == long


def test_a_length_that_is_missing_and_zeros_of_offsets_are_told(two_tools: Path) -> None:
    machine = limited("generic_head_head_ca")
    with pytest.raises(trunnion.InputError, match="no CL file says in which of them its points are; write one zero"):
        trunnion.reach(machine, cl=two_tools, zero=ZEROS, step=45)
    with pytest.raises(trunnion.InputError, match="one place of the part is looked for"):
        trunnion.place(two_tools, machine=machine, zero=ZEROS, turns=[0.0])
    cl = two_tools.with_name("unknown.cls")
    cl.write_text(TWO_TOOLS.replace("TLDATA/MILL,10.0,0.0,75.0,0.0,0.0", "TLDATA/MILL,10.0,0.0,0.0,0.0,0.0"))
    lengths = {"1": 100.0}
    for command in (
        lambda: trunnion.reach(machine, cl=cl, tool_length=lengths, step=45),
        lambda: trunnion.place(cl, machine=machine, tool_length=lengths, turns=[0.0]),
        lambda: trunnion.fit(cl, machines=[machine], tool_length=lengths, turns=[0.0]),
    ):
        with pytest.raises(trunnion.InputError, match="has no length of tool 2, and the files that are read state"):
            command()


def test_place_and_fit_take_the_length_of_each_tool(two_tools: Path) -> None:
    machine = limited("generic_head_head_ca")
    lengths = {"1": 100.0, "2": 250.0}
    found = trunnion.place(two_tools, machine=machine, tool_length=lengths, turns=[0.0])
    assert not [each for each in found.remarks if each.code == "PLC210"]
    one = trunnion.place(two_tools, machine=machine, tool_length=100.0, turns=[0.0])
    other = trunnion.place(two_tools, machine=machine, tool_length=250.0, turns=[0.0])
    ranges = [{each.axis: (each.least_mm, each.greatest_mm) for each in placed.best.axes}["Z"]
              for placed in (found, one, other) if placed.best is not None]  # fmt: skip
    spans = [high - low for low, high in ranges]
    assert spans[0] == pytest.approx(spans[1] + 150.0)
    assert spans[1] == pytest.approx(spans[2])
    posted = trunnion.post_placed(found, machine=machine)
    assert posted.passed
    assert posted.run is not None
    assert [posted.run.length_of(name) for name in ("1", "2")] == [100.0, 250.0]
    (fits,) = trunnion.fit(two_tools, machines=[machine], tool_length=lengths, turns=[0.0])
    assert str(fits.status) == "fits"
    left = {each.axis: each.margin for each in fits.margins}
    assert left["Z"] == pytest.approx(min(each.margin_mm for each in found.best.axes if each.axis == "Z"))  # type: ignore[union-attr]


def test_a_project_states_them_in_tables(two_tools: Path, tmp_path: Path) -> None:
    (tmp_path / "two.cls").write_text(two_tools.read_text())
    project = tmp_path / "part.toml"
    project.write_text(
        'machine = "matsuura_mx330"\n[[setup]]\nname = "ONE"\ncl = ["two.cls"]\noutput = "one.nc"\n'
        "zero_mm = { G54 = [0, 0, 10], G55 = [5, 0, 10] }\ntool_length_mm = { 1 = 110, 2 = 85 }\n"
        'settings = { work_offset = "G54,FINISH:G55" }\n'
    )
    with pytest.raises(trunnion.RefusedError, match="with tool 2 of 85 mm and the zero of G55"):
        trunnion.post_project(project)


def test_without_tcp_a_head_needs_a_length_for_each_tool(tmp_path: Path) -> None:
    cl = tmp_path / "leaning.cls"
    cl.write_text(TWO_TOOLS.replace("GOTO/10.0,0.0,5.0\n", "GOTO/10.0,0.0,5.0,0.0,0.5,0.8660254\n"))
    given = {"zero": "0,0,0", "tcp": "off", "limit_margin": "0.5"}
    for length, told in (("110", "PLN530"), ("110,3=85", "PLN530"), ("1=110,2=110", "")):
        try:
            trunnion.post(cl, machine="generic_head_head_ca", output=tmp_path / "a.mpf",
                          settings={**given, "tool_length": length}, force=True)  # fmt: skip
            codes = []
        except trunnion.InputError as error:
            codes = [problem.code for problem in error.problems]
        assert (told in codes) if told else not codes, (length, codes)
