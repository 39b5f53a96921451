"""M114 as it is written: the same part as with M128 and without TCP, at points that lie as densely as without TCP."""

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.locations import GOLDEN
from tests.support.machines import five_axis_machines
from tests.support.reading import close
from trunnion.machines import load_machine
from trunnion.model.run import Run
from trunnion.readers import run_program

CAP = GOLDEN / "mikron_600u"
WAYS = {"on": "cap.expected.h", "m114": "cap_m114.expected.h", "off": "cap_without_tcp.expected.h"}
ZERO, LENGTH = (0.0, 0.0, 100.0), 100.0
PLACE: dict[str, tuple[float, float, float] | float] = {"zero": ZERO, "tool_length": LENGTH}


def read(name: str) -> Run:
    """A golden program on its machine, where it stands."""
    placed = replace(load_machine("mikron_600u"), workpiece_zero=(0.0, 0.0, 100.0), tool_length=100.0)
    return run_program(CAP / name, placed)


@pytest.mark.parametrize("one", WAYS)
@pytest.mark.parametrize("two", WAYS)
def test_seven_points_on_a_cap_are_the_same_three_ways(one: str, two: str) -> None:
    found = trunnion.diff(CAP / WAYS[one], CAP / WAYS[two], machine="mikron_600u")
    assert found.same, found.first


def test_the_axes_stand_at_the_same_places_at_all_seven() -> None:
    """Worked out by hand: B turns the normal upright about the crossing of the axes, 100 mm above the slides' zero."""
    normals = np.radians(np.arange(-90, 91, 30))
    places = []
    for name in WAYS.values():
        run = read(name)
        tips = 50.0 * np.stack([np.sin(normals), 0.0 * normals, np.cos(normals)], axis=1)
        at = [int(np.argmin(np.abs(run.tip - tip).max(axis=1) + (run.kind == 0))) for tip in tips]
        places.append(run.joints[at])
    for other in places[1:]:
        close(other, places[0], atol=1e-4)


def test_a_block_from_point_to_point_is_refused_by_proof_and_diff(tmp_path: Path) -> None:
    """M114 does not hold the tip between the ends of blocks: seven blocks alone leave the cap."""
    text = (CAP / WAYS["on"]).read_text(encoding="utf-8").replace("M128", "M114")
    seven = tmp_path / "seven.h"
    seven.write_text(re.sub(r"(?m)^35 M129$", "35 M115", text), encoding="utf-8")
    for zero, length in ((None, None), (ZERO, LENGTH)):
        proof = trunnion.verify(
            seven, machine="mikron_600u", cl=[CAP / "cap.cls"], span_tip=0.005, zero=zero, tool_length=length
        )
        assert [check.key for check in proof.checks if check.passed is False] == ["span"]
    with pytest.raises(trunnion.InputError, match="PLC340"):
        trunnion.diff(CAP / WAYS["on"], seven, machine="mikron_600u")
    found = trunnion.diff(CAP / WAYS["on"], seven, machine="mikron_600u", zero=ZERO, tool_length=LENGTH)
    assert not found.same
    assert "between points" in str(found.first)


def test_the_same_without_tcp_and_with_seven_blocks_is_another_path(tmp_path: Path) -> None:
    """What is true of M114 is true without TCP: the points between are what holds the tip."""
    text = (CAP / WAYS["off"]).read_text(encoding="utf-8")
    ends = set(range(-90, 91, 30))
    kept = [
        line
        for line in text.split("\n")
        if not (turn := re.search(r" B([-+][0-9.]+)", line)) or "R0" in line or float(turn[1]) in ends
    ]
    few = tmp_path / "few.h"
    few.write_text("\n".join(kept), encoding="utf-8")
    assert len(kept) < 60
    assert not trunnion.diff(CAP / WAYS["on"], few, machine="mikron_600u", path=True).same


def _spiral(folder: Path) -> Path:
    """Points on a cap of a ball, along a spiral about its top."""
    lines = ["TOOL PATH/S,TOOL,B10", "TLDATA/MILL,10.0,5.0,75.0,0.0,0.0", "MSYS/0,0,0,1,0,0,0,1,0"]
    lines += ["INTOL/0.01", "OUTTOL/0.01", "LOAD/TOOL,1", "SPINDL/RPM,3000,CLW", "RAPID"]
    for k in range(-1, 5):
        tilt, turn = math.radians(10.0 + 3.0 * max(k, 0)), math.radians(15.0 * max(k, 0))
        axis = (math.sin(tilt) * math.cos(turn), math.sin(tilt) * math.sin(turn), math.cos(tilt))
        place = ",".join(f"{(60.0 if k < 0 else 50.0) * each:.4f}" for each in axis)
        lines.append(f"GOTO/{place}," + ",".join(f"{each:.7f}" for each in axis))
        lines += ["FEDRAT/MMPM,500"] if k < 0 else []
    source = folder / "spiral.cls"
    source.write_text("\n".join([*lines, "END-OF-PATH"]) + "\n", encoding="utf-8")
    return source


