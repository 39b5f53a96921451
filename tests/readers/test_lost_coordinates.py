"""A coordinate that a reader accepts does something: it moves, changes what follows, or is told."""

from pathlib import Path

import pytest

from trunnion.machines import Machine, load_machine
from trunnion.readers import run_program

#: What comes before and behind a block, so that whatever it changes shows; by machine, with the form of an axis word.
AROUND = {
    "matsuura_mx330": (
        "%\nO1\nG21 G90 G54 G17\nG0 X1. Y2. Z3. A0. C0.\nF100.\n",
        "X11. Y12. Z13. A5. C5.\nM30\n",
        "{}7.5",
    ),
    "linuxcnc_5axis": ("G21 G90 G54 G17\nG0 X1 Y2 Z3 C0 B0\nF100\n", "G0 X11 Y12 Z13 C5 B5\nM2\n", "{}7.5"),
    "hs664rt": ("G17 Q1\nG90\nG71\nG1 X1. Y2. Z3. A0. C0. F100\n", "G1 X11. Y12. Z13.\nM02\n", "{}7.5"),
    "yl569": ("G71 G90 G54 G17\nG0 X1 Y2 Z3 B0 C0\nF100\n", "G0 X11 Y12 Z13\nM30\n", "{}=7.5"),
    "dmu65": (
        "0 BEGIN PGM A MM\n1 TOOL CALL 1 Z S100\n2 L X+1 Y+2 Z+3 A+0 C+0 R0 FMAX\n3 CC X+1 Y+1\n4 L X+2 F100\n",
        "95 LP PR+5 PA+10\n97 L X+11 Y+12 Z+13 FMAX\n98 M30\n99 END PGM A MM\n",
        "{}+7.5",
    ),
}

BLOCKS = {
    "matsuura_mx330": [
        "G0",
        "G2 I5.",
        "G4 P100",
        "G17",
        "G28",
        "G40",
        "G43 H1",
        "G53 G0",
        "G54",
        "G80",
        "M0",
        "T1",
        "G68 R5.",
        "G69",
    ],
    "linuxcnc_5axis": [
        "G0",
        "G2 I5",
        "G4 P1",
        "G28",
        "G40",
        "G43 H1",
        "G53 G0",
        "G54",
        "G80",
        "G92.1",
        "M0",
        "G10 L2 P1",
        "M428",
    ],
    "hs664rt": ["G1", "G2 I5. J5.", "G4 HD1", "G40", "G55 O1", "G69", "G154", "G196", "G290", "M242", "M306 T.1"],
    "yl569": [
        "G0",
        "G2 I5",
        "G4 F1",
        "G17",
        "SUPA G0",
        "G54",
        "M0",
        "T=1",
        "TRANS",
        "ROT",
        "SCALE",
        "TRAORI",
        "STOPRE",
    ],
    "dmu65": [
        "L",
        "CC",
        "C DR+",
        "CP IPA+30 DR+",
        "LP PR+5 PA+10",
        "M3",
        "STOP",
        "PLANE RESET STAY",
        "M91",
        "TOOL CALL 1 Z",
    ],
}


def outcome(folder: Path, machine: Machine, text: str) -> tuple[object, ...]:
    """Return all that a program does, and what is said of it."""
    path = folder / "a.nc"
    path.write_text(text)
    run = run_program(path, machine)
    events = [(event.kind, str(event.value)) for event in run.events]
    return run.joints.tobytes(), run.kind.tobytes(), events, [str(noted) for noted in run.diagnostics]


@pytest.mark.parametrize("key", AROUND)
def test_no_axis_word_is_lost(key: str, tmp_path: Path) -> None:
    machine = load_machine(key)
    before, behind, form = AROUND[key]
    lost = []
    for block in BLOCKS[key]:
        bare = outcome(tmp_path, machine, f"{before}{block}\n{behind}")
        for letter in ("X", "Y", "Z", *(machine.axes[column].name for column in machine.rotary), "U", "W"):
            word = form.format(letter)
            if outcome(tmp_path, machine, f"{before}{block} {word}\n{behind}") == bare:
                lost.append(f"{block} {word}")
    assert lost == []
