"""Flank milling: what paths leave of published test surfaces, and of the blade of the example.

    PYTHONPATH=src:. python benchmarks/flank.py [SURFACE ...]

It prints the table of docs/flank.md. Everything is measured on a grid of 401 x 61 points of the whole flank by
``trunnion.impeller.flank.measure``, which shares nothing with the fit; seconds are of processor time.
"""

import sys
import time
from pathlib import Path
from typing import Final

import numpy as np
from tests.support.flanks import PUBLISHED, RuledBlade, mill

from trunnion.impeller.definition import read_impeller
from trunnion.impeller.flank.blade_flank import mill_blade_flank
from trunnion.impeller.flank.cutter import FlankCutter
from trunnion.impeller.flank.fit import Limits
from trunnion.impeller.flank.measure import measured_deviations
from trunnion.impeller.impeller import build_impeller

#: Half the angle of the cone, degrees; the feed, mm/min.
_CONE: Final = 3.0
_FEED: Final = 200.0


#: Of surfaces on which others printed less overcut than is left where both count the same: side, limit of overcut (mm),
#: and what was printed (um).
_LIMITED: Final = {"high twist": (1.0, 0.106, 112), "S warp": (1.0, 1.0, 3924)}


def main(names: list[str]) -> None:
    """Print the tables, of all surfaces and the blade, or of surfaces by name."""
    print("| surface | side | limit um | left over/under um | overcut at 80 places um | published um | rounds | s |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for name, (side, limit, published) in _LIMITED.items():
        if not names or name in names:
            print(_limited(name, side, limit, published), flush=True)
    print()
    print("| surface | R mm | side | start over/under um | left over/under um | overcut at 80 places um | rounds | s |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for name in names or PUBLISHED:
        for side in (1.0, -1.0):
            print(_row(name, PUBLISHED[name], side), flush=True)
    if names:
        return
    print()
    print("| cutter | side | start over/under um | left over/under um | hub um | other blade mm | until | min | s |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    impeller = build_impeller(
        read_impeller(Path(__file__).resolve().parents[1] / "examples" / "impeller" / "impeller.toml")
    )
    for slope in (0.0, np.sin(np.radians(_CONE))):
        for side in (1.0, -1.0):
            began = time.process_time()
            found = mill_blade_flank(impeller, impeller.blade, side, FlankCutter(2.0, float(slope), 22.0))
            took = time.process_time() - began
            kind = "ball-ended cone, 3°" if slope else "ball-ended cylinder"
            begun, left = found.cut.begun, found.cut.left
            print(
                f"| Ø4 {kind} | {side:+.0f} | {1e3 * begun.overcut:.1f} / {1e3 * begun.undercut:.1f} | "
                f"{1e3 * left.overcut:.1f} / {1e3 * left.undercut:.1f} | {1e3 * found.hub:.1f} | "
                f"{found.neighbour:.2f} | {found.until:.2f} | {found.minutes(_FEED):.2f} | {took:.0f} |"
            )


def _limited(name: str, side: float, limit: float, published: int) -> str:
    """Return the row of a surface whose overcut has a limit."""
    began = time.process_time()
    cut = mill(PUBLISHED[name], side, Limits(overcut=limit))
    took = time.process_time() - began
    coarse = max(0.0, -float(measured_deviations(cut.path, PUBLISHED[name].flank(401, 61, side).flat(), 80).min()))
    return (
        f"| {name} | {side:+.0f} | {1e3 * limit:.0f} | {1e3 * cut.left.overcut:.1f} / {1e3 * cut.left.undercut:.1f} | "
        f"{1e3 * coarse:.1f} | {published} | {cut.rounds} | {took:.0f} |"
    )


def _row(name: str, blade: RuledBlade, side: float) -> str:
    """Return the row of one side of a blade."""
    began = time.process_time()
    cut = mill(blade, side)
    took = time.process_time() - began
    coarse = max(0.0, -float(measured_deviations(cut.path, blade.flank(401, 61, side).flat(), 80).min()))
    begun, left = cut.begun, cut.left
    return (
        f"| {name} | {blade.radius:g} | {side:+.0f} | {1e3 * begun.overcut:.0f} / {1e3 * begun.undercut:.0f} | "
        f"{1e3 * left.overcut:.1f} / {1e3 * left.undercut:.1f} | {1e3 * coarse:.1f} | {cut.rounds} | {took:.0f} |"
    )


if __name__ == "__main__":
    main(sys.argv[1:])
