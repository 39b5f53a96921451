"""Habits of shops as settings of the machine's definition: what they change, and that the proof holds them."""

from pathlib import Path

import pytest

import trunnion

_OPERATION = """TOOL PATH/OP{number},TOOL,D{diameter}
TLDATA/MILL,{diameter}.0000,0.0000,75.0000,0.0000,0.0000
MSYS/0.0,0.0,0.0,1.0,0.0,0.0,0.0,1.0,0.0
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,{number},ADJUST,{number}
SPINDL/RPM,3000,CLW
RAPID
GOTO/0.0,0.0,50.0,0.0,0.0,1.0
FEDRAT/MMPM,500.0
GOTO/0.0,0.0,-1.0
CUTCOM/LEFT
GOTO/10.0,0.0,-1.0
GOTO/20.0,0.0,-1.0
CUTCOM/OFF
GOTO/20.0,20.0,-1.0
RAPID
GOTO/20.0,20.0,50.0
SPINDL/OFF
END-OF-PATH
"""


def _machine(folder: Path, base: str, text: str) -> Path:
    file = folder / "shop.toml"
    file.write_text(f'schema = 1\nextends = "{base}"\nname = "Shop"\n{text}', encoding="utf-8")
    return file


def _source(folder: Path) -> Path:
    source = folder / "part.cls"
    text = _OPERATION.format(number=1, diameter=10) + _OPERATION.format(number=2, diameter=8)
    source.write_text(text, encoding="utf-8")
    return source


def _failing(program: Path, machine: Path, source: Path) -> dict[str, str]:
    checks = trunnion.verify(program, machine=machine, cl=source).checks
    return {check.key: check.summary for check in checks if check.state == "FAIL"}


# What must be at home

#: The way home of a shop that leaves X and Y where they are.
_Z_ONLY = """
[control.templates]
operation_end_three_axis = '''
G49 G53 G0 Z{home_z:coordinate}
G53 G0 {primary}{primary_home:angle} {secondary}{secondary_home:angle}
M5
'''
"""


@pytest.mark.parametrize("base", ["matsuura_mx330", "haas_umc750"])
def test_x_and_y_may_stand_anywhere_where_the_machine_says_so(base: str, tmp_path: Path) -> None:
    source, output = _source(tmp_path), tmp_path / "part.nc"
    with pytest.raises(trunnion.RefusedError, match="while the linear axes are not at home"):
        trunnion.post(source, machine=_machine(tmp_path, base, _Z_ONLY), output=output)
    proof = '[proof]\nhome_at_tool_change = ["Z"]\nhome_at_end = ["Z"]\n'
    machine = _machine(tmp_path, base, proof + _Z_ONLY)
    assert trunnion.post(source, machine=machine, output=output).passed
    lines = output.read_text(encoding="utf-8").splitlines()
    first, *between, last = (k for k, line in enumerate(lines) if "G53 G0 Z0." in line)
    for lost in (between, [last]):
        edited = tmp_path / "edited.nc"
        kept = [line for k, line in enumerate(lines) if k not in lost]
        edited.write_text("\n".join(kept) + "\n", encoding="utf-8")
        assert "home" in _failing(edited, machine, source), lines[lost[0]]
    assert first < between[0]


def test_at_the_end_more_may_be_asked_for_than_at_a_tool_change(tmp_path: Path) -> None:
    machine = _machine(tmp_path, "matsuura_mx330", '[proof]\nhome_at_tool_change = ["Z"]\n' + _Z_ONLY)
    with pytest.raises(trunnion.RefusedError, match=r"ends in line \d+ while the linear axes are not at home"):
        trunnion.post(_source(tmp_path), machine=machine)


@pytest.mark.parametrize("value", ['["Q"]', '["U"]', '"Z"'])
def test_only_axes_of_the_machine_can_be_named(value: str, tmp_path: Path) -> None:
    with pytest.raises(trunnion.InputError, match="home_at_end"):
        trunnion.post(_source(tmp_path), machine=_machine(tmp_path, "yl569", f"[proof]\nhome_at_end = {value}\n"))


# The register of the radius


@pytest.mark.parametrize("base", ["matsuura_mx330", "haas_umc750"])
def test_the_register_of_the_radius_is_the_tool_and_what_the_machine_adds(base: str, tmp_path: Path) -> None:
    source, output = _source(tmp_path), tmp_path / "part.nc"
    machine = _machine(tmp_path, base, '[control.settings]\nradius_offset = "30"\n')
    assert trunnion.post(source, machine=machine, output=output).passed
    text = output.read_text(encoding="utf-8")
    assert "G41 D31" in text
    assert "G41 D32" in text
    assert _failing(output, machine, source) == {}
    output.write_text(text.replace("D31", "D1"), encoding="utf-8")
    assert "compensation" in _failing(output, machine, source)


