"""Door and clamp of a twin, by the words of the machine builder."""

from pathlib import Path

import numpy as np
import pytest
from asyncua import ua

from trunnion.errors import InputError
from trunnion.jobs.twin.serving import twin_program
from trunnion.machines import load_machine
from trunnion.twin.opcua.columns import columns_of
from trunnion.twin.snapshots import TwinProgram
from trunnion.twin.switches import has_switch

_BLOCKS = "{way}M64\n{cut}M65\n{back}M66\n"
PROGRAMS = {
    "yl569": (
        "a.mpf", "N1 G40 G17 G710 G94 G90 G60\nG54 D1\nM63\nG0 X0 Y0 Z50 B0 C0\n", "M30\n",
        {"way": "G1 Z40 F600\n", "cut": "G1 X10\n", "back": "G1 X20\n"},
    ),
    "mikron_600u": (
        "a.h", "BEGIN PGM A MM\nM63\nL X+0 Y+0 Z+50 R0 FMAX\n", "M30\nEND PGM A MM\n",
        {"way": "L Z+40 F600\n", "cut": "L X+10\n", "back": "L X+20\n"},
    ),
    "matsuura_mx330": (
        "a.nc", "%\nO1\nG21 G17 G90 G54 G94\nM63\nG0 X0. Y0. Z50.\n", "M30\n%\n",
        {"way": "G1 Z40. F600\n", "cut": "G1 X10.\n", "back": "G1 X20.\n"},
    ),
}  # fmt: skip


@pytest.fixture(autouse=True)
def position_type(monkeypatch: pytest.MonkeyPatch) -> None:
    """The structure that a server has once its NodeSets are loaded."""
    monkeypatch.setattr(ua, "CncPositionDataType", dict, raising=False)


def definition(folder: Path, base: str, words: str) -> Path:
    (folder / "ours.toml").write_text(f'schema = 1\nname = "ours"\nextends = "{base}"\n[control.known]\n{words}')
    return folder / "ours.toml"


WORDS = 'M63 = "clamp closes"\nM64 = "door closes: guard"\nM65 = "door opens"\nM66 = "clamp opens"\n'


def states(program: TwinProgram, name: str) -> list[bool | None]:
    """The states of a switch, each once, in their order."""
    times = np.linspace(0.0, program.timed.duration, 4001)
    shown = columns_of(program, program.at(times, np.full(len(times), -1)))[f"block.{name}"]
    return [state for k, state in enumerate(shown) if k == 0 or state is not shown[k - 1]]


@pytest.mark.parametrize("base", PROGRAMS)
def test_words_of_the_builder_switch_door_and_clamp(base: str, tmp_path: Path) -> None:
    name, head, foot, blocks = PROGRAMS[base]
    (tmp_path / name).write_text(head + _BLOCKS.format(**blocks) + foot)
    program = twin_program(tmp_path / name, machine=str(definition(tmp_path, base, WORDS)))
    assert states(program, "door") == [None, True, False]
    assert states(program, "clamp") == [True, False]
    assert columns_of(program, program.before_start())["block.clamp"] == [None]


def test_a_definition_without_such_words_has_no_switch(tmp_path: Path) -> None:
    assert not has_switch(load_machine("yl569"), "door")
    machine = load_machine(definition(tmp_path, "yl569", 'M64 = "door closes"\nM65 = "no effect"\n'))
    assert has_switch(machine, "door")
    assert not has_switch(machine, "clamp")


def test_a_word_does_not_open_what_it_closes(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="exclude"):
        has_switch(load_machine(definition(tmp_path, "yl569", 'M64 = "door closes, door opens"\n')), "door")
