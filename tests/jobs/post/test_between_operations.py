"""Ways from one operation to the next: what the settings change, and that the proof misses what is taken from them."""

import functools
import re
from dataclasses import replace
from pathlib import Path

import pytest

import trunnion
from tests.support.two_operations import PATHS
from trunnion.options.words import PROOF_SETTINGS
from trunnion.verification import Check

MACHINES = ("yl569", "dmu65", "matsuura_mx330", "haas_umc750", "hs664rt", "xyzac_trt", "linuxcnc_5axis")

#: What leads home along the spindle, and what turns the rotary axes, in the words of each machine.
_HOME = re.compile(r"SUPA G0 Z=|G53 G0 Z|L Z\+560 R0 FMAX M91|M242$")
_TURN = re.compile(r"(?:G0?[01] |L )[ABC][-+\d.]+ [ABC][-+\d.]+( R0 FMAX| F3000)?$")


class _Programs:
    """Programs of this module, with what their checks say of changed ones."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self.post = functools.cache(self._post)

    def _source(self, path: str) -> Path:
        source = self._folder / f"{path}.cls"
        source.write_text(PATHS[path], encoding="utf-8")
        return source

    def _post(self, base: str, path: str, *settings: tuple[str, str]) -> list[str]:
        result = trunnion.post(self._source(path), machine=base, settings=dict(settings))
        assert result.passed
        return (result.text or "").splitlines()

    def checks(self, lines: list[str], base: str, path: str) -> dict[str, Check]:
        program = self._folder / "changed.nc"
        program.write_text("\n".join(lines) + "\n", encoding="utf-8")
        found = trunnion.verify(program, machine=base, cl=self._source(path))
        return {check.key: check for check in found.checks}

    def failing(self, lines: list[str], base: str, path: str, *settings: tuple[str, str]) -> set[str]:
        program = self._folder / "changed.nc"
        program.write_text("\n".join(lines) + "\n", encoding="utf-8")
        repeated = {key: value for key, value in settings if key in PROOF_SETTINGS}
        found = trunnion.verify(program, machine=base, cl=self._source(path), settings=repeated)
        return {check.key for check in found.checks if check.state == "FAIL"}


@pytest.fixture(scope="module")
def programs(tmp_path_factory: pytest.TempPathFactory) -> _Programs:
    return _Programs(tmp_path_factory.mktemp("between"))


def _plain(line: str) -> str:
    """A line without its block number."""
    return re.sub(r"^(N\d+|\d+) ", "", line)


def _between(lines: list[str]) -> list[int]:
    """The lines between the last cut of the first operation and the first cut of the second one."""
    cuts = [k for k, line in enumerate(lines) if re.search(r"F500\.?$", line)]
    return list(range(cuts[0] + 2, cuts[1]))


_RETRACT = ("same_tool", "retract")
_CLEARANCE = ("same_tool", "clearance")
_IN_TURN = ("first_approach", "in_turn")


@pytest.mark.third
@pytest.mark.parametrize("base", MACHINES)
def test_a_tool_that_stays_goes_home_along_the_spindle_alone(base: str, programs: _Programs) -> None:
    lines = programs.post(base, "turned", _RETRACT)
    between = [_plain(lines[k]) for k in _between(lines)]
    homes = [line for line in between if _HOME.search(line)]
    assert len(homes) == 1
    assert not any(re.search(r"SUPA G0 X|G53 G0 X|L X\+0 Y\+0 R0 FMAX M91|M0?5$", line) for line in between)
    assert sum(bool(_TURN.search(line)) for line in between) == 1


@pytest.mark.third
@pytest.mark.parametrize("base", MACHINES)
def test_a_lost_retract_and_a_turn_before_it_are_faults(base: str, programs: _Programs) -> None:
    lines = programs.post(base, "turned", _RETRACT)
    between = _between(lines)
    home = next(k for k in between if _HOME.search(_plain(lines[k])))
    turn = next(k for k in between if _TURN.search(_plain(lines[k])))
    lost = [line for k, line in enumerate(lines) if k != home]
    early = [*lines[:home], lines[turn], *lines[home:turn], *lines[turn + 1 :]]
    assert programs.failing(lines, base, "turned", _RETRACT) == set()
    assert programs.failing(lost, base, "turned", _RETRACT)
    assert "turns" in programs.failing(early, base, "turned", _RETRACT)


@pytest.mark.third
@pytest.mark.parametrize("path", ["three", "tilted", "tcp"])
@pytest.mark.parametrize("base", MACHINES)
def test_at_one_tilt_the_tool_stays_above_all_operations(base: str, path: str, programs: _Programs) -> None:
    lines = programs.post(base, path, _CLEARANCE)
    between = [_plain(lines[k]) for k in _between(lines)]
    assert not any(_HOME.search(line) or _TURN.search(line) for line in between)
    assert programs.failing(lines, base, path, _CLEARANCE) == set()


def _heights(lines: list[str]) -> tuple[int, int]:
    """The line that draws the tool back, and that of the way across."""
    moves = [k for k in _between(lines) if re.match(r"(G[01] |L )?[XYZ][-+.\d]", _plain(lines[k]))]
    return moves[1], moves[2]


@pytest.mark.third
@pytest.mark.parametrize("path", ["three", "tilted", "tcp"])
@pytest.mark.parametrize("base", MACHINES)
def test_a_height_that_is_lost_or_too_low_is_a_fault(base: str, path: str, programs: _Programs) -> None:
    lines = programs.post(base, path, _CLEARANCE)
    up, across = _heights(lines)
    lost = [line for k, line in enumerate(lines) if k != up]
    straight = [line for k, line in enumerate(lines) if k != across]
    assert "home" in programs.failing(lost, base, path, _CLEARANCE)
    assert programs.failing(straight, base, path, _CLEARANCE)
    higher = ("operation_clearance", "12")
    assert "order" in programs.failing(lines, base, path, _CLEARANCE, higher)
    assert "order" in programs.failing(lines, base, path)  # where nothing allows the way
    assert (
        "posted with same_tool=clearance, repeat that (--set same_tool=clearance)"
        in programs.checks(lines, base, path)["order"].summary
    )


@pytest.mark.third
@pytest.mark.parametrize("base", MACHINES)
def test_a_post_that_stays_at_the_part_fails_its_own_proof(base: str, programs: _Programs) -> None:
    """What a template of the shop takes from the way home, the post itself misses."""
    templates = {"yl569": "TRAFOOF", "dmu65": "M5", "hs664rt": "M5"}
    text = f"""schema = 1
