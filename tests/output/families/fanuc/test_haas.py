"""Programs for a Haas: its own words for TCP, planes, dwells and offsets, written and proven."""

import re
from pathlib import Path

import pytest

import trunnion
from tests.support.fanuc import POINTLESS
from tests.support.locations import GOLDEN
from tests.support.posting import CLEAR
from trunnion.controls import load_control
from trunnion.errors import InputError

MACHINE = "haas_umc750"
#: All but the cycles of a Sinumerik, some of which a Haas does not have, and the roller: its B turns not that far.
_OTHERS = ("yl569_cycles", "four_axis")
SAMPLES = sorted(
    path.relative_to(GOLDEN).as_posix() for path in GOLDEN.rglob("*.cls") if path.parent.name not in _OTHERS
)


@pytest.mark.third
@pytest.mark.parametrize("name", SAMPLES)
def test_every_sample_is_posted_and_proven(name: str) -> None:
    posted = trunnion.post(GOLDEN / name, machine=MACHINE)
    assert posted.passed
    blocks = [line for line in (posted.text or "").splitlines() if line.startswith("N")]
    assert not [line for line in blocks if POINTLESS.search(line)], "every length, angle and feed has a point"
    assert not [line for line in blocks if len(re.findall(r"M\d", line)) > 1], "one M word a block"
    assert not [line for line in blocks if re.search(r" G(43\.4|68\.2|53\.1|86|87|88|5\.1|52|92)\b", line)]
    plane = tcp = False
    for line in blocks:
        plane = "G254" in line or (plane and "G255" not in line)
        tcp = "G234" in line or (tcp and "G49" not in line)
        assert not (plane and tcp), "G254 and G234 exclude each other"
        assert not (plane and re.search(r" [BC]-?[\d.]", line)), "G255 comes before rotary axes turn"
        assert not (("G234" in line or "G43" in line) and " H" not in line)
    assert not plane
    assert not tcp


@pytest.mark.parametrize(
    ("good", "bad"),
    [
        ("G255", ""),
        ("G254", ""),
        ("G43 H3", "H3"),
        (" P.2 ", " P200 "),
        ("G154 P3", "G154 P4"),
        ("F750.", "F750"),
    ],
)
def test_faults_are_found(good: str, bad: str, tmp_path: Path) -> None:
    text = (GOLDEN / "haas" / "flange.expected.nc").read_text()
    assert good in text
    (tmp_path / "part.nc").write_text(text.replace(good, bad, 1))
    cl = GOLDEN / "fanuc" / "flange.cls"
    assert trunnion.verify(GOLDEN / "haas" / "flange.expected.nc", machine=MACHINE, cl=cl, work_offset="G154 P3").passed
    assert not trunnion.verify(tmp_path / "part.nc", machine=MACHINE, cl=cl, work_offset="G154 P3").passed


@pytest.mark.parametrize(("good", "bad"), [("G234 H2", "G43 H2"), ("G49\n", "\n"), ("B59.186", "B-59.186")])
def test_faults_of_tcp_are_found(good: str, bad: str, tmp_path: Path) -> None:
    text = (GOLDEN / "haas" / "blade.expected.nc").read_text()
    assert good in text
    head, found, tail = text.rpartition(good)
    (tmp_path / "part.nc").write_text(head + bad + tail if found else text)
    cl = GOLDEN / "yl569" / "3_blade_finish.cls"
    assert not trunnion.verify(tmp_path / "part.nc", machine=MACHINE, cl=cl).passed


@pytest.mark.parametrize("coolant", ["THRU", "MIST"])
def test_coolants_that_the_control_has_otherwise_are_refused(coolant: str, tmp_path: Path) -> None:
    text = (GOLDEN / "fanuc" / "flange.cls").read_text().replace("COOLNT/FLOOD", f"COOLNT/{coolant}")
    (tmp_path / "part.cls").write_text(text)
    with pytest.raises(InputError, match=f"has no coolant {coolant}"):
        trunnion.post(tmp_path / "part.cls", machine=MACHINE)


