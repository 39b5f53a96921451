"""Cures of messages about impellers that are cut, and written as solids."""

import itertools
import pickle
import subprocess
from collections.abc import Mapping
from dataclasses import replace
from functools import cache, reduce
from pathlib import Path
from types import SimpleNamespace
from typing import Final
from unittest.mock import MagicMock, patch

import numpy as np

import trunnion
from tests.support.cures.cure import Cure, Outcome, Trial
from tests.support.cures.impellers.definitions import IMPELLER, MIXED, POINTS, written
from tests.support.cures.impellers.paths import built, made_of
from tests.support.cures.reading import ended
from tests.support.example_impellers import EXAMPLES
from tests.support.operations import operation_of
from tests.support.path_strategies import winding
from trunnion.geometry.interpolation import interpolate
from trunnion.geometry.parameters import parameters_of
from trunnion.impeller import model
from trunnion.impeller.machining import step_paths
from trunnion.impeller.model import impeller_model
from trunnion.impeller.profiles import Profile
from trunnion.impeller.solid import making
from trunnion.impeller.solid.impeller_body import _hub_meridian, impeller_body
from trunnion.impeller.solid.order import Made
from trunnion.impeller.solid.root_loop import Density
from trunnion.jobs.impeller import models
from trunnion.jobs.impeller.windings import winding_problems
from trunnion.machines import load_machine
from trunnion.model.toolpath import Toolpath
from trunnion.planning import plan

_TWO: Final = (EXAMPLES / "impeller.toml").read_text(encoding="utf-8").partition('[[operation]]\nkind = "channel')[0]
_COARSE: Final = _TWO.replace("stepover_mm = 0.5", "stepover_mm = 8").replace("step_down_mm = 1.5", "step_down_mm = 6")
_FLAT: Final = "flute_length_mm = 40\nlength_mm = 60\nshank_diameter_mm = 20"
_FEW: Final = Density(65, 9, 7, 5)


def _cut(*operations: str, output: str = "out", machine: str = "yl569", foreign: bool = False) -> Trial:
    """Return what cuts operations of an impeller into a folder, in which a file of its name may stand already."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        place = folder / output if output != "-" else Path(output)
        if foreign:
            place.mkdir(exist_ok=True)
            (place / "IMPELLER.mpf").write_text("of somebody else", encoding="utf-8")
            (place / "part.mpf").write_text("of somebody else", encoding="utf-8")
        file = written(text, folder)
        return ended(lambda: trunnion.cut_impeller(file, machine=machine, output=place, operations=operations))

    return tried


def _sized(code: str, variant: str, sizes: str) -> Cure:
    """A flat mill of sizes that do not do, and the published one."""
    return Cure(
        code,
        variant,
        made_of(lambda one: next(step_paths(one, None))),
        _COARSE.replace(_FLAT, sizes),
        ((sizes, _FLAT),),
    )


def _solid(code: int = 0, said: bytes = b"", *, volume: float = 100.0, ends: bool = True) -> Trial:
    """Return what makes a solid, whose process is not started: it ends with a code, or never; the mesh has 100 mm³.

    Nothing is measured on its fillets, which have few stations.
    """
    made = b"" if code else pickle.dumps(Made(b"step", volume, 1, np.array([[45.0, 0.0, 1.0]])))
    error = None if ends else subprocess.TimeoutExpired("solid", 1.0)
    done = subprocess.CompletedProcess("solid", code, made, said)
    mesh = MagicMock(**{"return_value.mesh.volume": 100.0})
    body = MagicMock(return_value=(None, np.zeros(1)))

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        with (
            patch.object(subprocess, "run", side_effect=error, return_value=done),
            patch.multiple(
                making,
                Order=MagicMock(return_value=SimpleNamespace(name="part")),
                impeller_body=body,
                impeller_model=mesh,
                _STATIONS=(60, 24),
            ),
        ):
            return ended(lambda: making.impeller_solid(built(text), 0.5))

    return tried


def _led(*places: tuple[float, float], foot: float = 20.0) -> Trial:
    """Return what leads a hub through places (radius, height) to the axis and out of the stock.

    foot  radius at which the foot of a fillet is, on the hub or where it goes on straight before its inlet
    """
    flat = np.array([(radius, 0.0, height) for radius, height in places])
    points = np.concatenate([np.linspace(*pair, 9)[:-1] for pair in itertools.pairwise(flat)] + [flat[-1:]])
    hub = Profile(interpolate(points, parameters_of(points)))
    slope = (flat[1] - flat[0]) / (flat[1] - flat[0])[0]
    feet = np.array([flat[0] + (foot - flat[0][0]) * slope])
    return made_of(lambda one: _hub_meridian(replace(one, hub=hub), feet))


def _faceted(tolerance: float) -> Trial:
    """Return what makes a mesh that is taken to be 0.6 mm off the surfaces.

    No definition is known whose mesh is too far off: of blades that are thick, twisted or kinked it keeps within half
    the tolerance, or they are refused before (IMP212, IMP214). So its cure makes a mesh in which nothing is taken.
    """

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        with patch.object(model, "off_surfaces", return_value=np.array([0.6])):
            return ended(lambda: impeller_model(built(text), tolerance))

    return tried


def _named(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Write a solid, which is made already, into a file of a name."""
    file = written(IMPELLER, folder)
    with patch.object(models, "impeller_solid") as made:
        made.return_value.step = b"step"
        return ended(lambda: trunnion.write_impeller_step(file, folder / text))