@pytest.mark.parametrize("base", ["matsuura_mx330", "haas_umc750"])
def test_two_tools_do_not_share_a_register_of_the_radius(base: str, tmp_path: Path) -> None:
    source = _source(tmp_path)
    names = [operation.name for operation in trunnion.read_cl(source).operations]
    machine = _machine(tmp_path, base, "")
    with pytest.raises(trunnion.TrunnionError, match="has its radius in D2, as tool 1 has"):
        trunnion.post(source, machine=machine, settings={"radius_offset": f"{names[0]}:1"})
    told = trunnion.post(source, machine=machine, settings={"radius_offset": "1"})
    assert told.passed
    assert [each for each in told.problems if each.code == "CTL710"]
    for apart in ("0", "100"):
        found = trunnion.post(source, machine=machine, settings={"radius_offset": apart})
        assert not [each for each in found.problems if each.code == "CTL710"]


# The method


@pytest.mark.parametrize("base", ["dmu65", "xyzac_trt"])
def test_without_a_method_no_line_has_a_placeholder(base: str, tmp_path: Path) -> None:
    result = trunnion.post(_source(tmp_path), machine=base)
    assert result.passed
    assert "METHOD" not in (result.text or "")


def _sinumerik(folder: Path, settings: str = "") -> Path:
    """The YL569 without what its published programs have of their own."""
    return _machine(folder, "yl569", f'[control.settings]\nmethod = ""\nthree_axis_tolerance = ""\n{settings}')


def test_a_sinumerik_displays_a_method_only_where_one_is_set(tmp_path: Path) -> None:
    without = trunnion.post(_source(tmp_path), machine=_sinumerik(tmp_path)).text or ""
    assert "MSG(" not in without
    assert "TECHNOLOGY" not in without
    assert 'MSG("METHOD")' in (trunnion.post(_source(tmp_path), machine="yl569").text or "")


# The tolerance of three-axis operations on a Sinumerik


def test_the_tolerance_of_three_axes_is_that_of_the_operation(tmp_path: Path) -> None:
    machine = _sinumerik(tmp_path)
    assert "CYCLE832(0.02, _ORI" in (trunnion.post(_source(tmp_path), machine=machine).text or "")
    given = trunnion.post(_source(tmp_path), machine=machine, settings={"three_axis_tolerance": "0.005"})
    assert "CYCLE832(0.005, _ORI" in (given.text or "")
    assert "CYCLE832(0.01, _ORI" in (trunnion.post(_source(tmp_path), machine="yl569").text or "")


# The cutting edge


def test_adjust_is_the_cutting_edge_where_the_machine_says_so(tmp_path: Path) -> None:
    source, output = _source(tmp_path), tmp_path / "part.mpf"
    source.write_text(source.read_text(encoding="utf-8").replace("2,ADJUST,2", "2,ADJUST,5"), encoding="utf-8")
    machine = _sinumerik(tmp_path, 'edge_from = "adjust"\n')
    result = trunnion.post(source, machine=machine, output=output)
    assert result.passed
    assert "CTL715" not in [problem.code for problem in result.problems]
    text = output.read_text(encoding="utf-8")
    lines = text.splitlines()
    change = next(k for k, line in enumerate(lines) if line.endswith("T=2"))
    edges = [[line.split()[-1] for line in part if "SUPA G0 X" in line] for part in (lines[:change], lines[change:])]
    assert edges == [["D1"] * 4, ["D5"] * 2]  # up to the change the edge is that of the tool that is in the spindle
    assert _failing(output, machine, source) == {}
    for lost in ("D5", "S3000 D1"):
        output.write_text(text.replace(lost, "D2"), encoding="utf-8")
        assert "tool" in _failing(output, machine, source)


def test_adjust_beyond_the_highest_edge_leaves_the_setting(tmp_path: Path) -> None:
    source = _source(tmp_path)
    source.write_text(source.read_text(encoding="utf-8").replace("2,ADJUST,2", "2,ADJUST,15"), encoding="utf-8")
    result = trunnion.post(source, machine=_sinumerik(tmp_path, 'edge_from = "adjust"\n'))
    assert result.passed
    assert "D15" not in (result.text or "")
    assert "CTL715" in [problem.code for problem in result.problems]