@pytest.mark.parametrize("way", ["m114", "off"])
def test_points_between_that_only_one_of_two_programs_has_are_another_path(way: str, tmp_path: Path) -> None:
    """Both turn without holding the tip: where points lie less densely the tip leaves its line."""
    lines = (CAP / WAYS[way]).read_text(encoding="utf-8").splitlines()
    cuts = [number for number, line in enumerate(lines) if re.search(r"^\d+ L X.* B-", line)]
    thin = [line for number, line in enumerate(lines) if number not in cuts[1:12]]
    (tmp_path / "thin.h").write_text("\n".join(thin), encoding="utf-8")
    found = trunnion.diff(CAP / WAYS[way], tmp_path / "thin.h", machine="mikron_600u")
    assert not found.same
    assert "its tip leaves its line by" in str(found.first) or way == "off"


@pytest.mark.parametrize("name", five_axis_machines())
def test_each_shape_of_machine_goes_where_it_goes_without_tcp(name: str, tmp_path: Path) -> None:
    """Heads and tables, with the control of an iTNC 530: axis positions row by row, and the proof of both."""
    ours = tmp_path / "ours.toml"
    control = "" if name == "mikron_600u" else '[control]\nextends = "heidenhain_itnc530"\n'
    low = "".join(f'\n[[axis]]\nname = "{axis}"\nlimits_mm = [-9999, 9999]\n' for axis in ("X", "Y", "Z"))
    ours.write_text(f'schema = 1\nextends = "{name}"\nname = "Ours"\n{control}{low}', encoding="utf-8")
    source = _spiral(tmp_path)
    for tcp in ("m114", "off"):
        program = tmp_path / f"{tcp}.h"
        settings = {"tcp": tcp, "zero": (5.0, -7.0, 90.0), "tool_length": 150.0}
        done = trunnion.post(source, machine=ours, output=program, settings=settings)
        assert done.passed
    assert trunnion.diff(tmp_path / "m114.h", tmp_path / "off.h", machine=ours).same
    assert "M114" in (tmp_path / "m114.h").read_text(encoding="utf-8")


@pytest.mark.parametrize("machine", ["yl569", "dmu65", "hs664rt", "matsuura_mx330", "haas_umc750", "xyzac_trt"])
def test_controls_without_m114_say_what_to_write(machine: str) -> None:
    with pytest.raises(trunnion.InputError, match=r"tcp is m114, and .* has no M114; write on or off .*ARG250"):
        trunnion.post(CAP / "cap.cls", machine=machine, settings={"tcp": "m114", **PLACE})


def test_it_needs_a_zero_for_its_points_between() -> None:
    with pytest.raises(trunnion.InputError, match="PLN510"):
        trunnion.post(CAP / "cap.cls", machine="mikron_600u", settings={"tcp": "m114"})


def test_a_new_speed_in_a_cut_switches_it_off_before_tool_call(tmp_path: Path) -> None:
    source, program = tmp_path / "cap.cls", tmp_path / "cap.h"
    text = (CAP / "cap.cls").read_text(encoding="utf-8")
    source.write_text(text.replace("GOTO/0.0000,", "SPINDL/RPM,6000,CLW\nGOTO/0.0000,"), encoding="utf-8")
    done = trunnion.post(source, machine="mikron_600u", output=program, settings={"tcp": "m114", **PLACE})
    assert done.passed
    written = re.sub(r"(?m)^[0-9]+ ", "", program.read_text(encoding="utf-8"))
    assert "M115\nTOOL CALL Z S6000\nM114\nM3\n" in written


def test_conversion_keeps_the_ends_and_says_what_it_does_not(tmp_path: Path) -> None:
    back = tmp_path / "back.cls"
    converted = trunnion.convert(CAP / WAYS["m114"], machine="mikron_600u", to_cl=True, output=back)
    assert any("the tool turns without TCP to" in str(each) for each in converted.problems)
    done = trunnion.post(back, machine="mikron_600u", output=tmp_path / "again.h", settings={"tcp": "m114", **PLACE})
    assert done.passed
    assert trunnion.diff(CAP / WAYS["m114"], tmp_path / "again.h", machine="mikron_600u", path=True).same
