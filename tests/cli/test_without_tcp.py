"""Programs without TCP through the command line: what is asked for, what is refused, and what the proof finds."""

import math
from collections.abc import Callable
from pathlib import Path

import pytest

from trunnion.cli import main

CL = """TOOL PATH/OP1,TOOL,D10
TLDATA/MILL,10.0000,5.0000,75.0000,0.0000,0.0000
MSYS/0.0000,0.0000,0.0000,1.0000000,0.0000000,0.0000000,0.0000000,1.0000000,0.0000000
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,1,ADJUST,1
SPINDL/RPM,4000.0000,CLW
RAPID
GOTO/0.0,0.0,50.0,0.0,0.0871557427,0.9961946981
FEDRAT/MMPM,500.0
GOTO/10.0,0.0,5.0
GOTO/20.0,5.0,5.0,0.2588190451,0.0,0.9659258263
GOTO/30.0,5.0,5.0,0.2588190451,0.0,0.9659258263
RAPID
GOTO/30.0,-50.0,50.0,0.2588190451,-0.1,0.9607000000
END-OF-PATH
"""
TABLE = "yl569", "zero=0,0,50"
HEAD = "generic_head_head_ca", "zero=0,0,-300"


class Shop:
    """Posts and verifies one CL file, in one folder."""

    def __init__(self, folder: Path, capfd: pytest.CaptureFixture[str]) -> None:
        self.cl, self.program = folder / "part.cls", folder / "part.mpf"
        self._capfd = capfd

    def post(self, text: str, machine: str, *settings: str) -> tuple[int, str]:
        """Exit code and stderr."""
        self.cl.write_text(text, encoding="utf-8")
        said = [word for setting in settings for word in ("--set", setting)]
        code = main(["post", str(self.cl), "--machine", machine, "--output", str(self.program), *said])
        return code, self._capfd.readouterr().err.replace(str(self.cl), "part.cls")

    def verify(self, *arguments: str) -> tuple[int, dict[str, str]]:
        """Exit code, and the line of each check."""
        code = main(["verify", str(self.program), "--cl", str(self.cl), "--span", "0.05", *arguments])
        lines = self._capfd.readouterr().out.splitlines()
        return code, {line.split()[0]: line for line in lines if line.split()[1:2] in (["ok"], ["FAIL"])}

    @property
    def lines(self) -> list[str]:
        """Lines of the program without block numbers."""
        return [line.partition(" ")[2] for line in self.program.read_text(encoding="utf-8").splitlines()]