# An optional stop between operations

_MACHINES = ("yl569", "dmu65", "matsuura_mx330", "haas_umc750", "hs664rt", "xyzac_trt")


@pytest.mark.parametrize("base", _MACHINES)
def test_an_optional_stop_between_operations_is_a_template_of_two_lines(base: str, tmp_path: Path) -> None:
    text = "[control.templates]\nbefore_operation = '''\n{% if operation.number > 1 %}\nM1\n{% endif %}\n'''\n"
    source, output = _source(tmp_path), tmp_path / "part.nc"
    machine = _machine(tmp_path, base, text)
    assert trunnion.post(source, machine=machine, output=output).passed
    run = trunnion.read_program(output, machine=machine)
    (stop,) = (event for event in run.events if event.kind == "optional_stop")
    assert 0 < stop.before_row < len(run)
    assert run.spindle[stop.before_row - 1] == 0 or run.machine_frame[stop.before_row - 1]


@pytest.mark.parametrize("base", _MACHINES)
def test_the_setting_writes_the_stop_and_the_proof_misses_it(base: str, tmp_path: Path) -> None:
    source, output = _source(tmp_path), tmp_path / "part.nc"
    machine = _machine(tmp_path, base, '[control.settings]\nstop_between = "on"\n')
    assert trunnion.post(source, machine=machine, output=output).passed
    lines = output.read_text(encoding="utf-8").splitlines()
    (stop,) = (k for k, line in enumerate(lines) if line.split()[-1:] == ["M1"])
    output.write_text("\n".join(lines[:stop] + lines[stop + 1 :]) + "\n", encoding="utf-8")
    assert "stops" in _failing(output, machine, source)


# The number of the program


@pytest.mark.parametrize(
    ("base", "name", "line"),
    [
        ("matsuura_mx330", "O1234.nc", "O1234"),
        ("haas_umc750", "part 01234.nc", "O01234"),
        ("dmu65", "BLADE.h", "0 BEGIN PGM BLADE MM"),
    ],
)
def test_the_number_of_the_program_is_that_of_its_file(base: str, name: str, line: str, tmp_path: Path) -> None:
    machine = _machine(tmp_path, base, '[control.settings]\nprogram_from = "file"\n')
    result = trunnion.post(_source(tmp_path), machine=machine, output=tmp_path / name)
    assert result.passed
    assert line in (tmp_path / name).read_text(encoding="utf-8").splitlines()


@pytest.mark.parametrize("name", ["part.nc", "12 of 34.nc", "O123456789.nc", ""])
def test_a_file_without_one_number_is_refused(name: str, tmp_path: Path) -> None:
    output = tmp_path / name if name else None
    with pytest.raises(trunnion.InputError, match="program_from is file"):
        trunnion.post(_source(tmp_path), machine="matsuura_mx330", output=output, settings={"program_from": "file"})


# Units


@pytest.mark.parametrize(
    ("units", "settings", "said"),
    [("INCHES", {}, True), ("INCHES", {"units": "mm"}, False), ("INCHES", {"units": "inch"}, False), ("MM", {}, False)],
)
def test_a_cl_file_in_other_units_than_the_program_is_reported(
    units: str, settings: dict[str, str], said: bool, tmp_path: Path
) -> None:
    source = _source(tmp_path)
    small = source.read_text(encoding="utf-8").replace("50.0", "5.0").replace("20.0", "2.0")
    source.write_text(f"UNITS/{units}\n{small}", encoding="utf-8")
    result = trunnion.post(source, machine="matsuura_mx330", settings=settings)
    assert ("CL415" in [problem.code for problem in result.problems]) is said


# The first approach


@pytest.mark.parametrize("base", _MACHINES)
def test_the_first_approach_goes_one_group_of_axes_at_a_time(base: str, tmp_path: Path) -> None:
    source, output = _source(tmp_path), tmp_path / "part.nc"
    machine = _machine(tmp_path, base, "[control]\nlevel_approach = true\n")
    assert trunnion.post(source, machine=machine, output=output).passed
    run = trunnion.read_program(output, machine=machine)
    axes = {"rotary": 8 | 16, "level": 1 | 2, "height": 4}
    first = next(k for k in range(len(run)) if not run.machine_frame[k] and run.programmed[k] & axes["level"])
    moved = [{name for name, bits in axes.items() if run.programmed[k] & bits} for k in (first, first + 1)]
    assert moved == [{"level"}, {"height"}]
