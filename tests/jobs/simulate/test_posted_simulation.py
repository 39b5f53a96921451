"""``trunnion.post`` with ``simulation``: collisions, gouges and rapids through stock refuse like other checks."""

import json
from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.locations import YL569
from trunnion.cli import main
from trunnion.simulation.meshes import box_mesh, save_mesh

CL = YL569 / "2_hub_rough.cls"
STOCK = "box:18.5,24,26,30,4,-34"
#: So high that the tool comes through it at rapid.
TALL = "box:80,40,40,-10,-20,-40"


def test_a_sound_program_is_written_and_says_what_it_cuts(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    given = {"stock": STOCK, "cell": 1.0}
    result = trunnion.post(CL, machine="yl569", output=tmp_path / "hub.mpf", simulation=given)
    assert result.passed
    assert result.simulation is not None
    assert {remark.file for remark in result.simulation.remarks} <= {str(tmp_path / "hub.mpf"), "tool 2"}
    assert result.simulation.programs == (str(tmp_path / "hub.mpf"),)
    assert 500.0 < result.simulation.removed < 5000.0  # with the ball of the CL file
    assert [check.key for check in result.checks][-2:] == ["removal", "collision"]
    assert (tmp_path / "hub.mpf").read_bytes() == trunnion.post(CL, machine="yl569").text.encode()  # type: ignore[union-attr]
    command = ["post", str(CL), "--machine", "yl569", "--output", str(tmp_path / "two.mpf"), "--simulate"]
    assert main([*command, "--stock", STOCK, "--cell", "1"]) == 0
    told = capsys.readouterr().err
    assert "\nremoval       ok    " in told
    assert "\ncollision     not checked  neither fixtures given, nor zero" in told
    assert f"{tmp_path / 'two.mpf'}: warning: the bodies of the machine are not checked" in told
    assert ".two.mpf." not in told


def test_a_rapid_through_stock_is_refused_and_forced_with_a_notice(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    place = tmp_path / "hub.mpf"
    given = {"stock": TALL, "cell": 1.0}
    with pytest.raises(trunnion.ProofFailedError) as raised:
        trunnion.post(CL, machine="yl569", output=place, simulation=given)
    assert not place.exists()
    failed = {check.key: check for check in raised.value.result.checks if not check.passed}
    assert list(failed) == ["removal"]
    worst = failed["removal"].places[0]
    assert worst.text.startswith("rapid through stock: tool 2, stock")
    assert (worst.cl_file, worst.cl_line) == (str(CL), 13)
    command = ["post", str(CL), "--machine", "yl569", "--output", str(place), "--simulate", "--stock", TALL]
    assert main([*command, "--cell", "1"]) == 1
    assert "2_hub_rough.cls:13: rapid through stock" in capsys.readouterr().err
    assert not place.exists()
    assert main([*command, "--cell", "1", "--force"]) == 1
    text = place.read_text()
    assert "MUST NOT RUN" in text
    assert "rapid through stock" in text


def test_what_is_missing_of_the_part_fails(tmp_path: Path) -> None:
    save_mesh(box_mesh(np.array([30.0, 4.0, -34.0]), np.array([48.5, 28.0, -8.0])), tmp_path / "part.stl")
    (tmp_path / "hub.toml").write_text(
        f'[simulation]\nstock = "{STOCK}"\npart = "part.stl"\ncell_mm = 1\nprograms = ["hub.mpf"]\nmachine = "yl569"\n'
    )
    with pytest.raises(trunnion.ProofFailedError) as raised:
        trunnion.post(
            CL, machine="yl569", output=tmp_path / "hub.mpf", simulation=tmp_path / "hub.toml",
            report=tmp_path / "hub.html",
        )  # fmt: skip
    page = (tmp_path / "hub.html").read_text()
    assert "<h2>Simulation: findings</h2>" in page
    assert page.count("data:image/png;base64,") == 2
    assert "img-src data:" in page
    raised.value.result.write_report(tmp_path / "hub.json")
    assert json.loads((tmp_path / "hub.json").read_text())["simulation"]["gouge"]["largest_mm"] > 1.0
    failed = [check for check in raised.value.result.checks if not check.passed]
    assert [check.key for check in failed] == ["gouge"]
    assert failed[0].worst is not None
    assert failed[0].worst > 1.0
    assert failed[0].places


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--stock", STOCK], "--stock: error: is only for a simulation"),
        (["--simulate"], "--stock: error: is missing"),
        (["--simulate", "--stock", "box:1,2"], "--stock: error: box:1,2 has 2 numbers"),
        (["--simulate", "--project", str(CL)], "is no project"),
        (["--simulate", "--project", "two.toml"], "has 2 set-ups"),
        (["--simulate", "--project", "other.toml"], "other.toml:2: error: simulation.machine is dmu65"),
        (["--simulate", "--project", "zero.toml"], "give --zero 0,0,120"),
        (["--simulate", "--project", "until.toml"], "until.toml:4: error: simulation.until is 400"),
        (["--simulate", "--stock", "hub.stl", "--output", "hub.stl"], "hub.stl"),
        (["--simulate", "--stock", STOCK, "--tool", "2=bal:3"], "bal"),
    ],
    ids=["alone", "none", "stock", "cl", "setups", "machine", "zero", "until", "over", "tool"],
)
def test_what_cannot_be_simulated_is_told(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    options: list[str],
    words: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    save_mesh(box_mesh(np.array([30.0, 4.0, -34.0]), np.array([48.5, 28.0, -8.0])), tmp_path / "hub.stl")
    (tmp_path / "a.mpf").write_text("M30\n")
    setup = f'stock = "{STOCK}"\n'
    (tmp_path / "two.toml").write_text(
        f'[simulation]\nmachine = "yl569"\n{setup}[[simulation.setup]]\nprograms = ["a.mpf"]\n'
        '[[simulation.setup]]\nprograms = ["a.mpf"]\n'
    )
    (tmp_path / "other.toml").write_text(f'[simulation]\nmachine = "dmu65"\n{setup}')
    (tmp_path / "zero.toml").write_text(f"[simulation]\n{setup}zero_mm = [0, 0, 120]\n")
    (tmp_path / "until.toml").write_text(f"[simulation]\n{setup}cell_mm = 1.0\nuntil = 400\n")
    before = (tmp_path / "hub.stl").read_bytes()
    output = [] if "--output" in options else ["--output", "out.mpf"]
    assert main(["post", str(CL), "--machine", "yl569", *output, *options]) == 2
    assert words in capsys.readouterr().err
    assert not (tmp_path / "out.mpf").exists()
    assert (tmp_path / "hub.stl").read_bytes() == before


def test_an_unknown_name_is_told_with_the_nearest() -> None:
    with pytest.raises(trunnion.InputError, match='did you mean "stock"'):
        trunnion.post(CL, machine="yl569", simulation={"stok": STOCK})
