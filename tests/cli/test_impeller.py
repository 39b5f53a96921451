"""``trunnion impeller``."""

import json
from pathlib import Path

import pytest

from trunnion.cli import main

IMPELLER = str(Path(__file__).resolve().parents[2] / "examples" / "impeller" / "impeller.toml")

Capture = pytest.CaptureFixture[str]


def test_a_model_is_written_and_described(tmp_path: Path, capfd: Capture) -> None:
    mesh = tmp_path / "part.stl"
    assert main(["impeller", "model", IMPELLER, "--output", str(mesh), "--tolerance", "0.2", "--json"]) == 0
    data = json.loads(capfd.readouterr().out)
    assert (data["name"], data["blades"], data["splitters"]) == ("IMPELLER", 6, 0)
    assert mesh.stat().st_size == 84 + 50 * data["facets"]
    assert data["deviation_mm"] <= 0.2


@pytest.mark.parametrize(
    ("arguments", "what"),
    [
        (
            [IMPELLER, "--output", "part.iges"],
            'ends in ".iges", a format that is not written; end it in one of .stl, .ply, .3mf, .glb, .png, .step, .stp',
        ),
        ([IMPELLER, "--tolerance", "5"], "--tolerance: error: is 5.0; give a number from 0.0001 to 1"),
        (["none.toml"], "none.toml: error: file not found; give the path of an impeller definition [FIL110]\n"),
        (
            ["none"],
            "none: error: file not found; give the path of an impeller definition, whose name ends in .toml [DEF110]\n",
        ),
        (
            [__file__],
            "is not an impeller definition, whose name ends in .toml; "
            "give the path of an impeller definition [DEF140]\n",
        ),
    ],
)
def test_what_cannot_be_used_is_told(arguments: list[str], what: str, capfd: Capture) -> None:
    assert main(["impeller", "model", *arguments]) == 2
    out, err = capfd.readouterr()
    assert (out, what in err) == ("", True), err


@pytest.mark.parametrize(
    ("arguments", "what"),
    [
        (["cut", IMPELLER], "--machine: error: is missing; name the machine that runs the program"),
        (["cut", IMPELLER, "--tolerance", "0.1"], "--tolerance: error: is not for cut; leave it out"),
        (["model", IMPELLER, "--machine", "yl569"], "--machine: error: is not for model; leave it out"),
        (
            ["cut", IMPELLER, "--machine", "yl569", "--output", "nc", "--operation", "HUB"],
            "--operation: error: has 'HUB'",
        ),
    ],
)
def test_options_of_a_step_are_its_own(
    arguments: list[str], what: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: Capture
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["impeller", *arguments]) == 2
    assert what in capfd.readouterr().err
    assert not list(tmp_path.iterdir())


def test_a_cut_is_told_as_data(tmp_path: Path, capfd: Capture) -> None:
    folder = tmp_path / "nc"
    named = ["--operation", "STOCK_ROUGHING", "--json"]
    assert main(["impeller", "cut", IMPELLER, "--machine", "yl569", "--output", str(folder), *named]) == 0
    data = json.loads(capfd.readouterr().out)
    assert (data["passed"], data["program"]) == (True, str(folder / "IMPELLER.mpf"))
    (step,) = data["steps"]
    assert (step["name"], step["operations"], step["published_minutes"]) == ("STOCK_ROUGHING", 1, 1.82)
    assert set(data["checks"].values()) == {"ok", "not checked"}
