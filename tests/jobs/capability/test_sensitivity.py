"""What each number of a machine's geometry does to a program."""

import json
import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.locations import YL569
from trunnion.capability.sensitivity import NumberSensitivity, Sensitivity, errors_over
from trunnion.cli import main
from trunnion.jobs.capability.sensitivity_report import write_sensitivity_report
from trunnion.machines import forward, slide_positions
from trunnion.results import to_data

BLADE = YL569 / "3_blade_finish.expected.mpf"
ZERO, LENGTH = (12.0, -7.0, 180.0), 140.0

Capture = pytest.CaptureFixture[str]
Written = Callable[[str], Path]


@pytest.fixture
def written(tmp_path: Path) -> Written:
    """Write a program for LinuxCNC, whose zero and axes are easily seen."""

    def write(lines: str) -> Path:
        file = tmp_path / "part.ngc"
        file.write_text(f"G21 G90 G94 G17 G54\n{lines}\nM2\n", encoding="utf-8")
        return file

    return write


def by_name(found: Sensitivity) -> dict[str, NumberSensitivity]:
    return {each.number.name: each for each in found.numbers}


def test_errors_are_those_of_the_program_on_the_machine_that_is_off() -> None:
    """A point of C that is 0.02 mm off: the forward map of that machine, and the pose at the zero, tell the same."""
    found = trunnion.sensitivity(BLADE, machine="yl569", zero=ZERO, tool_length=LENGTH, length=0.02)
    run = trunnion.read_program(
        BLADE, machine=replace(trunnion.load_machine("yl569"), workpiece_zero=ZERO, tool_length=LENGTH)
    )
    machine = run.machine
    c = machine.axis("C")
    off = replace(
        machine, axes=tuple(replace(a, point=(c.point[0] + 0.02, *c.point[1:])) if a is c else a for a in machine.axes)
    )
    cuts = (run.kind > 0) & ~run.machine_frame
    errors = forward(off, run.joints[cuts])[0] - forward(machine, run.joints[cuts])[0]
    set_at = slide_positions(machine, np.zeros((1, 3)), np.zeros((1, 2)))
    left = errors - (forward(off, set_at)[0] - forward(machine, set_at)[0])
    point = by_name(found)["C point X"]
    assert point.zeroed is not None
    assert point.tip.largest == pytest.approx(np.linalg.norm(errors, axis=1).max(), rel=1e-6)
    assert point.zeroed.largest == pytest.approx(np.linalg.norm(left, axis=1).max(), rel=1e-6)
    places = run.line[cuts].tolist()
    at = places.index(point.tip.place.line)
    assert float(np.linalg.norm(errors[at])) == pytest.approx(point.tip.largest, rel=1e-6)


def test_the_zero_takes_what_is_the_same_everywhere() -> None:
    found = by_name(trunnion.sensitivity(BLADE, machine="yl569", zero=ZERO, tool_length=LENGTH))
    zero = found["workpiece zero X"]
    assert zero.zeroed is not None
    assert zero.tip.largest == pytest.approx(0.01)
    assert zero.tip.rms == pytest.approx(0.01)
    assert zero.zeroed.largest == pytest.approx(0.0, abs=1e-12)
    bare = trunnion.sensitivity(BLADE, machine="yl569", zero=ZERO, tool_length=LENGTH, zero_at="none")
    assert all(each.zeroed is None for each in bare.numbers)
    assert [each.tip.largest for each in bare.numbers] == sorted((e.tip.largest for e in bare.numbers), reverse=True)


def test_where_the_zero_was_set_is_a_matter_of_its_pose() -> None:
    """The tool length is exact again for the tool axis at which the zero was set."""
    found = trunnion.sensitivity(BLADE, machine="yl569", zero=ZERO, tool_length=LENGTH, zero_at="B=90")
    other = trunnion.sensitivity(BLADE, machine="yl569", zero=ZERO, tool_length=LENGTH, zero_at={"B": 90.0, "C": 0})
    assert found.zero_at == {"C": 0.0, "B": 90.0} == other.zero_at
    assert by_name(found)["tool length"] == by_name(other)["tool length"]
    home = trunnion.sensitivity(BLADE, machine="yl569", zero=ZERO, tool_length=LENGTH)
    assert by_name(found)["tool length"] != by_name(home)["tool length"]


def test_a_whole_circle_is_judged_all_around(written: Written) -> None:
    """Y out of square by 5 seconds: at 50 mm on the circle, though it begins and ends at 0."""
    program = written("G0 X0 Y0 Z10\nG1 Z0 F500\nG2 X0 Y0 I50 J0")
    found = trunnion.sensitivity(program, machine="xyzac_trt", zero=(0, 0, 0), tool_length=0)
    square = by_name(found)["Y direction about Z"].tip
    assert square.largest == pytest.approx(50.0 * math.radians(5.0 / 3600.0), rel=2e-3)
    assert square.place.line == 4


def test_rapids_and_retracts_do_not_count(written: Written) -> None:
    far = written("G0 X0 Y0 Z10\nG0 Y4000\nG0 Y0\nG1 Z0 F500\nG1 Y20\nG53 G1 Y150\nG53 G0 Z400")
    found = trunnion.sensitivity(far, machine="xyzac_trt", zero=(0, 0, 0), tool_length=0)
    assert found.motions == 2
    assert by_name(found)["Y direction about Z"].tip.largest == pytest.approx(20.0 * math.radians(5.0 / 3600.0))