@pytest.mark.parametrize(
    "setting", ["orientation=vector", "plane=g68_2", "smoothing=G187 P4", "tcp_on=G43.4", "work_offset=G54.1 P3"]
)
def test_what_only_a_fanuc_has_is_refused(setting: str) -> None:
    key, _, value = setting.partition("=")
    with pytest.raises(trunnion.TrunnionError):
        trunnion.post(GOLDEN / "yl569" / "3_blade_finish.cls", machine=MACHINE, settings={key: value})


@pytest.mark.parametrize(
    ("setting", "said"),
    [
        ("contour=G05.1", r"it has no effect on Haas NGC, for no template of its definition has \{contour_on\}"),
        ("contour=G05", "it has no effect on Haas NGC"),
        ("work_offset=G154 P100", "write G54 to G59, or G154 P1 to P99"),
        ("work_offset=G154 P0", "write G54 to G59, or G154 P1 to P99"),
    ],
)
def test_settings_that_would_do_nothing_or_are_not_there_are_refused(setting: str, said: str) -> None:
    key, _, value = setting.partition("=")
    with pytest.raises(InputError, match=said):
        trunnion.post(GOLDEN / "yl569" / "3_blade_finish.cls", machine=MACHINE, settings={key: value})


def test_a_setting_without_effect_is_not_offered() -> None:
    assert "contour" not in {setting.name for setting in trunnion.describe_control("haas_ngc").settings}


def test_the_work_offset_is_selected_before_the_rotary_axes_turn_in_it() -> None:
    for name in ("flange", "blade"):
        blocks = (GOLDEN / "haas" / f"{name}.expected.nc").read_text().splitlines()
        changes = [k for k, block in enumerate(blocks) if " M6" in block]
        assert changes
        for k in changes:
            assert re.search(r" G54$| G154 P3$", blocks[k + 1])
            assert re.search(r" G0 B.* C", blocks[k + 2])


def test_a_cut_as_the_first_motion_in_a_plane_is_refused_with_its_line(tmp_path: Path) -> None:
    head = CLEAR[: CLEAR.index("RAPID\n")]
    cuts = "FEDRAT/MMPM,500.0\nGOTO/0,0,50,0.5,0,0.8660254037844386\nGOTO/10,0,5\nGOTO/20,3,5\nEND-OF-PATH\n"
    cl = tmp_path / "part.cls"
    cl.write_text(head + cuts)
    with pytest.raises(trunnion.TrunnionError, match="a cut is the first motion in a tilted plane") as caught:
        trunnion.post(cl, machine=MACHINE)
    assert f"part.cls:{head.count(chr(10)) + 2}" in str(caught.value)
    assert "put RAPID before the first GOTO" in str(caught.value)
    cl.write_text(head + cuts.replace("GOTO/0,0,50", "RAPID\nGOTO/0,0,50", 1))
    assert trunnion.post(cl, machine=MACHINE).passed


def test_subprograms_have_five_digits(tmp_path: Path) -> None:
    cl, target = GOLDEN / "yl569" / "3_blade_finish.cls", tmp_path / "blade.nc"
    posted = trunnion.post(cl, machine=MACHINE, output=target, settings={"programs": "operations"})
    assert posted.passed
    assert (tmp_path / "O01001.nc").read_text().startswith("%\nO01001")


def test_a_definition_may_take_a_coolant_away(tmp_path: Path) -> None:
    assert "MIST" not in load_control(trunnion.load_machine(MACHINE).control).coolant
    (tmp_path / "ours.toml").write_text(f'extends = "{MACHINE}"\n[control.coolant]\nMIST = 83\nON = "nothing"\n')
    with pytest.raises(InputError, match=r"coolant\.ON"):
        load_control(trunnion.load_machine(tmp_path / "ours.toml").control)


@pytest.mark.parametrize("name", ["flange", "blade"])
def test_a_program_converted_to_its_own_machine_says_the_same(name: str) -> None:
    program = GOLDEN / "haas" / f"{name}.expected.nc"
    before = program.read_text()
    after = trunnion.convert(program, machine=MACHINE, to_machine=MACHINE).text or ""
    for word in ("G254", "G234", "G154 P3", "G187 P3", "G84", "M6"):
        assert (word in before) == (word in after)
    cuts = [[line for line in text.splitlines() if " B" in line and "F" not in line] for text in (before, after)]
    assert name == "flange" or cuts[0] == cuts[1]


