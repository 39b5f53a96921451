"""CL files that state how their part is clamped: posted, placed, verified, simulated and written again."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

import pytest

import trunnion
from trunnion.cl.writers import WRITERS
from trunnion.cli import main
from trunnion.errors import Problem
from trunnion.jobs.observer import Observer
from trunnion.model.clamping import Clamping
from trunnion.placing.program_heads import stated_place

SETTINGS: Final[Any] = {"zero": (10.0, -5.0, -60.0), "tool_length": 120.0}
POINTS = [(0, 0, 10, 0.62, 0.1), (5, 2, 9, 0.63, 0.12), (10, 4, 8, 0.65, 0.15), (15, 5, 8, 0.66, 0.2)]


class Heard(Observer):
    def __init__(self) -> None:
        self.codes: list[str] = []

    def problems(self, problems: Sequence[Problem]) -> None:
        self.codes += [each.code for each in problems]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """``five.cls``; ``q.mpf``, which is tilted by 20 and turned by 30 degrees; and ``c.cls``, made of that."""
    folder = tmp_path_factory.mktemp("stated")
    gotos = "".join(f"GOTO/{x},{y},{z},{i},{j},{(1 - i * i - j * j) ** 0.5:.9f}\n" for x, y, z, i, j in POINTS)
    (folder / "five.cls").write_text(
        "TOOL PATH/FIVE,TOOL,BALL8\nTLDATA/MILL,8.0,4.0,80.0,0.0,0.0\n"
        "MSYS/0.0,0.0,0.0,1.0,0.0,0.0,0.0,1.0,0.0\nPAINT/PATH\nLOAD/TOOL,2,ADJUST,2\nSPINDL/RPM,3000,CLW\n"
        f"RAPID\nGOTO/0,0,60,0.62,0.1,{(1 - 0.62**2 - 0.01) ** 0.5:.9f}\nFEDRAT/MMPM,500.0\n{gotos}END-OF-PATH\n",
        "utf-8",
    )
    trunnion.post(
        folder / "five.cls", machine="yl569", output=folder / "q.mpf", turn=30.0, tilt=20.0, settings=SETTINGS
    )
    trunnion.convert(folder / "q.mpf", machine="yl569", to_cl=True, output=folder / "c.cls")
    return folder


def test_a_post_states_what_the_cl_file_states_and_the_turn_behind_it(folder: Path, tmp_path: Path) -> None:
    assert trunnion.read_cl(folder / "c.cls").clamping == Clamping(30.0, 20.0)
    plain, turned = tmp_path / "plain.mpf", tmp_path / "turned.mpf"
    trunnion.post(folder / "c.cls", machine="yl569", output=plain, settings=SETTINGS)
    assert stated_place(plain) == stated_place(folder / "q.mpf")
    result = trunnion.post(folder / "c.cls", machine="yl569", output=turned, turn=15.0, settings=SETTINGS)
    assert stated_place(turned).clamping == Clamping(45.0, 20.0)
    assert [path.clamping for path in result.toolpaths] == [Clamping(45.0, 20.0)]
    cases: list[tuple[str, dict[str, Any], list[str]]] = [
        ("c.cls", {"turn": 15.0}, []),
        ("five.cls", {"turn": 45.0, "tilt": 20.0}, []),
        ("c.cls", {}, ["PLC220"]),
    ]
    for cl, angles, codes in cases:
        heard = Heard()
        found = trunnion.verify(turned, machine="yl569", cl=folder / cl, observer=heard, tolerance=0.002, **angles)
        assert [code for code in heard.codes if code.startswith("PLC")] == codes
        assert found.passed is not bool(codes)
        assert found.clamping is not None


def test_a_tilt_behind_a_turn_is_refused(folder: Path) -> None:
    with pytest.raises(trunnion.InputError, match="a tilt of 5 degrees behind a turn is no tilt"):
        trunnion.post(folder / "c.cls", machine="yl569", tilt=5.0)
    with pytest.raises(trunnion.InputError, match="PLC320"):
        trunnion.verify(folder / "q.mpf", machine="yl569", cl=folder / "c.cls", tilt=5.0)
    with pytest.raises(trunnion.InputError, match="PLC320"):
        trunnion.place(folder / "c.cls", machine="yl569", tilts=[5.0], turns=[0.0])
    with pytest.raises(trunnion.InputError, match="PLC310"):
        trunnion.post([folder / "five.cls", folder / "c.cls"], machine="yl569")
    with pytest.raises(trunnion.InputError, match="PLC310"):
        trunnion.post([folder / "c.cls", folder / "five.cls"], machine="yl569")


@pytest.mark.parametrize("name", ["c.cls", "q.mpf"])
def test_a_place_is_told_against_the_drawing(
    folder: Path, tmp_path: Path, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    out, data = tmp_path / "placed.mpf", tmp_path / "placed.json"
    apply = ["--apply", str(out)] if name == "c.cls" else []
    turn = "10" if apply else "0"
    file = str(folder / name)
    command = ["place", file, "--machine", "yl569", "--tool-length", "120", "--turn", turn, *apply]
    assert main([*command, "--json", str(data)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[1].startswith("  the part is tilted by 20 degrees about X and turned by 30 degrees about Z already")
    assert lines[2].startswith("  first a fixture angle of 20 degrees")
    assert lines[3].startswith(f"  then turn the part by {30 + int(turn)} degrees")
    assert json.loads(data.read_text("utf-8"))["clamped"] == {"turn_deg": 30.0 + int(turn), "tilt_deg": 20.0}
    if apply:
        assert stated_place(out).clamping == Clamping(40.0, 20.0)


@pytest.mark.parametrize("dialect", WRITERS)
def test_a_cl_file_of_any_dialect_carries_the_clamping(folder: Path, tmp_path: Path, dialect: str) -> None:
    other = tmp_path / "other.cl"
    trunnion.convert(folder / "c.cls", to_cl=True, to_dialect=dialect, output=other)
    assert trunnion.read_cl(other).clamping == Clamping(30.0, 20.0)


def test_a_damaged_notice_of_a_cl_file_is_told_and_one_behind_the_first_point_is_none(
    folder: Path, tmp_path: Path
) -> None:
    text, other = (folder / "c.cls").read_text("utf-8"), tmp_path / "other.cls"
    other.write_text(text.replace("COUNTER-CLOCKWISE", "CLOCKWISE"), "utf-8")
    found = trunnion.read_cl(other)
    assert found.clamping is None
    assert [(each.code, each.line) for each in found.remarks if each.code == "PLC250"] == [("PLC250", 2)]
    plain = (folder / "five.cls").read_text("utf-8")
    notice = "PART TURNED 45 DEG ABOUT Z, COUNTER-CLOCKWISE SEEN FROM ABOVE, FROM +Z"
    other.write_text(plain.replace("END-OF-PATH", f"$$ {notice}\nPPRINT/{notice}\nEND-OF-PATH"), "utf-8")
    assert trunnion.read_cl(other).clamping is None


def test_a_text_of_an_operation_is_no_notice(folder: Path, tmp_path: Path) -> None:
    cl, program, back = tmp_path / "text.cls", tmp_path / "text.mpf", tmp_path / "back.cls"
    notice = "PART TURNED 45 DEG ABOUT Z, COUNTER-CLOCKWISE SEEN FROM ABOVE, FROM +Z"
    plain = (folder / "five.cls").read_text("utf-8")
    for place in ("LOAD/TOOL", "RAPID"):
        cl.write_text(plain.replace(place, f"PPRINT/{notice}\n{place}", 1), "utf-8")
        trunnion.post(cl, machine="yl569", output=program)
        assert notice in program.read_text("utf-8")
        assert stated_place(program).clamping is None
        trunnion.convert(program, machine="yl569", to_cl=True, output=back)
        assert f"PPRINT/{notice}" in back.read_text("utf-8")
        assert f"$$ {notice}" not in back.read_text("utf-8")


def test_a_simulation_turns_the_bodies_as_the_program_says_and_the_cl_file_by_the_rest(
    folder: Path, tmp_path: Path
) -> None:
    bodies: dict[str, Any] = {"stock": "box:40,20,3,-10,-5,6", "tools": ["2=ball:8,length=80,flutes=70"], "cell": 1.0}
    drawn = trunnion.post(
        folder / "five.cls", machine="yl569", turn=45.0, tilt=20.0, settings=SETTINGS, simulation=bodies, force=True
    ).simulation
    stated = trunnion.post(
        folder / "c.cls", machine="yl569", turn=15.0, settings=SETTINGS, simulation=bodies, force=True
    ).simulation
    assert drawn is not None
    assert stated is not None
    assert (stated.turn, stated.tilt) == (45.0, 20.0)
    assert drawn.removed > 50.0
    assert stated.removed == pytest.approx(drawn.removed, rel=1e-3)
    project = tmp_path / "part.toml"
    project.write_text(
        '[simulation]\nmachine = "yl569"\nstock = "box:40,20,3,-10,-5,6"\nprograms = ["q.mpf"]\n'
        'tools = ["2=ball:8,length=80,flutes=70"]\nturn_deg = -315\ntilt_deg = 20\ncell_mm = 1\n'
    )
    again = trunnion.post(
        folder / "c.cls", machine="yl569", turn=15.0, settings=SETTINGS, simulation={"project": project}, force=True
    )
    assert again.simulation is not None
    assert again.simulation.removed == pytest.approx(drawn.removed, rel=1e-3)  # -315 degrees are 45
    with pytest.raises(trunnion.InputError, match="SIM113"):
        trunnion.post(folder / "c.cls", machine="yl569", settings=SETTINGS, simulation={"project": project}, force=True)


def test_angles_count_in_thousandths(folder: Path, tmp_path: Path) -> None:
    program, heard = tmp_path / "fine.mpf", Heard()
    angles: dict[str, Any] = {"turn": 45.12345, "tilt": 20.00049}
    trunnion.post(folder / "five.cls", machine="yl569", output=program, **angles)
    assert stated_place(program).clamping == Clamping(45.123, 20.0)
    for told in (angles, {"turn": 45.123, "tilt": 20.0}):
        found = trunnion.verify(program, machine="yl569", cl=folder / "five.cls", observer=heard, **told)
        assert found.passed
    assert "PLC220" not in heard.codes


def test_papers_have_the_angles(folder: Path, tmp_path: Path) -> None:
    program = tmp_path / "out.mpf"
    trunnion.post(
        folder / "c.cls", machine="yl569", output=program, turn=15.0, settings=SETTINGS,
        manifest=tmp_path / "m.json", sheet=tmp_path / "s.json", report=tmp_path / "r.json",
    )  # fmt: skip
    for name in ("m", "s", "r"):
        data = json.loads((tmp_path / f"{name}.json").read_text("utf-8"))
        assert (data["turn_deg"], data["tilt_deg"]) == (45.0, 20.0)
    alone = trunnion.verify(program, machine="yl569")
    assert alone.clamping == Clamping(45.0, 20.0)
    trunnion.write_report(alone, tmp_path / "v.html")
    assert "tilted by 20 degrees about X and turned by 45 degrees about Z" in (tmp_path / "v.html").read_text("utf-8")


def test_zero_and_damage_are_told_without_cl_files(folder: Path, tmp_path: Path) -> None:
    heard = Heard()
    trunnion.verify(folder / "q.mpf", machine="yl569", zero=(0.0, 0.0, -60.0), tool_length=120.0, observer=heard)
    assert "PLC240" in heard.codes
    bad = tmp_path / "bad.mpf"
    bad.write_text((folder / "q.mpf").read_text("utf-8").replace("SIDE UP", "SIDE DOWN"), "utf-8")
    heard = Heard()
    trunnion.verify(bad, machine="yl569", observer=heard)
    assert "PLC250" in heard.codes
    heard = Heard()
    back = trunnion.convert(bad, machine="yl569", to_cl=True, observer=heard)
    assert "PLC250" in heard.codes
    assert back.text is not None
    assert "$$ PART T" not in back.text
    placed = trunnion.place(bad, machine="yl569", turns=[0.0], tool_length=120.0)
    assert "PLC250" in [each.code for each in placed.remarks]


def test_a_view_with_bodies_warns(folder: Path, tmp_path: Path) -> None:
    for file in ("q.mpf", "c.cls"):
        heard, plain = Heard(), Heard()
        trunnion.write_view(folder / file, machine="yl569", output=tmp_path / "v.html", observer=plain)
        assert "PAG116" not in plain.codes
        body: dict[str, Any] = {"stock": "box:40,20,3,-10,-5,6", "tools": ["2=ball:8,length=80,flutes=70"], "cell": 4.0}
        trunnion.write_view(folder / file, machine="yl569", output=tmp_path / "v.html", observer=heard, **body)
        assert "PAG116" in heard.codes


def test_a_program_that_moves_nothing_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for text, codes in (("", ("NC112", "NC112")), ("N10 G71\nN20 M30\n", ("SIM148", "NC185"))):
        program = tmp_path / "still.mpf"
        program.write_text(text, "utf-8")
        body = ["--stock", "box:10,10,10", "--tool", "1=ball:8,length=50"]
        assert main(["simulate", str(program), "--machine", "yl569", *body]) == (1 if text else 2)
        assert codes[0] in capsys.readouterr().err
        main(["verify", str(program), "--machine", "yl569"])
        assert codes[1] in capsys.readouterr().err


def test_a_work_offset_of_the_program_asks_for_the_zero(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program = tmp_path / "offset.ngc"
    program.write_text("G21 G90\nG10 L2 P1 X10 Y-5 Z-60\nG54\nG0 X0 Y0 Z5\nM2\n", "utf-8")
    for machine in ("linuxcnc_5axis", "matsuura_mx330"):
        main(["verify", str(program), "--machine", machine])
        out = capsys.readouterr().out
        assert "G10 L2 P1 writes the work offset, and nobody said where the workpiece zero is" in out
        main(["verify", str(program), "--machine", machine, "--zero=10,-5,-60", "--tool-length", "100"])
        assert "NC352" not in capsys.readouterr().out


def test_a_project_whose_zero_does_not_count_says_so(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "five.cls").write_bytes((folder / "five.cls").read_bytes())
    project = tmp_path / "part.toml"
    project.write_text(
        'machine = "yl569"\ncl = ["five.cls"]\noutput = "a.mpf"\nzero_mm = [10, -5, -60]\ntool_length_mm = 120\n'
        "turn_deg = 30\ntilt_deg = 20\n"
    )
    assert main(["place", str(project), "--turn", "0"]) == 0
    printed = capsys.readouterr()
    assert "present zero" not in printed.out
    assert "its zero is that of the part tilted by 20 degrees about X and turned by 30 degrees" in printed.err
