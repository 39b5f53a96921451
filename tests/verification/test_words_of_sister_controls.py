"""Words of sister controls, and words whose meaning only the machine knows: none passes in silence."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

import pytest

import trunnion
from tests.support.locations import TESTS
from trunnion.errors import Problem
from trunnion.jobs.observer import Observer
from trunnion.verification import Check, Verification
from trunnion.verification.results import State

CL = TESTS / "data" / "cases" / "tilted_flood.cls"
TOP = TESTS / "data" / "shop.cls"
HEAD_HEAD = "generic_head_head_ca"


class Told(Observer):
    """What a verification warns of."""

    def __init__(self) -> None:
        self.codes: list[str] = []

    def problems(self, problems: Sequence[Problem]) -> None:
        self.codes += [str(each.code) for each in problems]


def verified(
    machine: str | Path,
    folder: Path,
    written: str,
    becomes: str,
    observer: Told | None = None,
    settings: Mapping[str, str] = MappingProxyType({}),
) -> Verification:
    """Verify a program of which a text becomes another, wherever it stands."""
    program = folder / ("part.h" if machine == "dmu65" else "part.nc")
    trunnion.post(CL, machine=machine, output=program, settings=settings)
    text = program.read_text(encoding="utf-8")
    assert written in text
    program.write_text(text.replace(written, becomes), encoding="utf-8")
    return trunnion.verify(program, machine=machine, cl=CL, observer=observer or Told())


def check_of(found: Verification, key: str) -> Check:
    return next(check for check in found.checks if check.key == key)


@pytest.mark.parametrize(
    ("written", "becomes", "word"),
    [
        (" G196\n", " G96\n", "G96"),
        (" G197\n", " G97\n", "G97"),
        (" S8000 M3\n", " G97 S8000 M3\n", "G97"),
        (" S8000 M3\n", " G96 S8000 M3\n", "G96"),
    ],
)
def test_tcp_of_heads_is_none_of_a_table(written: str, becomes: str, word: str, tmp_path: Path) -> None:
    found = verified("hs664rt", tmp_path, written, becomes)
    assert any(f"{word} switches TCP of a head" in place.text for place in check_of(found, "words").places)


@pytest.fixture
def fork(tmp_path: Path) -> Path:
    """A Fidia with both rotary axes in its head."""
    file = tmp_path / "fork.toml"
    file.write_text(f'extends = "{HEAD_HEAD}"\nname = "Fork"\n[control]\nextends = "fidia_nc15"\n', encoding="utf-8")
    return file


def test_tcp_of_tables_is_none_of_a_head(fork: Path, tmp_path: Path) -> None:
    pair = {"tcp_on": "G96", "tcp_off": "G97"}
    assert verified(fork, tmp_path, " G97\n", " G97\n", settings=pair).passed
    found = verified(fork, tmp_path, " G97\n", " G197\n", settings=pair)
    assert any("G197 switches TCP of a table" in place.text for place in check_of(found, "words").places)


def test_a_definition_that_states_a_pair_has_it(tmp_path: Path) -> None:
    own = tmp_path / "own.toml"
    own.write_text('extends = "hs664rt"\n[control.settings]\ntcp_on = "G96"\ntcp_off = "G97"\n', encoding="utf-8")
    assert verified(own, tmp_path, " G96\n", " G96\n").passed


def test_a_retract_by_word_under_tcp_is_an_error(tmp_path: Path) -> None:
    found = verified("hs664rt", tmp_path, " G197\n", " M242\n")
    assert any("M242 with TCP on" in place.text for place in check_of(found, "words").places)


@pytest.mark.parametrize(
    ("machine", "block", "word"),
    [
        ("dmu65", "FN 14: ERROR= 1000", "FN 14"),
        ("dmu65", "FN 20: WAIT FOR M1==1", "FN 20"),
        ("yl569", "WAITM(1,1,2)", "WAITM"),
        ("yl569", "GET(X)", "GET"),
        ("yl569", "SETAL(65000)", "SETAL(65000)"),
        ("xyzac_trt", "M66 P1 L3 Q2", "M66"),
    ],
)
def test_nothing_waits_in_a_cut(machine: str, block: str, word: str, tmp_path: Path) -> None:
    cl, program = tmp_path / "top.cls", tmp_path / ("part.h" if machine == "dmu65" else "part.nc")
    top = TOP.read_text(encoding="utf-8").partition("END-OF-PATH\n")
    cl.write_text("".join(top[:2]), encoding="utf-8")
    settings = {} if machine == "dmu65" else {"numbers": "off"}
    trunnion.post(cl, machine=machine, output=program, settings=settings)
    lines = program.read_text(encoding="utf-8").splitlines()
    cut = next(k for k, line in enumerate(lines) if "X20" in line or "X+20" in line)
    end = next(k for k, line in enumerate(lines) if line.split()[-1:] in (["M30"], ["M2"]))
    for at, passed in ((cut, False), (end, True)):
        changed = [*lines[:at], block, *lines[at:]]
        if machine == "dmu65":
            changed = [line.partition(" ")[2] if line[0].isdigit() else line for line in changed]
        program.write_text("\n".join(changed) + "\n", encoding="utf-8")
        check = check_of(trunnion.verify(program, machine=machine, cl=cl), "stops")
        assert check.passed == passed, (block, at, check.summary)
        assert passed or f"{word} lets the machine wait" in check.summary


def test_a_basic_rotation_is_not_deleted_unseen(tmp_path: Path) -> None:
    found = verified("dmu65", tmp_path, "* - SIDE", "M143")
    assert any("deletes a basic rotation" in place.text for place in check_of(found, "words").places)


def test_a_place_of_the_builder_is_no_home(tmp_path: Path) -> None:
    told = Told()
    found = verified("dmu65", tmp_path, "FMAX M91", "FMAX M92", told)
    home = check_of(found, "home")
    assert home.state is State.NOT_CHECKED
    assert [each.what for each in home.missing if "M92" in each.what]
    assert told.codes.count("NC224") == 1
