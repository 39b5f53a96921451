"""What an aborted run may have left on is off before an operation moves at the workpiece."""

from pathlib import Path

import pytest

import trunnion
from trunnion.controls import load_control
from trunnion.machines import load_machine
from trunnion.output.families.sinumerik import writer as sinumerik

OPERATION = """TOOL PATH/{name},TOOL,EM
TLDATA/MILL,10,0,80,0,0
LOAD/TOOL,1
SPINDL/RPM,3000,CLW
RAPID
GOTO/20,0,60,{axis}
{cycle}FEDRAT/MMPM,500
GOTO/20,0,50,{axis}
CYCLE/OFF
RAPID
GOTO/20,0,90,{axis}
END-OF-PATH
"""

CYCLE = "CYCLE/DRILL,RAPTO,3,FEDTO,-5,MMPM,100\n"


def operation(name: str, axis: str, cycle: str = "") -> str:
    return OPERATION.format(name=name, axis=axis, cycle=cycle).replace("" if cycle else "CYCLE/OFF\n", "")


FLAT, TILTED = operation("FLAT", "0,0,1"), operation("TILTED", "0,-0.5,0.8660254", CYCLE)
TURNING = operation("TURNING", "0,0,1").replace("GOTO/20,0,90,0,0,1", "GOTO/20,0,90,0,-0.1,0.9949874")
TURNING = TURNING.replace("RAPID\nGOTO/20,0,90", "GOTO/20,0,90")


def posted(folder: Path, machine: str, operations: str, **settings: str) -> list[str]:
    cl = folder / "part.cls"
    cl.write_text("UNITS/MM\n" + operations)
    result = trunnion.post(cl, machine=machine, settings={"numbers": "off", **settings})
    assert result.passed
    return (result.text or "").splitlines()


@pytest.mark.parametrize(("settings", "tcp_off"), [({}, "M129"), ({"tcpm": "function"}, "FUNCTION RESET TCPM")])
def test_a_heidenhain_switches_everything_off_at_every_operation(
    settings: dict[str, str], tcp_off: str, tmp_path: Path
) -> None:
    lines = posted(tmp_path, "dmu65", FLAT + TILTED, **settings)
    for begin in (lines.index("* - FLAT"), lines.index("* - TILTED")):
        first = next(k for k in range(begin, len(lines)) if lines[k].startswith("L "))
        assert lines[first - 3 : first] == [tcp_off, "PLANE RESET STAY", "M137"]


@pytest.mark.parametrize(
    ("operations", "settings", "off"),
    [
        (FLAT, {}, []),
        (FLAT + TILTED, {}, ["CYCLE800()"]),
        (FLAT + TILTED, {"plane": "frames"}, ["TRANS"]),
        (FLAT, {"safe_start": "all"}, ["CYCLE800()", "TOROTOF", "TRANS"]),
    ],
    ids=["no plane", "swivel", "frames", "all"],
)
def test_a_sinumerik_cancels_planes_at_every_operation(
    operations: str, settings: dict[str, str], off: list[str], tmp_path: Path
) -> None:
    lines = posted(tmp_path, "yl569", operations, **settings)
    begins = [k for k, line in enumerate(lines) if line.startswith(";Operation")]
    for begin in begins:
        home = lines.index("SUPA G0 Z=_Z_HOME D0", begin)
        assert lines[home + 1 : home + 1 + len(off)] == off
        assert lines[home + 1 + len(off)].startswith("SUPA G0 X=_X_HOME")


@pytest.mark.parametrize(
    ("operations", "settings", "off"),
    [(FLAT, {}, []), (FLAT + TURNING, {}, ["G197"]), (FLAT, {"safe_start": "all"}, ["G197", "G69"])],
    ids=["no TCP", "TCP", "all"],
)
def test_a_fidia_switches_tcp_off_at_every_operation(
    operations: str, settings: dict[str, str], off: list[str], tmp_path: Path
) -> None:
    lines = posted(tmp_path, "hs664rt", operations, **settings)
    begins = [k for k, line in enumerate(lines) if line == "M242" and "G01 A0. C0. F3000" in lines[k + 1 : k + 3]]
    assert begins
    for begin in begins:
        assert (lines[begin + 1] == "G55 O1") == (settings.get("safe_start") == "all")
        assert [line for line in lines[begin - 2 : begin] if line in ("G197", "G69")] == off


def test_a_tool_frame_of_holes_is_cancelled() -> None:
    settings = dict(load_control(load_machine("yl569").control.unread_copy()).settings)
    values = sinumerik.template_values({**settings, "holes": "torot", "tcp_used": "on"}, None)
    assert [values["cancel_swivel"], values["cancel_tool_frame"], values["cancel_frames"]] == [None, "TOROTOF", "TRANS"]


@pytest.mark.parametrize(
    ("machine", "offsets", "late"),
    [
        ("yl569", "G54,FLAT:G55", "TRAFOOF\n{work_offset}"),
        ("matsuura_mx330", "G54,FLAT:G55", "{contour_on}\n{work_offset}"),
        ("haas_umc750", "G54,FLAT:G55", "{work_offset}\n{smoothing}"),
        ("xyzac_trt", "G54,FLAT:G55", "{work_offset}\nG43 H{length_number}"),
        ("hs664rt", "G55 O1,FLAT:G55 O2", ""),
        ("dmu65", "1,FLAT:2", ""),
    ],
    ids=["sinumerik", "fanuc", "haas", "linuxcnc", "fidia", "heidenhain"],
)
def test_rotary_axes_turn_in_the_offset_of_their_operation(
    machine: str, offsets: str, late: str, tmp_path: Path
) -> None:
    program = tmp_path / "program.nc"
    program.write_text(
        "\n".join(posted(tmp_path, machine, TILTED + FLAT, work_offset=offsets)) + "\n", encoding="utf-8"
    )
    found = trunnion.verify(program, machine=machine, cl=tmp_path / "part.cls", work_offset=offsets)
    assert found.passed
    alone = trunnion.verify(program, machine=machine, cl=tmp_path / "part.cls", work_offset=offsets.split(",")[0])
    assert [check.key for check in alone.checks if not check.passed] == ["offset"]
    with pytest.raises(trunnion.InputError, match="the program has none of that name"):
        trunnion.verify(program, machine=machine, cl=tmp_path / "part.cls", work_offset=offsets.replace("FLAT", "F"))
    if late:
        file = tmp_path / "late.toml"
        template = f"approach_three_axis = '''\nG0 {{primary_word}} {{secondary_word}}\n{late}\n'''"
        file.write_text(f'extends = "{machine}"\n[control.templates]\n{template}\n', encoding="utf-8")
        with pytest.raises(trunnion.RefusedError, match="turns in G54 for motion in G55"):
            posted(tmp_path, str(file), TILTED + FLAT, work_offset=offsets)


@pytest.mark.parametrize("machine", ["yl569", "matsuura_mx330", "haas_umc750", "xyzac_trt"])
def test_a_program_that_can_be_entered_states_its_modes_at_every_operation(machine: str, tmp_path: Path) -> None:
    lines = posted(tmp_path, machine, FLAT + TILTED, restart="on")
    assert len([line for line in lines if {"G94", "G90", "G17", "G40"} <= set(line.split())]) == 3
    assert (
        len([line for line in lines if "G94" in line])
        - len([line for line in posted(tmp_path, machine, FLAT + TILTED) if "G94" in line])
        == 2
    )