@pytest.fixture
def shop(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> Shop:
    return Shop(tmp_path, capfd)


def test_a_program_holds_slides_inverse_time_and_what_it_was_made_for(shop: Shop) -> None:
    code, err = shop.post(CL, HEAD[0], HEAD[1], "tool_length=120", "tcp=off")
    assert code == 0, err
    assert "more on the way between them" in err
    lines = shop.lines
    assert "TRAORI" not in lines
    assert ";WITHOUT TCP, FOR A WORKPIECE ZERO AT X0.000000 Y0.000000 Z-300.000000 OF THE MACHINE" in lines
    assert ";AND A TOOL LENGTH OF 120.000000" in lines
    first = next(k for k, line in enumerate(lines) if line.startswith("G0 X"))
    assert lines[first].endswith("S4000 D1 M3")
    # Y = (250 + 120) sin 5, Z = 50 + 370 (cos 5 - 1): the fork leans by -5 about X
    assert "X0.0 Y32.24762 Z48.59204" in lines[first]
    assert lines[first + 2] == "G1 X10. Z3.59204 F500."  # nothing turns: mm/min
    turning = [line for line in lines if line.startswith("G93") or (" A" in line and " F" in line)]
    assert len(turning) > 20
    after = lines[lines.index(turning[-1]) + 1]
    assert after.startswith("G94 X")
    assert after.endswith("F500.")


def test_every_block_with_inverse_time_says_its_own(shop: Shop) -> None:
    assert shop.post(CL, *TABLE, "tcp=off")[0] == 0
    lines = shop.lines
    begin, end = (next(k for k, line in enumerate(lines) if line.startswith(word)) for word in ("G93", "G94 X"))
    assert all(" F" in line for line in lines[begin:end] if not line.startswith(";"))


def test_a_rotary_axis_goes_past_zero_by_the_shorter_way(shop: Shop) -> None:
    assert shop.post(CL, *TABLE, "tcp=off")[0] == 0
    assert sum("C=DC(35" in line for line in shop.lines) == 1


REFUSED: dict[str, tuple[tuple[str, ...], str, str]] = {
    "no workpiece zero": (("yl569", "tcp=off"), "", "--zero X,Y,Z"),
    "no tool length": ((*HEAD, "tcp=off"), "", "--tool-length MM"),
    "two tools": (
        (*HEAD, "tcp=off", "tool_length=120"),
        CL + CL.replace("OP1", "OP2").replace("TOOL,1", "TOOL,2").replace("D10", "D8"),
        "post one program for each tool",
    ),
    "radius compensation": ((*TABLE, "tcp=off"), CL.replace("FEDRAT", "CUTCOM/LEFT\nFEDRAT"), "without CUTCOM"),
    "feed per revolution": ((*TABLE, "tcp=off"), CL.replace("MMPM,500.0", "MMPR,0.1"), "FEDRAT/MMPM"),
    "a block of hours": ((*TABLE, "tcp=off"), CL.replace("500.0", "0.0001"), "points nearer to each other"),
    "neither on nor off": ((*TABLE, "tcp=perhaps"), "", "write tcp=on or tcp=off"),
    "no tolerance": ((*TABLE, "tcp=off", "tip_tolerance=0"), "", "write tip_tolerance=MM"),
    "no axis tolerance": ((*TABLE, "axis_tolerance=nan"), "", "write axis_tolerance=DEGREES"),
    "no length": ((*TABLE, "tool_length=long"), "", "write tool_length=MM"),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_not_known_or_cannot_be_said_is_refused_with_its_cure(name: str, shop: Shop) -> None:
    settings, text, cure = REFUSED[name]
    code, err = shop.post(text or CL, *settings)
    assert code == 2
    assert "error" in err
    assert cure in err
    assert not shop.program.exists()


def test_a_control_that_has_no_tcp_gets_programs_without(shop: Shop, tmp_path: Path) -> None:
    own = tmp_path / "plain.toml"
    own.write_text('extends = "yl569"\n[control]\nextends = "sinumerik_840d"\ntcp = false\n', encoding="utf-8")
    assert shop.post(CL, str(own))[0] == 2
    assert shop.post(CL, str(own), TABLE[1])[0] == 0
    assert "TRAORI" not in shop.lines
    code, err = shop.post(CL, str(own), TABLE[1], "tcp=on")
    assert (code, "the machine's control has none" in err) == (2, True)


def test_a_rewind_without_tcp_is_followed_by_the_slides(shop: Shop, tmp_path: Path) -> None:
    """The table's C with limits has to wind back in the cut."""
    own = tmp_path / "narrow.toml"
    text = 'extends = "generic_head_table_bc"\n[[axis]]\nname = "C"\nendless = false\nlimits_deg = [-190, 190]\n'
    own.write_text(text + '[[axis]]\nname = "B"\nlimits_deg = [-5, 110]\n', encoding="utf-8")
    angles = [math.radians(4.0 * k) for k in range(60)]
    points = "".join(
        f"GOTO/{k / 5},0.0,5.0,{0.6 * math.cos(a):.9f},{0.6 * math.sin(a):.9f},0.8\n" for k, a in enumerate(angles)
    )
    turning = CL[: CL.index("RAPID\n")] + "FEDRAT/MMPM,500.0\n" + points + "END-OF-PATH\n"
    code, err = shop.post(turning, str(own), "zero=0,0,0")
    assert code == 0, err
    assert ";Rewind" in shop.program.read_text(encoding="utf-8")
    code, err = shop.post(turning, str(own), "zero=0,0,0", "tool_length=90", "tcp=off")
    assert code == 0, err
    assert "1 retract along the tool axis to turn" in err
    assert ";Rewind" in shop.program.read_text(encoding="utf-8")
    code, err = shop.post(turning, str(own), "zero=0,0,0", "tool_length=90", "tcp=off", "rewind=none")
    assert code == 1
    assert "--set rewind=insert" in err


# The proof


def posted(shop: Shop) -> list[str]:
    assert shop.post(CL, HEAD[0], HEAD[1], "tool_length=120", "tcp=off")[0] == 0
    return shop.lines


ASKED = ("--machine", HEAD[0], "--zero", "0,0,-300", "--span-tip", "0.005", "--tolerance", "0.00001")


def turning(lines: list[str]) -> int:
    """A line in the middle of the cut that turns."""
    return next(k for k, line in enumerate(lines) if line.startswith("G93")) + 12


def without(lines: list[str], first: int, count: int = 1) -> list[str]:
    return lines[:first] + lines[first + count :]


def changed(lines: list[str], at: int, letter: str, by: float) -> list[str]:
    words = [f"{w[0]}{float(w[1:]) + by:.5f}" if w[0] == letter else w for w in lines[at].split(" ")]
    return [*lines[:at], " ".join(words), *lines[at + 1 :]]


FAULTS: dict[str, tuple[Callable[[list[str]], list[str]], str]] = {
    "a point between is dropped": (lambda lines: without(lines, turning(lines)), "span"),
    "a point between is off": (lambda lines: changed(lines, turning(lines), "X", 0.002), "order"),
    "an angle between is off": (lambda lines: changed(lines, turning(lines), "C", 0.02), "order"),
    "a block takes longer": (lambda lines: changed(lines, turning(lines), "F", -30.0), "feed"),
    "a block goes faster": (lambda lines: changed(lines, turning(lines), "F", 30.0), "feed"),
    "a block has no time": (
        lambda lines: [*lines[:turning(lines)], lines[turning(lines)].partition(" F")[0], *lines[turning(lines) + 1:]],
        "modal",
    ),
    "no edge": (lambda lines: [line.replace(" D1", "").replace("D1", "") for line in lines], "tip"),
    "mm/min forgotten": (lambda lines: [line.replace("G94 X", "X") for line in lines], "feed"),
    "inverse time forgotten": (lambda lines: [line.replace("G93 ", "") for line in lines], "feed"),
    "TCP on": (lambda lines: [line.replace("TRAFOOF", "TRAORI") for line in lines], "tip"),
}  # fmt: skip


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_found(name: str, shop: Shop) -> None:
    fault, key = FAULTS[name]
    lines = posted(shop)
    code, checks = shop.verify(*ASKED, "--tool-length", "120")
    assert code == 0, checks
    shop.program.write_text("\n".join(fault(lines)) + "\n", encoding="utf-8")
    code, checks = shop.verify(*ASKED, "--tool-length", "120")
    assert code == 1
    assert " FAIL " in checks[key], checks


@pytest.mark.parametrize(
    "arguments",
    [
        ("--tool-length", "120.1"),
        (),
        ("--tool-length", "120", "--zero", "0,0,-299"),
    ],
)
def test_another_tool_is_found_and_another_clamping_of_a_head_makes_no_difference(
    arguments: tuple[str, ...], shop: Shop
) -> None:
    posted(shop)
    asked = [*ASKED[:2], *ASKED[4:]] if "--zero" in arguments else ASKED
    code, checks = shop.verify(*asked, *arguments)
    if "120" in arguments:  # slides count from the work offset, and no table turns the part
        assert code == 0, checks
    else:
        assert code == 1
        assert " FAIL " in checks["tip"]


def test_another_clamping_on_a_table_is_found(shop: Shop) -> None:
    assert shop.post(CL, *TABLE, "tcp=off")[0] == 0
    assert shop.verify("--machine", TABLE[0], "--zero", "0,0,50", "--span-tip", "0.005")[0] == 0
    code, checks = shop.verify("--machine", TABLE[0], "--zero", "0,0,51", "--span-tip", "0.005")
    assert code == 1
    assert " FAIL " in checks["tip"]


def test_points_between_cl_points_are_faults_unless_they_lie_on_the_way(shop: Shop) -> None:
    assert shop.post(CL, *TABLE, "axis_tolerance=0.01")[0] == 0
    arguments = ["verify", str(shop.program), "--machine", TABLE[0], "--cl", str(shop.cl)]
    assert main(arguments) == 0
    text = shop.program.read_text(encoding="utf-8")
    assert "Y1.12679 B5.16035" in text
    shop.program.write_text(text.replace("Y1.12679 B5.16035", "Y1.22679 B5.16035"), encoding="utf-8")
    assert main(arguments) == 1


def test_a_program_reads_back_as_the_toolpath_with_its_points(shop: Shop, tmp_path: Path) -> None:
    assert shop.post(CL, *TABLE, "axis_tolerance=0.01")[0] == 0
    back = tmp_path / "back.cls"
    assert main(["convert", str(shop.program), "--machine", TABLE[0], "--to-cl", "--output", str(back)]) == 0
    assert back.read_text(encoding="utf-8").count("GOTO/") > CL.count("GOTO/")
