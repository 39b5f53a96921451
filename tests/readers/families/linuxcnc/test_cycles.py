"""Canned cycles, motion by motion, as LinuxCNC's G code reference describes them; worked out by hand.

The tool stands at Z30 and drills at X1. It goes over the hole at that height, at rapid down to R, here Z2, does what
the cycle says, and ends at R (G99) or at Z30, where it was (G98). G73 and G83 peck by Q from R on; after a peck G73
backs off by 0.254 mm, and G83 goes out to R and at rapid back to 0.254 mm above the last depth. G82, G86 and G89 wait
P seconds at the bottom, G74 and G84 where they have a P. G81, G82, G83, G73 and G86 leave at rapid, the others at feed.
"""

import pytest

from tests.support.reading import Runner, slides

#: Block -> motions as (0 rapid or 1 feed, height), and dwells in seconds.
CYCLES: dict[str, tuple[list[tuple[int, float]], list[float]]] = {
    "G98 G81 X1 Z-10 R2 F100": ([(0, 30), (0, 2), (1, -10), (0, 30)], []),
    "G99 G81 X1 Z-10 R2 F100": ([(0, 30), (0, 2), (1, -10), (0, 2)], []),
    "G98 G82 X1 Z-10 R2 P.5 F100": ([(0, 30), (0, 2), (1, -10), (0, 30)], [0.5]),
    "G99 G83 X1 Z-7 R2 Q4 F100": (
        [(0, 30), (0, 2), (1, -2), (0, 2), (0, -1.746), (1, -6), (0, 2), (0, -5.746), (1, -7), (0, 2)], [],
    ),
    "G98 G83 X1 Z-2 R2 Q4 F100": ([(0, 30), (0, 2), (1, -2), (0, 30)], []),
    "G98 G73 X1 Z-7 R2 Q4 F100": (
        [(0, 30), (0, 2), (1, -2), (0, -1.746), (1, -6), (0, -5.746), (1, -7), (0, 30)], [],
    ),
    "G99 G84 X1 Z-10 R2 F100": ([(0, 30), (0, 2), (1, -10), (1, 2)], []),
    "G98 G84 X1 Z-10 R2 P1 F100": ([(0, 30), (0, 2), (1, -10), (1, 30)], [1.0]),
    "M4 G99 G74 X1 Z-10 R2 P.25 F100": ([(0, 30), (0, 2), (1, -10), (1, 2)], [0.25]),
    "G98 G85 X1 Z-10 R2 F100": ([(0, 30), (0, 2), (1, -10), (1, 2), (0, 30)], []),
    "G99 G86 X1 Z-10 R2 P.1 F100": ([(0, 30), (0, 2), (1, -10), (0, 2)], [0.1]),
    "G98 G89 X1 Z-10 R2 P2 F100": ([(0, 30), (0, 2), (1, -10), (1, 30)], [2.0]),
    "G91 G99 G81 X1 Z-12 R-28 F100": ([(0, 30), (0, 2), (1, -10), (0, 2)], []),
    "G98 G81 X1 Z30 R40 F100": ([(0, 40), (0, 40), (1, 30), (0, 40)], []),
    "G33.1 Z-10 K1.25": ([(1, -10), (1, 30)], []),
}  # fmt: skip


@pytest.mark.parametrize("block", CYCLES)
def test_cycles_make_the_motions_of_the_manual(block: str, run: Runner) -> None:
    got = run(f"G21 G90 G17 G94 G0 X0 Y0 Z30 S1000 M3\n{block}\nG80\nM2\n")
    rows = got.line == 2
    motions, dwells = CYCLES[block]
    heights = slides(got)[rows][:, 2].round(9).tolist()
    assert list(zip(got.kind[rows].tolist(), heights, strict=True)) == [(kind, float(z)) for kind, z in motions]
    assert [event.value for event in got.events if event.kind == "dwell"] == dwells
    assert got.diagnostics == ()


@pytest.mark.parametrize("pitch", ["-1.25", "0"])
def test_a_rigid_tap_needs_a_pitch_above_0(pitch: str, run: Runner) -> None:
    got = run(f"G21 G90 G17 G94 G0 X0 Y0 Z30 S1000 M3\nG33.1 Z-10 K{pitch}\nG0 Z5\nM2\n")
    assert [(error.line, "K of G33.1 is not above 0" in error.text) for error in got.errors] == [(2, True)]


def test_a_rigid_tap_goes_by_its_pitch(run: Runner) -> None:
    got = run("G21 G90 G17 G94 G0 X0 Y0 Z30 S1000 M3\nG33.1 Z-10 K1.25\nG0 Z5\nM2\n")
    assert got.feed[got.line == 2].tolist() == [1250.0, 1250.0]
