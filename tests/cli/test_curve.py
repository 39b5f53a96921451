"""``trunnion curve``."""

import json
from pathlib import Path

import pytest

from trunnion.cli import main

BLADE = str(Path(__file__).resolve().parents[2] / "examples" / "impeller" / "blade_points.csv")

Capture = pytest.CaptureFixture[str]


def test_curves_are_printed_with_control_points_knots_and_errors(capfd: Capture) -> None:
    assert main(["curve", BLADE]) == 0
    out, err = capfd.readouterr()
    assert err == ""
    lines = out.splitlines()
    assert lines[0] == "tip: 20 points, 52.084 mm long"
    assert lines[1] == "  control points (22)"
    assert lines[2].split() == ["1", "35.5150", "-21.5970", "44.1490"]
    assert lines[24].startswith("  knots (26): 0.000000 0.000000 0.000000 0.000000 0.052607 ")
    assert lines[-1].startswith("  points are at most 0.000000 mm off, 0.000000 rms; natural ends would move")


def test_data_hold_the_same_and_remarks(capfd: Capture) -> None:
    ends = ["--start", "derivative:0,0,1", "--end", "derivative:-1,0,0"]
    assert main(["curve", BLADE, "--scale", "0.75", "--json", *ends]) == 0
    out, err = capfd.readouterr()
    assert err.count("runs back before this point") == 4
    data = json.loads(out)
    tip, hub = data["curves"]
    assert (tip["name"], hub["name"], len(tip["control_points"]), len(tip["knots"])) == ("tip", "hub", 22, 26)
    assert (len(tip["points"]), len(tip["spans"]), len(tip["remarks"])) == (20, 19, 2)
    assert tip["control_points"][0] == pytest.approx([26.63625, -16.19775, 33.11175])


def test_a_picture_is_written_and_never_over_the_points(tmp_path: Path, capfd: Capture) -> None:
    picture = tmp_path / "blade.svg"
    assert main(["curve", BLADE, "--tolerance", "0.1", "--picture", str(picture)]) == 0
    assert picture.read_text("utf-8").startswith("<svg")
    points = tmp_path / "points.svg"
    points.write_bytes(Path(BLADE).read_bytes())
    assert main(["curve", str(points), "--picture", str(points)]) == 2
    assert points.read_bytes() == Path(BLADE).read_bytes()
    assert "points.svg" in capfd.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "what"),
    [
        ([BLADE, "--start", "up"], "--start: error: is 'up'; write natural, tangent:X,Y,Z"),
        ([BLADE, "--start", "tangent:0,0,1", "--tolerance", "0.1"], "--start: error: is for a curve through points"),
        (["none.csv"], "none.csv: error: file not found; give the path of a table of points"),
        ([BLADE, "--picture", "blade.png"], "blade.png: error: curves are drawn as SVG; let its name end in .svg"),
    ],
)
def test_what_cannot_be_used_is_told_and_nothing_printed(arguments: list[str], what: str, capfd: Capture) -> None:
    assert main(["curve", *arguments]) == 2
    out, err = capfd.readouterr()
    assert (out, what in err) == ("", True)
