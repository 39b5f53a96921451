"""Cures of messages about definitions of impellers, and about the bodies that they make."""

from collections.abc import Mapping
from pathlib import Path
from typing import Final

from tests.support.cures.cure import Cure, Outcome, Trial
from tests.support.cures.reading import ended
from tests.support.example_impellers import EXAMPLES
from trunnion.errors import Problem
from trunnion.impeller.definition import read_impeller
from trunnion.impeller.faults import fillet_faults, no_place
from trunnion.impeller.fillet import FilletError, root_fillet, root_stations
from trunnion.impeller.impeller import build_impeller
from trunnion.impeller.machining import step_paths

POINTS: Final = (EXAMPLES / "blade_points.csv").read_text(encoding="utf-8")
IMPELLER: Final = (EXAMPLES / "impeller.toml").read_text(encoding="utf-8").partition("[[tool]]")[0]
#: A mixed-flow impeller, with its table of points before it.
MIXED: Final = (
    (EXAMPLES / "mixed_flow_points.csv").read_text(encoding="utf-8")
    + "#END\n"
    + (EXAMPLES / "mixed_flow.toml")
    .read_text(encoding="utf-8")
    .partition("[[tool]]")[0]
    .replace("mixed_flow_points.csv", "blade_points.csv")
)
TOOLS: Final = """[[tool]]
number = 1
kind = "flat"
diameter_mm = 20
flute_length_mm = 40
length_mm = 60

[[tool]]
number = 4
kind = "ball"
diameter_mm = 4
flute_length_mm = 12
length_mm = 60

"""
STEP: Final = '[[operation]]\nkind = "blade finish"\ntool = 4\nstepover_mm = 0.2\nrpm = 8000\nfeed_mm_min = 200\n'
_ROUGHING: Final = (
    STEP.replace("blade finish", "stock roughing").replace("tool = 4", "tool = 1").replace("0.2", "18")
    + "step_down_mm = 1.5\n"
)


def written(text: str, folder: Path, points: str = POINTS) -> Path:
    """Write a definition, and its points beside it and above it."""
    own = folder / "own"
    own.mkdir(exist_ok=True)
    for place in (own, folder):
        (place / "blade_points.csv").unlink(missing_ok=True)
        (place / "blade_points.csv").write_text(points, encoding="utf-8")
    (own / "part.toml").write_text(text, encoding="utf-8")
    return own / "part.toml"