def _twisted(points: str, angle: float) -> str:
    """Points of blades that are turned about Z, more and more from the inlet on."""
    head, *rows = points.splitlines()
    values = np.array([row.split(",") for row in rows], np.float64)
    turns = np.exp(1j * np.linspace(0.0, angle, len(rows)))
    for k in (1, 4):
        turned = (values[:, k] + 1j * values[:, k + 1]) * turns
        values[:, k], values[:, k + 1] = turned.real, turned.imag
    return "\n".join([head, *(",".join(f"{each:.3f}" for each in row) for row in values.tolist()), ""])


def _wound(machine: str) -> Trial:
    """Return what plans a helix whose tool is tilted as the first operation says, on a machine or that of a text."""

    def planned(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        step = built(text).definition.steps[-1]
        moves = winding(10.0, 0.0, 3600.0, 900)
        (folder / "own.toml").write_text(machine, encoding="utf-8")
        loaded = load_machine(str(folder / "own.toml") if "\n" in machine else machine)
        motions = plan(
            [Toolpath("part.cls", (operation_of(replace(moves, tip=40.0 * moves.axis)),))], loaded, 0.001
        ).motions
        return Outcome(tuple(winding_problems("part.toml", step, motions, loaded)), True)

    return planned


_FLAT_HUB: Final = ((7.0, 32.0), (14.0, 33.0), (45.0, 6.0))
_HUB: Final = ((10.0, 35.0), (20.0, 15.0), (45.0, 6.0))
_LARGE: Final = (
    ("bottom_mm = -400.0", "bottom_mm = -4.0"),
    ("height_mm = 480.0", "height_mm = 42.0"),
    ("diameter_mm = 500.0", "diameter_mm = 108.0"),
)
_CROSSING: Final = reduce(lambda text, change: text.replace(*change[::-1]), _LARGE, MIXED)
#: Two blades that go half round the axis.
_WINDING: Final = _twisted(POINTS, 1.5) + "#END\n" + IMPELLER.replace("number = 6", "number = 2")
_mesh: Final = made_of(cache(lambda one: impeller_model(one, 4.0)))
_body: Final = made_of(lambda one: impeller_body(one, _FEW))
_LIMITED: Final = (
    'schema = 1\nextends = "generic_head_table_bc"\nname = "Ours"\n'
    '[[axis]]\nname = "C"\nendless = false\nlimits_deg = [-900, 900]\n'
)
_TILT: Final = ("tilt_deg = 10", "tilt_deg = 0")

CURES: Final = (
    _sized("IMP323", "holder_in_stock", "flute_length_mm = 8\nlength_mm = 10\nshank_diameter_mm = 20"),
    _sized("IMP323", "holder_at_stock", "flute_length_mm = 8\nlength_mm = 23.5\nshank_diameter_mm = 20"),
    _sized("IMP323", "shank_in_stock", "flute_length_mm = 8\nlength_mm = 60\nshank_diameter_mm = 80"),
    _sized("IMP323", "shank_at_stock", "flute_length_mm = 23.5\nlength_mm = 60\nshank_diameter_mm = 80"),
    Cure("IMP310", "no_operations", _cut(), IMPELLER, ((IMPELLER, _COARSE),), cured_by=_cut("STOCK_ROUGHING")),
    Cure("IMP310", "no_such_operation", _cut("ROUGHING"), _COARSE, (), cured_by=_cut("STOCK_ROUGHING")),
    Cure(
        "IMP311",
        "spindle_speed_impossible",
        _cut("STOCK_ROUGHING"),
        _COARSE.replace("rpm = 2000", "rpm = 90000"),
        (("rpm = 90000", "rpm = 2000"),),
    ),
    Cure(
        "IMP410",
        "several_files_to_stdout",
        _cut("STOCK_ROUGHING", output="-"),
        _COARSE,
        (),
        cured_by=_cut("STOCK_ROUGHING"),
    ),
    Cure(
        "IMP410",
        "not_as_written_by_cut",
        _cut("STOCK_ROUGHING", foreign=True),
        _COARSE,
        (),
        cured_by=_cut("STOCK_ROUGHING", output="other"),
    ),
    Cure("IMP411", "no_name_of_step_file", _named, "part.stl", ((".stl", ".stp"),)),
    Cure(
        "IMP420",
        "fillet_reaches_shroud",
        _body,
        IMPELLER.replace("fillet_mm = 2.0", "fillet_mm = 2.6"),
        (("2.6", "2.0"),),
    ),
    Cure("IMP420", "channel_goes_round", _body, _WINDING, (), cured_by=_mesh),
    Cure("IMP420", "hub_shroud_cross", _body, _CROSSING, _LARGE),
    Cure("IMP420", "hub_leads_neither", _led((20.0, 50.0), (10.0, 55.0)), IMPELLER, (), cured_by=_led(*_HUB)),
    Cure("IMP420", "hub_does_not", _led((10.0, 35.0), (45.0, 6.0), (40.0, 9.0)), IMPELLER, (), cured_by=_led(*_HUB)),
    Cure(
        "IMP420",
        "fillet_reaches_farther",
        _led(*_FLAT_HUB, foot=2.5),
        IMPELLER.replace("height_mm = 35.0", "height_mm = 35.0\nbore_mm = 12.0"),
        (),
        cured_by=_led(*_FLAT_HUB, foot=5.0),
    ),
    Cure("IMP220", "facets_would_mm", _faceted(0.5), IMPELLER, (), cured_by=_mesh),
    Cure("IMP220", "bodies_make_no", _mesh, _CROSSING, _LARGE),
    Cure("IMP420", "makes_no_solid", _solid(1, b"it fails"), IMPELLER, (), cured_by=_mesh),
    Cure("IMP421", "open_cascade_makes", _solid(ends=False), IMPELLER, (), cured_by=_mesh),
    Cure("IMP420", "solid_mm_mesh", _solid(volume=50.0), IMPELLER, (), cured_by=_mesh),
    Cure("IMP421", "cannot_load_open", _solid(3, b"no libGL"), IMPELLER, (), cured_by=_solid()),
    Cure("IMP421", "cannot_load_open_cascade", _solid(3), IMPELLER, (), cured_by=_solid()),
    Cure("IMP334", "rewinds_and_turns_back_home", _wound(_LIMITED), _COARSE, (_TILT,)),
    Cure("IMP334", "turns_back_home", _wound("generic_head_table_bc"), _COARSE, (_TILT,)),
    Cure("IMP334", "rewinds", _wound("generic_head_head_ca"), _COARSE, (_TILT,)),
)
