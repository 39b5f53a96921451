"""Whether LinuxCNC and the reader run a program alike."""

import math

import numpy as np

from tests.support.linuxcnc.interpreter import Canon
from trunnion.machines import load_machine
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind

MACHINE = load_machine("xyzac_trt")
COLUMNS = [MACHINE.column(name) for name in "XYZAC"]
KINDS = {"rapid": Kind.RAPID, "line": Kind.LINEAR, "arc": Kind.ARC}


def agree(run: Run, canon: Canon) -> None:
    """The reader's rows are the motions of LinuxCNC, which also prints motions of no length for a G word alone."""
    # Offsets are written, and this machine has no workpiece zero: a fault, which the interpreter itself does not know.
    assert [str(f) for f in run.errors if f.code != "NC352"] == []
    wanted = np.array([move.machine for move in canon.moves]).reshape(-1, 6)[:, [0, 1, 2, 3, 5]]
    kinds = np.array([KINDS[move.kind] for move in canon.moves])
    got = run.joints[:, COLUMNS]
    ours, theirs = moves(run.kind, got), moves(kinds, wanted)
    assert run.kind[ours].tolist() == kinds[theirs].tolist()
    # Offsets and their rotation are printed with four decimals too.
    unit = np.array([move.unit for move in canon.moves])[theirs]
    off = np.abs(got[ours] - wanted[theirs])
    assert (off <= 5e-4 * unit[:, None] + 1e-3).all(), off.max()
    cuts = run.kind[ours] != int(Kind.RAPID)
    plain = cuts & (run.feed_mode[ours] == 94)
    feeds = np.array([move.feed * move.unit for move in canon.moves])[theirs]
    np.testing.assert_allclose(run.feed[ours][plain], feeds[plain], atol=0.05)
    turns = [abs(move.turns) for move in canon.moves if move.kind == "arc"]
    assert [more + 1 for more in run.arcs.full_turns.tolist()] == turns
    dwells = [event.value for event in run.events if event.kind == "dwell"]
    np.testing.assert_allclose([d for d in dwells if isinstance(d, float)], [d for d in canon.dwells if d], atol=1e-4)
    if not got[:, 3:].any():
        circles(run, canon)


def circles(run: Run, canon: Canon) -> None:
    """Centres and senses of circles are those of LinuxCNC; compared only where the tip is where the slides are."""
    for k, move in enumerate(move for move in canon.moves if move.kind == "arc"):
        normal = run.arcs.normal[k]
        plane = int(np.argmax(np.abs(normal)))
        centre = run.arcs.centre[k][[(plane + 1) % 3, (plane + 2) % 3]]
        np.testing.assert_allclose(centre, move.middle, atol=5e-4 * move.unit + 1e-3)
        assert math.copysign(1.0, normal[plane]) == math.copysign(1.0, move.turns)


def moves(kind: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Rows that move, and all circles."""
    before = np.vstack((np.zeros((1, ends.shape[1])), ends[:-1]))
    return np.asarray((np.abs(ends - before).max(axis=1) > 2e-3) | (kind == int(Kind.ARC)))