extends = "{base}"
name = "Shop"
[control.settings]
same_tool = "retract"
[control.templates]
leave_three_axis = '''
{templates.get(base, "M9")}
'''
"""
    machine = programs._folder / f"stays_{base}.toml"
    machine.write_text(text, encoding="utf-8")
    with pytest.raises(trunnion.RefusedError, match="without a retract"):
        trunnion.post(programs._source("three"), machine=machine)


@pytest.mark.third
@pytest.mark.parametrize("path", ["tilted", "tools"])
@pytest.mark.parametrize("base", [base for base in MACHINES if base != "hs664rt"])
def test_rotary_axes_that_keep_their_tilt_do_not_return(base: str, path: str, programs: _Programs) -> None:
    home = re.compile(r"B=_B_HOME|[ABC]\+?0\.? [ABC]\+?0\.?( R0 FMAX)?$")
    returning = programs.post(base, path)
    keeping = programs.post(base, path, ("keep_rotary", "on"))
    of_tool = programs.post(base, path, ("keep_rotary", "same_tool"))
    counts = [sum(bool(home.search(_plain(lines[k]))) for k in _between(lines)) for lines in (returning, keeping)]
    assert counts[0] >= 2
    assert counts[1] == 0
    assert of_tool == (keeping if path == "tilted" else returning)
    assert sum(bool(_HOME.search(_plain(line))) for line in keeping) == sum(
        bool(_HOME.search(_plain(line))) for line in returning
    )


@pytest.mark.third
@pytest.mark.parametrize("path", ["three", "tcp"])
@pytest.mark.parametrize("base", MACHINES)
def test_the_first_approach_in_turn_is_proven(base: str, path: str, programs: _Programs) -> None:
    lines = programs.post(base, path, _IN_TURN)
    assert programs.failing(lines, base, path, _IN_TURN) == programs.failing(lines, base, path) == set()
    together = programs.post(base, path)
    if base in ("matsuura_mx330", "haas_umc750", "hs664rt") and path == "three":
        assert together == lines  # these go to X and Y first anyway
    else:
        assert programs.failing(together, base, path, _IN_TURN) == {"modal"}


@pytest.mark.third
@pytest.mark.parametrize(
    ("base", "path"), [*((base, "three") for base in MACHINES), *((base, "tilted") for base in MACHINES[:-2])]
)
def test_a_first_leg_may_go_in_x_and_y_one_after_the_other(base: str, path: str, programs: _Programs) -> None:
    """As templates of a shop may have it: at home height the tool passes places that are no CL points."""
    lines = programs.post(base, path, _IN_TURN)
    across = re.compile(r"(?P<words>(?:G0?[01] .*?|L )?)(?P<x>X\S+) (?P<y>Y\S+)(?P<rest>(?: [^Z].*)?)$")
    home = next(k for k, line in enumerate(lines) if _HOME.search(_plain(line)))
    cut = next(k for k, line in enumerate(lines) if re.search(r"F500\.?$", line))
    leg, found = next(
        (k, match)
        for k in range(home, cut)
        if (match := across.match(_plain(lines[k]))) and not re.search("SUPA|G53|M91", lines[k])
    )
    one, other = (f"{found['words']}{found[axis]}{found['rest']}" for axis in "xy")
    for first, second in ((one, other), (other, one)):
        split = [*lines[:leg], first, second, *lines[leg + 1 :]]
        assert programs.failing(split, base, path, _IN_TURN) == set()
        assert programs.failing([*lines[:leg], first, *lines[leg + 1 :]], base, path, _IN_TURN)
        off = second.replace(found["x"], "X3.").replace(found["y"], "Y3.")
        assert programs.failing([*lines[:leg], first, off, *lines[leg + 1 :]], base, path, _IN_TURN)


@pytest.mark.third
@pytest.mark.parametrize("base", MACHINES)
def test_a_first_leg_under_tcp_may_go_across_and_then_along_z(base: str, programs: _Programs) -> None:
    lines = programs.post(base, "tcp", _IN_TURN)
    whole = re.compile(r"(?P<words>(?:G0?[01] .*?|L )?)(?P<across>X\S+ Y\S+) (?P<z>Z\S+)(?P<rest>.*)$")
    home = next(k for k, line in enumerate(lines) if _HOME.search(_plain(line)))
    leg, found = next(
        (k, match)
        for k in range(home, len(lines))
        if (match := whole.match(_plain(lines[k]))) and not re.search("SUPA|G53|M91", lines[k])
    )
    first = f"{found['words']}{found['across']}{found['rest']}"
    second = f"{re.sub('G43.4 H1 ', '', found['words'])}{found['z']}{found['rest']}"
    split = [*lines[:leg], first, second, *lines[leg + 1 :]]
    assert programs.failing(split, base, "tcp", _IN_TURN) == set()
    low = [*lines[:leg], first, second.replace(found["z"], "Z-3."), *lines[leg + 1 :]]
    assert programs.failing(low, base, "tcp", _IN_TURN)


@pytest.mark.third
@pytest.mark.parametrize(("base", "path"), [(base, path) for base in MACHINES for path in ("two_holes", "tcp")])
def test_halves_of_a_first_leg_under_tcp_may_state_their_height(base: str, path: str, programs: _Programs) -> None:
    lines = programs.post(base, path, _IN_TURN, ("mode", "tcp"))
    whole = re.compile(r"(?P<words>(?:G0?[01] .*?|L )?)(?P<x>X\S+) (?P<y>Y\S+) (?P<z>Z\S+)(?P<rest>.*)$")
    home = next(k for k, line in enumerate(lines) if _HOME.search(_plain(line)))
    leg, found = next(
        (k, match)
        for k in range(home, len(lines))
        if (match := whole.match(_plain(lines[k]))) and not re.search("SUPA|G53|M91", lines[k])
    )
    again = re.sub("G43.4 H1 ", "", found["words"])
    for one, other in ("xy", "yx"):
        first = f"{found['words']}{found[one]} {found['z']}{found['rest']}"
        second = f"{again}{found[other]} {found['z']}{found['rest']}"
        split = [*lines[:leg], first, second, *lines[leg + 1 :]]
        # The tool of the tilted path leans along Y: how high it is nobody knows before Y is stated.
        assert programs.failing(split, base, path, _IN_TURN) == ({"order"} if path == "tcp" and one == "x" else set())
        for k in (leg, leg + 1):
            low = [line.replace(found["z"], "Z-3.") if at == k else line for at, line in enumerate(split)]
            assert programs.failing(low, base, path, _IN_TURN)


@pytest.mark.third
@pytest.mark.parametrize("base", MACHINES)
def test_a_first_leg_before_several_holes_is_proven(base: str, programs: _Programs) -> None:
    lines = programs.post(base, "two_holes", _IN_TURN, ("mode", "tcp"))
    assert programs.failing(lines, base, "two_holes", _IN_TURN) == programs.failing(lines, base, "two_holes") == set()
    leg = next(k for k, line in enumerate(lines) if re.search(r"Z\+?60", line))
    point = next(k for k, line in enumerate(lines) if k > leg and re.search(r"Z\+?50", line))
    lost = [line for k, line in enumerate(lines) if k != point]
    low = [re.sub(r"(Z\+?)60", r"\g<1>20", line) if k == leg else line for k, line in enumerate(lines)]
    assert programs.failing(lost, base, "two_holes", _IN_TURN) & {"order", "tip"}
    assert "order" in programs.failing(low, base, "two_holes", _IN_TURN)


@pytest.mark.parametrize("known", [False, True])
def test_a_first_leg_behind_a_retract_without_a_position_states_its_height(known: bool, programs: _Programs) -> None:
    lines = programs.post("hs664rt", "tcp", _IN_TURN)
    machine = trunnion.load_machine("hs664rt")
    if known:
        machine = replace(machine, workpiece_zero=(0.0, 0.0, -100.0), tool_length=50.0)
    tcp = [k for k, line in enumerate(lines) if _plain(line) == "G196"]
    legs = [next(j for j in range(k, len(lines)) if re.search(r"X.* Y.* Z", lines[j])) for k in tcp]
    assert len(legs) == 2
    for leg in legs:
        text = [re.sub(r" Z[-\d.]+", "", line) if k == leg else line for k, line in enumerate(lines)]
        program = programs._folder / "leg.nc"
        program.write_text("\n".join(text) + "\n", encoding="utf-8")
        source, settings = programs._source("tcp"), dict([_IN_TURN])
        found = trunnion.verify(program, machine=machine, cl=source, settings=settings)
        assert "order" in {check.key for check in found.checks if check.state == "FAIL"}


def test_operations_of_other_tools_and_tilts_go_home(programs: _Programs) -> None:
    assert programs.post("yl569", "tools", _CLEARANCE) == programs.post("yl569", "tools")
    assert programs.post("yl569", "turned", _CLEARANCE) == programs.post("yl569", "turned", _RETRACT)
    stopping = programs.post("yl569", "three", _CLEARANCE, ("stop_between", "on"))
    stop = next(k for k, line in enumerate(stopping) if _plain(line) == "M1")
    assert any(_HOME.search(_plain(line)) for line in stopping[stop - 4 : stop])


@pytest.mark.third
@pytest.mark.parametrize("height", ["10", "3.5", "25"])
@pytest.mark.parametrize("base", ["yl569", "dmu65", "xyzac_trt"])
def test_faults_of_a_way_above_all_operations_name_the_settings_with_which_it_passes(
    base: str, height: str, programs: _Programs
) -> None:
    lines = programs.post(base, "tilted", _CLEARANCE, ("operation_clearance", height))
    told = programs.checks(lines, base, "tilted")
    assert {key for key, check in told.items() if check.state == "FAIL"} == {"order", "home"}
    for key in ("order", "home"):
        (options,) = re.findall(r"repeat that \((.*)\)", told[key].summary)
        assert options.startswith("--set same_tool=clearance")
        assert ("operation_clearance=3.5" in options) == (height == "3.5")
        settings = dict(option.split("=") for option in re.findall(r"--set (\S+)", options))
        assert programs.failing(lines, base, "tilted", *settings.items()) == set()


def test_a_way_below_the_points_of_other_operations_names_no_setting(programs: _Programs) -> None:
    lines = programs.post("yl569", "three", _CLEARANCE)
    up, across = _heights(lines)
    low = [re.sub(r"Z40\.", "Z30.5", line) if k in (up, across) else line for k, line in enumerate(lines)]
    assert low != lines
    told = programs.checks(low, "yl569", "three")
    assert "without a retract" in told["home"].summary
    assert "repeat" not in told["home"].summary + told["order"].summary


_WITHOUT_TCP = (("tcp", "off"), ("zero", "0,0,-100"), ("tool_length", "50"))
_BEHIND_TURNS = [
    *((base, ()) for base in MACHINES),
    *((base, (("mode", "tcp"),)) for base in MACHINES),
    ("xyzac_trt", _WITHOUT_TCP),
]


def _together(lines: list[str]) -> list[str]:
    """The program with both legs behind its last turn to a cut in one block."""
    turn = _last_turn(lines)
    move = re.compile(r"(G0?[01] |G43 H\d+ |L )?[XYZ][-+.\d]")
    across, along = [k for k in range(turn + 1, len(lines)) if move.match(_plain(lines[k]))][:2]
    words = [word for word in re.findall(r"[XY][-+.\d]+", lines[across]) if f" {word[0]}" not in lines[along]]
    height = re.sub(r" FMAX$|$", lambda end: f" {' '.join(words)}{end[0]}", lines[along], count=1)
    return [height if k == along else line for k, line in enumerate(lines) if k != across]


def _last_turn(lines: list[str]) -> int:
    """The line of the last turn before a hole."""
    last = max(k for k, line in enumerate(lines) if re.search(r"(F|Q206=\+)100\.?($| )", line))
    return max(k for k, line in enumerate(lines[:last]) if _TURN.search(_plain(line).removesuffix(" D1")))


def _modal_places(lines: list[str], base: str, way: tuple[tuple[str, str], ...], programs: _Programs) -> list[int]:
    """The lines of motions that the proof finds to move axes together."""
    program = programs._folder / "behind.nc"
    program.write_text("\n".join(lines) + "\n", encoding="utf-8")
    machine = trunnion.load_machine(base)
    if ("tcp", "off") in way:
        machine = replace(machine, workpiece_zero=(0.0, 0.0, -100.0), tool_length=50.0)
    found = trunnion.verify(program, machine=machine, cl=programs._source("holes"), settings=dict([_IN_TURN]))
    modal = next(check for check in found.checks if check.key == "modal")
    return [place.nc_line for place in modal.places if "together" in place.wording.what]


@pytest.mark.third
@pytest.mark.parametrize(("base", "way"), _BEHIND_TURNS)
def test_axes_go_in_turn_behind_a_turn_within_an_operation(
    base: str, way: tuple[tuple[str, str], ...], programs: _Programs
) -> None:
    lines = programs.post(base, "holes", _IN_TURN, *way)
    assert _modal_places(lines, base, way, programs) == []
    joined = _together(lines)
    assert [line for line in _modal_places(joined, base, way, programs) if line > _last_turn(joined)]


@pytest.mark.third
@pytest.mark.parametrize(("base", "way"), [(base, way) for base, way in _BEHIND_TURNS if way and base != "hs664rt"])
def test_a_program_that_moves_axes_together_behind_a_turn_is_faulted_where_turns_are_wanted(
    base: str, way: tuple[tuple[str, str], ...], programs: _Programs
) -> None:
    lines = programs.post(base, "holes", *way)
    assert [line for line in _modal_places(lines, base, way, programs) if line > _last_turn(lines)]


#: Workpiece zero and tool length at which the first point under TCP is 1.7 mm below home, above it, or just below the
#: end of the travel.
_NEAR_HOME = [(120, "0,0,20", "40"), (60, "0,0,20", "40"), (120, "0,0,21.5", "40"), (0, "0,0,-60", "70")]


@pytest.mark.parametrize(("home", "zero", "length"), _NEAR_HOME)
def test_the_first_approach_goes_in_turn_where_the_point_is_near_home(
    home: int, zero: str, length: str, tmp_path: Path
) -> None:
    machine, source = tmp_path / "ours.toml", tmp_path / "side.cls"
    machine.write_text(f'extends = "xyzac_trt"\nname = "Ours"\n[[axis]]\nname = "Z"\nhome_mm = {home}\n')
    text = PATHS["tcp"].replace("0.0,30.0", "-30.0,40.0").replace("0.0,0.5,0.8", "0.0,-0.5,0.8")
    source.write_text(text.replace("0.0,0.5150381", "0.0,-0.5150381"), encoding="utf-8")
    settings = {"zero": zero, "tool_length": length}
    for way in ({}, dict([_IN_TURN])):
        assert trunnion.post(source, machine=machine, settings={**settings, **way}).passed
