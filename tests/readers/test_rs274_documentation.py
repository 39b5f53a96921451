"""The pages about LinuxCNC, Fanuc and Fidia and their readers do not drift apart."""

import re

import pytest

from tests.support.locations import DOCS
from trunnion.readers.control.iso_m_codes import EVENTS, PROGRAM_ENDS
from trunnion.readers.families.fanuc import cycles as fanuc_cycles
from trunnion.readers.families.fanuc import text as fanuc_text
from trunnion.readers.families.fanuc import variables
from trunnion.readers.families.fanuc import words as fanuc
from trunnion.readers.families.fidia import cycles as fidia_cycles
from trunnion.readers.families.fidia import words as fidia
from trunnion.readers.families.linuxcnc import cycles as linuxcnc_cycles
from trunnion.readers.families.linuxcnc import parameters
from trunnion.readers.families.linuxcnc import text as linuxcnc_text
from trunnion.readers.families.linuxcnc import words as linuxcnc
from trunnion.readers.rs274 import expressions
from trunnion.readers.rs274.block import g_code_text
from trunnion.readers.rs274.interpreter import FEED_MODES, MOTIONS, PLANES

PAGES = {name: (DOCS / f"reader-{name}.md").read_text(encoding="utf-8") for name in ("linuxcnc", "fanuc", "fidia")}
NOT_SIMULATED = {
    name: {word.split("[")[0] for word in re.findall(r"`([^`\n]+)`", page)} for name, page in PAGES.items()
}

COMMON = {*MOTIONS, *PLANES, 900, 910, 800}
G_WORDS = {
    "linuxcnc": {
        *COMMON, *FEED_MODES, *linuxcnc.OFFSETS, *linuxcnc.WITHOUT_PATH_EFFECT, *linuxcnc.LENGTHS,
        *linuxcnc.NOT_SIMULATED, *linuxcnc.TAKEN_AS_LINES, *linuxcnc.NO_MOTION,
        *linuxcnc_cycles.CYCLES, 40, 100, 200, 210, 280, 281, 300, 301, 520, 530, 920, 921, 922, 923, 980, 990,
    },
    "fanuc": {
        *COMMON, *FEED_MODES, *fanuc.OFFSETS, fanuc.MORE_OFFSETS, *fanuc.WITHOUT_PATH_EFFECT, *fanuc.NOT_SIMULATED,
        *fanuc.TAKEN_AS_LINES, *fanuc.NO_MOTION, *fanuc.TAKING_AXIS_WORDS, *fanuc_cycles.CYCLES, fanuc.TCP,
        fanuc.TCP_VECTOR, fanuc.LENGTH_OFF, fanuc.MACHINE, fanuc.ALIGN_TOOL, fanuc.ROTATION_OFF,
        fanuc.MODAL_MACRO_OFF, 200, 210, 980, 990,
    },
    "fidia": {
        *COMMON, fidia.OFFSET, fidia.TAKE_PLANE, fidia.NO_PLANE, fidia.DWELL, fidia.MACHINE, *fidia.TCP_ON,
        *fidia.TCP_OFF, *fidia.UNITS, *fidia.WITHOUT_PATH_EFFECT, *fidia.NOT_SIMULATED, *fidia.NO_MOTION,
        *fidia_cycles.CYCLES,
    },
}  # fmt: skip
M_WORDS = {
    "linuxcnc": {
        *EVENTS,
        *PROGRAM_ENDS,
        6,
        61,
        *linuxcnc.WITHOUT_PATH_EFFECT_M,
        *linuxcnc.NOT_SIMULATED_M,
        linuxcnc.TCP_ON,
        linuxcnc.TCP_OFF,
        430,
    },
    "fanuc": {*EVENTS, *PROGRAM_ENDS, 6, fanuc.CALL, fanuc.RETURN, fanuc.CALL_FILE},
    "fidia": {*EVENTS, *PROGRAM_ENDS, 6, fidia.TOOL, fidia.RETRACT},
}


@pytest.mark.parametrize("name", PAGES)
def test_every_word_is_in_its_page(name: str) -> None:
    assert {g_code_text(code) for code in G_WORDS[name]} - NOT_SIMULATED[name] == set()
    assert {f"M{code}" for code in M_WORDS[name]} - NOT_SIMULATED[name] == set()


@pytest.mark.parametrize(("name", "arithmetic"), [("linuxcnc", parameters.ARITHMETIC), ("fanuc", variables.ARITHMETIC)])
def test_operators_and_functions_are_in_their_pages(name: str, arithmetic: expressions.Arithmetic) -> None:
    assert {operator for level in arithmetic.levels for operator in level} <= NOT_SIMULATED[name]
    assert {*arithmetic.functions, *arithmetic.pairs} <= NOT_SIMULATED[name]


def test_limits_are_those_of_the_pages() -> None:
    plain = " ".join(PAGES["linuxcnc"].split())
    assert f"at most {expressions.MAX_NESTING} deep" in plain
    assert f"at most {linuxcnc_text.MAX_NESTING} deep" in plain
    assert f"equal within {parameters.EQUAL:.4f}" in plain
    assert f"at most {fanuc_text.MAX_NESTING} inside" in PAGES["fanuc"]