def test_a_fanuc_program_with_planes_becomes_one_of_this_control() -> None:
    program = GOLDEN / "fanuc" / "flange.expected.nc"
    text = trunnion.convert(program, machine="matsuura_mx330", to_machine=MACHINE).text or ""
    assert "G254" in text
    assert "G84" in text
    assert not re.search(r"M29|G68\.2|G53\.1|G54\.1|G0?5\.1", text)


def test_the_spindle_turns_again_after_a_thread_before_the_next_cut(tmp_path: Path) -> None:
    holes = "CYCLE/{0}\nGOTO/0,0,0,0,0,1\nGOTO/15,0,0\nCYCLE/OFF\nRAPID\nGOTO/15,0,50\n"
    thread, drill = holes.format("TAP,RAPTO,3,FEDTO,-12,MMPR,1.25"), holes.format("DRILL,RAPTO,3,FEDTO,-12,MMPM,90")
    for then, restarts in (("", 0), (thread, 1), (drill, 1), (thread + drill, 2), (drill + thread, 1)):
        (tmp_path / "part.cls").write_text(CLEAR + thread + then + "END-OF-PATH\n")
        posted = trunnion.post(tmp_path / "part.cls", machine=MACHINE)
        assert posted.passed
        blocks = re.sub(r"N\d+ ", "", posted.text or "")
        assert blocks.count("S4000 M3\n") == 1 + restarts, blocks
        assert blocks.count("G80\nS4000 M3\n") == restarts
        fanuc = trunnion.post(tmp_path / "part.cls", machine="matsuura_mx330").text or ""
        assert len(re.findall(r"S4000 M3", fanuc)) == 1


@pytest.mark.parametrize(("one", "two"), [("G54.1 P3", "G154 P3"), ("G54.1 P99", "G154 P99"), ("G59", "G59")])
def test_extended_work_offsets_go_from_a_fanuc_to_this_control_and_back(one: str, two: str, tmp_path: Path) -> None:
    cl, folder = GOLDEN / "yl569" / "3_blade_finish.cls", tmp_path
    fanuc = trunnion.post(cl, machine="matsuura_mx330", settings={"work_offset": one}, output=folder / "fanuc.nc")
    assert fanuc.passed
    there = trunnion.convert(folder / "fanuc.nc", machine="matsuura_mx330", to_machine=MACHINE, output=folder / "h.nc")
    assert there.settings["work_offset"] == two
    assert f" {two}\n" in (folder / "h.nc").read_text()
    back = trunnion.convert(folder / "h.nc", machine=MACHINE, to_machine="matsuura_mx330")
    assert back.settings["work_offset"] == one
    assert f" {one}\n" in (back.text or "")


@pytest.mark.parametrize(
    ("source", "offset", "target"),
    [
        ("matsuura_mx330", "G54.1 P100", MACHINE),
        ("matsuura_mx330", "G54.1 P3", "yl569"),
        (MACHINE, "G154 P3", "xyzac_trt"),
        (MACHINE, "G154 P3", "dmu65"),
        ("yl569", "G505", "matsuura_mx330"),
        ("yl569", "G55", "dmu65"),
        ("dmu65", "3", "yl569"),
    ],
)
def test_a_work_offset_that_the_other_control_lacks_is_refused(
    source: str, offset: str, target: str, tmp_path: Path
) -> None:
    cl, program = GOLDEN / "yl569" / "3_blade_finish.cls", tmp_path / "one"
    assert trunnion.post(cl, machine=source, settings={"work_offset": offset}, output=program).passed
    with pytest.raises(trunnion.RefusedError, match=f"the work offset is {re.escape(offset)}, which"):
        trunnion.convert(program, machine=source, to_machine=target)
    own = {"dmu65": "2"}.get(target, "G55")
    assert trunnion.convert(program, machine=source, to_machine=target, settings={"work_offset": own}).settings
