"""STEP files as meshes: their units, their assemblies, how far facets are off, and what is refused."""

import importlib.util
import math
import sys
from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.step_files import StepFile
from trunnion.simulation.meshes import judge_mesh, load_mesh, step

SLOT = "G21 G90 G17 G40 G49 G80\nT1 M6\nG43 H1\nS1000 M3\nG0 X-20 Y0 Z5\nG0 Z-4\nG1 X20 F500\nG0 Z20\nM5\nM2\n"


@pytest.mark.parametrize(("unit", "in_mm"), [("mm", 1.0), ("inch", 25.4), ("m", 1000.0)])
def test_a_disc_is_read_in_the_unit_that_the_file_states(tmp_path: Path, unit: str, in_mm: float) -> None:
    file = StepFile(unit)
    file.disc(20.0 / in_mm, -5.0 / in_mm, 10.0 / in_mm)
    mesh = load_mesh(file.save(tmp_path / "disc.stp"), closed=True, deviation=0.02)
    radius = np.hypot(mesh.vertices[:, 0], mesh.vertices[:, 1])
    assert judge_mesh(mesh).is_closed
    assert np.allclose(radius, 20.0, atol=1e-4)  # GLB, through which it comes, has single precision
    assert np.allclose(mesh.bounds[:, 2], (-5.0, 10.0), atol=1e-4)
    whole = math.pi * 400.0 * 15.0
    assert whole * (1.0 - 0.02 / 20.0 * 2.0) < mesh.volume < whole


def test_facets_are_as_near_as_they_are_asked_for(tmp_path: Path) -> None:
    file = StepFile()
    file.disc(20.0, 0.0, 10.0)
    path = file.save(tmp_path / "disc.step")
    found = {deviation: load_mesh(path, closed=True, deviation=deviation) for deviation in (0.2, 0.002)}
    for deviation, mesh in found.items():
        middles = mesh.vertices[mesh.faces].mean(axis=1)
        edges = 0.5 * (mesh.vertices[mesh.faces] + np.roll(mesh.vertices[mesh.faces], 1, axis=1)).reshape(-1, 3)
        wall = np.hypot(edges[:, 0], edges[:, 1])[np.abs(edges[:, 2] - 5.0) < 4.9]
        assert 20.0 - wall.min() <= deviation
        assert len(middles) == len(mesh.faces)
    assert len(found[0.002].faces) > 3 * len(found[0.2].faces)


def test_the_bodies_of_an_assembly_stand_where_it_has_them(tmp_path: Path) -> None:
    file = StepFile()
    disc, round_ = file.disc(10.0, 0.0, 20.0), file.shape
    block, square = file.block((0, 0, 0), (40, 30, 10)), file.shape
    file.assembly([(disc, round_, (100, 0, 0), 0), (disc, round_, (0, 100, 5), 0), (block, square, (0, 0, 0), 90)])
    mesh = load_mesh(file.save(tmp_path / "whole.step"), closed=True)
    assert np.allclose(mesh.bounds, [(-30, -10, 0), (110, 110, 25)], atol=1e-3)
    assert mesh.volume == pytest.approx(2.0 * math.pi * 100.0 * 20.0 + 12000.0, rel=1e-3)


def test_stock_part_and_fixture_may_be_step_files(tmp_path: Path) -> None:
    file = StepFile()
    file.block((-15, -10, -10), (15, 10, 0))
    blank = file.save(tmp_path / "blank.step")
    clamp = StepFile()
    clamp.block((-15, 4, -10), (15, 10, 3))
    nc = tmp_path / "slot.ngc"
    nc.write_text(SLOT)
    found = trunnion.simulate(
        nc, machine="xyzac_trt", stock=blank, part=blank, fixtures=[clamp.save(tmp_path / "clamp.stp")],
        tools=["1=flat:10,length=60,flutes=30"], cell=1.0,
    )  # fmt: skip
    assert found.removed == pytest.approx(30.0 * 10.0 * 4.0, rel=1e-3)
    assert {each.kind for each in found.findings} == {"gouge", "collision"}
    assert found.gouge is not None
    assert found.gouge.largest == pytest.approx(4.0, abs=0.01)


def test_what_cannot_be_read_is_refused_with_its_cure(tmp_path: Path) -> None:
    file = StepFile()
    file.block((0, 0, 0), (10, 10, 10))
    text = file.save(tmp_path / "whole.step").read_text()
    for name, spoiled, told in (
        ("cut", text[: len(text) // 2], "is damaged: .*end of file.*export it again"),
        ("none", "no STEP at all", "is damaged: .*export it again"),
        ("hollow", text.replace("CLOSED_SHELL", "CLOSED_SHELL_"), "has a body whose surface is not there"),
        (
            "others",
            text.replace("ENDSEC;\nEND", "#999=DOCUMENT_FILE('b.step','',$,#1,'',$);\nENDSEC;\nEND"),
            "other files",
        ),
    ):
        path = tmp_path / f"{name}.step"
        path.write_text(spoiled)
        with pytest.raises(trunnion.InputError, match=told):
            load_mesh(path, closed=True)
    with pytest.raises(trunnion.InputError, match="states its unit"):
        load_mesh(tmp_path / "whole.step", "inch")


def test_without_the_extra_the_message_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = StepFile()
    file.block((0, 0, 0), (10, 10, 10))
    path = file.save(tmp_path / "block.step")
    monkeypatch.setattr(importlib.util, "find_spec", lambda _: None)
    monkeypatch.setitem(sys.modules, "cascadio", None)
    with pytest.raises(
        trunnion.InputError, match=r'needs cascadio, which is not installed; run ".+" -m pip install "trunnion\[cad\]"'
    ):
        load_mesh(path)


def test_a_file_that_takes_too_long_is_given_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = StepFile()
    file.block((0, 0, 0), (10, 10, 10))
    path = file.save(tmp_path / "block.step")
    monkeypatch.setattr(step, "_LONGEST", 0.01)
    with pytest.raises(trunnion.InputError, match="not made facets within"):
        load_mesh(path)