def test_what_is_not_known_is_told(capfd: Capture) -> None:
    assert main(["sensitivity", str(BLADE), "--machine", "yl569"]) == 0
    out, err = capfd.readouterr()
    assert [line.rpartition(" ")[2] for line in err.splitlines() if "warning" in line] == ["[RCH130]", "[RCH140]"]
    *_, idle, grounds = out.splitlines()
    assert "C point Z" in idle
    assert grounds.startswith("not measured: C point_mm (yl569.toml:35), ")
    assert grounds.endswith("; assumed: no work offset is in force at N400")
    assert idle.startswith("without effect: ")
    assert "(at), and the root of the mean square over all motions (rms)" in out.splitlines()[1]
    assert sum(line.startswith("C point X ") for line in out.splitlines()) == 1


def test_data_and_page_hold_the_same_numbers(tmp_path: Path, capfd: Capture) -> None:
    file, page = tmp_path / "numbers.json", tmp_path / "numbers.html"
    command = ["sensitivity", str(BLADE), "--machine", "yl569", "--zero", "0,0,100", "--tool-length", "120"]
    assert main([*command, "--json", str(file), "--report", str(page)]) == 0
    assert "B point X" in capfd.readouterr().out
    data = json.loads(file.read_text("utf-8"))
    largest = [each["with_zero_set"]["largest_mm"] for each in data["numbers"]]
    assert largest == sorted(largest, reverse=True)
    assert len(data["numbers"]) + len(data["without_effect"]) == 33
    html = page.read_text("utf-8")
    worst = data["numbers"][0]
    assert worst["number"] in html
    assert f"{worst['with_zero_set']['largest_mm']:.5f}" in html
    assert html.count('id="full-error') == 12
    assert main([*command, "--json", "-"]) == 0
    assert json.loads(capfd.readouterr().out) == data


def test_the_page_draws_the_error_of_each_motion(tmp_path: Path) -> None:
    found = trunnion.sensitivity(BLADE, machine="yl569", zero=ZERO, tool_length=LENGTH)
    rows, errors = errors_over(found, [each.number for each in found.numbers[:3]])
    assert len(rows) == found.motions
    for k, each in enumerate(found.numbers[:3]):
        assert each.zeroed is not None
        assert errors[:, k].max() == pytest.approx(each.zeroed.largest, rel=1e-6)
    write_sensitivity_report(found, tmp_path / "page.html")
    assert (tmp_path / "page.html").read_bytes().startswith(b"<!DOCTYPE html>")
    assert to_data(found)["motions"] == len(rows)


@pytest.mark.parametrize(
    ("arguments", "what"),
    [
        (
            ["--zero-at", "A=0"],
            "is 'A=0'; A is no rotary axis of the machine; give home, none, or angles such as C=0,B=0",
        ),
        (
            ["--zero-at", "B=300"],
            "--zero-at: error: is 'B=300'; B goes from -11 to 100 degrees; give an angle within them",
        ),
        (["--angle=-5"], "--angle: error: is -5.0; give a number above 0, and at most 3600"),
        (["--zero-at", "B=nan"], "--zero-at: error: is 'B=nan'"),
        (["--zero-at", "B"], "--zero-at: error: is 'B'"),
        (["--angle", "7200"], "--angle: error: is 7200.0; give a number above 0, and at most 3600"),
        (["--report", "page.pdf"], "page.pdf: error: this report is a page; let its name end in .html"),
        (["--zero", "1,2"], "--zero: error"),
    ],
)
def test_what_cannot_be_used_is_told(arguments: list[str], what: str, capfd: Capture) -> None:
    assert main(["sensitivity", str(BLADE), "--machine", "yl569", *arguments]) == 2
    out, err = capfd.readouterr()
    assert out == ""
    assert what in err


def test_progress_counts_the_motions() -> None:
    counted: list[tuple[str, int, str] | int] = []

    class Counting(trunnion.Observer):
        @contextmanager
        def progress(self, stage: str, total: int, unit: str) -> Iterator[Callable[[int], None]]:
            counted.append((stage, total, unit))
            yield counted.append

    found = trunnion.sensitivity(BLADE, machine="yl569", observer=Counting())
    assert counted[0] == ("sensitivity", len(found.run), "motions")
    assert 0 < sum(each for each in counted[1:] if isinstance(each, int)) <= len(found.run)


def test_a_program_without_cuts_is_refused(written: Written, capfd: Capture) -> None:
    assert main(["sensitivity", str(written("G0 X0 Y0 Z10")), "--machine", "xyzac_trt"]) == 2
    assert "has no motion at feed; give a program that cuts [RCH110]" in capfd.readouterr().err


def test_a_cl_file_is_told_from_a_program(capfd: Capture) -> None:
    file = YL569 / "2_hub_rough.cls"
    assert main(["sensitivity", str(file), "--machine", "yl569"]) == 2
    assert "2_hub_rough.cls: error: is a CL file, and no NC program; post it" in capfd.readouterr().err


def test_nothing_is_written_over_the_program(tmp_path: Path) -> None:
    program = tmp_path / "part.html"
    program.write_bytes(BLADE.read_bytes())
    assert main(["sensitivity", str(program), "--machine", "yl569", "--report", str(program)]) == 2
    assert program.read_bytes() == BLADE.read_bytes()


def test_the_page_of_the_command_names_its_options(tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    assert (
        main(["sensitivity", str(YL569 / "2_hub_rough.expected.mpf"), "--machine", "yl569", "--report", str(page)]) == 0
    )
    text = page.read_text(encoding="utf-8")
    assert "give --zero X,Y,Z" in text
    assert "argument zero" not in text