def _read(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    return ended(lambda: read_impeller(written(text, folder)))


def _with_link(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Read a definition whose table of points is a link that leads out of its folder."""
    file = written(text, folder)
    (file.parent / "blade_points.csv").unlink()
    (file.parent / "blade_points.csv").symlink_to(folder / "blade_points.csv")
    return ended(lambda: read_impeller(file))


def _built(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Build the bodies of an impeller; a table of points may stand before its definition."""
    points, _, definition = text.rpartition("#END\n")
    heard: list[Problem] = []
    return ended(
        lambda: heard.extend(build_impeller(read_impeller(written(definition, folder, points or POINTS))).remarks),
        heard,
    )


def _filleted(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Roll the ball of the fillet along the root of the blade."""
    impeller = build_impeller(read_impeller(written(text, folder)))
    definition = impeller.definition
    stations = root_stations(60, 24, round_trailing=definition.trailing_edge == "round")
    try:
        fillet = root_fillet(impeller.blade, impeller.hub, definition.fillet, stations)
    except FilletError as error:
        return Outcome((no_place(definition, error),), False)
    found = tuple(fillet_faults(definition, fillet.centre, definition.fillet, list(impeller.blades())))
    return Outcome(found, not found)


def _pathed(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    return ended(lambda: next(step_paths(build_impeller(read_impeller(written(text, folder))), None)))


def _line(code: str, variant: str, text: str, old: str, new: str, trial: Trial = _read) -> Cure:
    """A definition in which a text is wrong, and what stands in its place: by default what stood there."""
    assert old in text, old
    return Cure(code, variant, trial, text.replace(old, new, 1), ((new, old),))


def _bodies(code: str, variant: str, old: str, new: str) -> Cure:
    return _line(code, variant, IMPELLER, old, new, _built)


def _points(code: str, variant: str, old: str, new: str) -> Cure:
    """Points that are wrong, and those in their place."""
    return _line(code, variant, f"{POINTS}#END\n{IMPELLER}", old, new, _built)


_ROW_19: Final = "19,56.603,9.558,15.569,54.799,13.198,8.648"
_ROW_20: Final = "20,59.049,10.469,14.851,58.174,14.771,8.721"
_HEAD: Final = POINTS.partition("\n")[0] + "\n"
_ROWS: Final = (
    "11,43.011,-0.918,28.141,30.132,1.590,18.209\n"
    "12,43.841,0.788,26.172,32.718,3.038,16.091\n"
    "13,44.931,2.402,24.227,35.429,4.621,14.109"
)
#: The hub goes aside for 12 mm and comes back.
_LOOP: Final = (
    "11,43.011,-0.918,28.141,27.687,12.0,20.782\n"
    "12,43.841,0.788,26.172,29.5,12.0,19.5\n"
    "13,44.931,2.402,24.227,29.5,1.5,19.5"
)
_DOWN: Final = (
    (_ROW_19, "19,55.2,9.1,13.5,52.2,12.2,5.9"),
    (_ROW_20, "20,55.5,9.3,10.0,52.5,12.4,2.5"),
)
_AXIAL: Final = ("20,59.049,10.469,14.851,58.174,14.771,8.721", "20,56.603,9.558,9.000,54.799,13.198,2.000")
_ROUND: Final = IMPELLER.replace('"cut"', '"round"')
_ALL: Final = IMPELLER + TOOLS + STEP
_TWO: Final = _ALL + STEP.replace("kind", 'name = "OTHER"\nkind')

CURES: Final = (
    _line("IMP216", "not_less_diameter", IMPELLER, "height_mm = 35.0", "height_mm = 35.0\nbore_mm = 90.0"),
    _line("IMP216", "is", IMPELLER, '"blade_points.csv"', '"../blade_points.csv"'),
    Cure("IMP216", "leads_out_folder", _with_link, IMPELLER, (), cured_by=_read),
    _line("IMP216", "not_least_two", IMPELLER, '["hub", "tip"]', '["hub"]'),
    _line("IMP216", "names_no_kind", IMPELLER, "diameter_mm = 90.0", 'premachined = ["grinding"]\ndiameter_mm = 90.0'),
    _line("IMP216", "empty", IMPELLER, '"blade_points.csv"', '""'),
    _line("IMP216", "names_not", IMPELLER, '["hub", "tip"]', '["hub", "shroud"]'),
    _line("IMP312", "is", _ALL, "number = 4", 'number = 4\nname = "A\\nB"'),
    _line("IMP312", "mill", _ALL, "tool = 4", "tool = 1"),
    _line("IMP312", "not_among_tools", _ALL, "tool = 4", "tool = 5"),
    _line("IMP312", "flutes_tool_mm", IMPELLER + TOOLS + _ROUGHING, "step_down_mm = 1.5", "step_down_mm = 50"),
    _line("IMP312", "tool_mm_wide", IMPELLER + TOOLS + _ROUGHING, "stepover_mm = 18", "stepover_mm = 25"),
    _line("IMP312", "needs_either_stepover", _ALL, "stepover_mm = 0.2", "stepover_mm = 0.2\nscallop_mm = 0.1"),
    _line("IMP312", "too", _TWO, 'name = "OTHER"', 'name = "BLADE_FINISH"'),
    _line("IMP312", "makes_same_file", _TWO, 'name = "OTHER"', 'name = "BLADE FINISH"'),
    Cure("IMP310", "no_operation", _pathed, IMPELLER, ((IMPELLER, IMPELLER + TOOLS + _ROUGHING),)),
    _bodies("IMP215", "blade_reaches_radius", "scale = 0.75", "scale = 0.0001"),
    _bodies("IMP215", "reaches_height_here", "height_mm = 35.0", "height_mm = 30.0"),
    _bodies("IMP215", "reaches_down_height", "height_mm = 35.0", "height_mm = 35.0\nbottom_mm = 7.0"),
    _bodies("IMP215", "begins_radius_mm", "diameter_mm = 90.0", "diameter_mm = 60.0"),
    _bodies("IMP215", "goes_radius_mm", "diameter_mm = 90.0", "diameter_mm = 88.0"),
    _line("IMP215", "reaches_radius_mm", _ROUND, "diameter_mm = 90.0", "diameter_mm = 80.0", _built),
    _bodies("IMP215", "stock_bore_mm", "height_mm = 35.0", "height_mm = 35.0\nbore_mm = 40.0"),
    _bodies("IMP212", "blades_overlap_mm", "number = 6", "number = 40"),
    _line(
        "IMP214",
        "fillet_mm_no",
        IMPELLER.replace("number = 6", "number = 12").replace("2.0\n\n[stock", "1.0\n\n[stock"),
        "fillet_mm = 1.0",
        "fillet_mm = 3.0",
        _filleted,
    ),
    _line("IMP214", "fillet_mm_finds", IMPELLER, "fillet_mm = 2.0", "fillet_mm = 10.0", _filleted),
    _bodies("IMP210", "mm_below_named", '["hub", "tip"]', '["tip", "hub"]'),
    _points("IMP210", "same_here_named", "1,35.515,-21.597,44.149", "1,11.690,-12.681,46.682"),
    _points("IMP211", "crosses_itself_nearly", _ROWS, _LOOP),
    _line("IMP213", "blade_does_not", f"{POINTS}#END\n{_ROUND}", *_AXIAL, _built),
    Cure(
        "IMP213",
        "trailing_edge_does",
        _built,
        f"{POINTS.replace(*_DOWN[0]).replace(*_DOWN[1])}#END\n{IMPELLER}",
        (('"cut"', '"round"'),),
    ),
    _points("IMP210", "goes_upward_inward", POINTS, _HEAD + "".join(reversed(POINTS.splitlines(keepends=True)[1:]))),
    _bodies("IMP213", "blade_goes_straight", "diameter_mm = 90.0", "diameter_mm = 190.0"),
)
