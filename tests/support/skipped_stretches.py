"""CL files with OPSKIP around random stretches: a post refuses them, or proves what it writes."""

import random
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Final

import trunnion
from tests.support.locations import TESTS
from trunnion.errors import InputError, RefusedError
from trunnion.jobs.post.result import ProofFailedError

#: CL files with contours, holes, circles, planes, five-axis paths, cycles of threads, and compensation.
FILES: Final = tuple(
    TESTS / name
    for name in (
        "data/cases/contour.cls", "data/cases/holes.cls", "data/cases/tilted.cls", "data/cases/tilted_flood.cls",
        "data/hand_made/holes.cls", "data/hand_made/mill.cls", "data/hand_made/swarf.cls", "data/hand_made/tilt.cls",
        "data/heads/tilted_arcs.cls", "data/shop.cls", "golden/compensation/contour_boss.cls",
        "golden/compensation/contour_pocket.cls", "golden/dmu65/bevel.cls", "golden/dmu65/corner.cls",
        "golden/fanuc/flange.cls", "golden/hs664rt/radial_holes.cls", "golden/linuxcnc/plate.cls",
        "golden/mikron_600u/cap.cls", "golden/yl569/2_hub_rough.cls", "golden/yl569_cycles/long_cycles.cls",
    )
)  # fmt: skip

MACHINES: Final = (
    "dmu65", "generic_head_head_ca", "generic_head_table_bc", "generic_nutated_b45_c", "haas_umc750", "hs664rt",
    "linuxcnc_5axis", "matsuura_mx330", "mikron_600u", "ucp800", "xyzac_trt", "xyzbc_trt", "yl569",
)  # fmt: skip

#: Statements before which a stretch may begin or end; one within a line that goes on would be no statement.
_STATEMENT: Final = re.compile(r"(GOTO|CIRCLE|CYCLE|RAPID|FEDRAT|COOLNT|SPINDL|CUTCOM|STOP|DELAY)\b")


def with_skipped_stretches(text: str, seed: int) -> str:
    """The CL text with one or two OPSKIP/ON and OPSKIP/OFF, mostly about a few statements; the same for a seed."""
    draw, lines = random.Random(seed), text.splitlines()
    places = [k for k, line in enumerate(lines) if _STATEMENT.match(line) and not lines[k - 1].endswith("$")]
    stretches = draw.choice((1, 1, 2))
    longest = draw.choice((1, 2, 4, 10, len(places)))
    begin, at = 0, dict[int, str]()
    for left in range(stretches, 0, -1):
        room = len(places) - begin - 2 * left
        if room < 0:
            break
        begin += draw.randint(0, room // left)
        end = min(begin + draw.randint(1, longest), len(places) - 1)
        at |= {places[begin]: "OPSKIP/ON", places[end]: "OPSKIP/OFF"}
        begin = end + 1
    return "".join(f"{at[k]}\n{line}\n" if k in at else f"{line}\n" for k, line in enumerate(lines))


def outcome(file: Path, machine: str, seed: int, folder: Path) -> str:
    """What becomes of a CL file with OPSKIP: ``proven``, ``refused``, or what its own proof says."""
    skipped = folder / f"{file.stem}_{seed}.cls"
    skipped.write_text(with_skipped_stretches(file.read_text(encoding="utf-8"), seed), encoding="utf-8")
    try:
        trunnion.post(skipped, machine=machine)
    except ProofFailedError as error:
        return str(error)
    except (RefusedError, InputError):
        return "refused"
    finally:
        skipped.unlink()
    return "proven"


def faults(draws: Iterable[int], folder: Path) -> tuple[list[str], int]:
    """What fails its own proof among some draws, each of a file, a machine and stretches; and how many are proven."""
    found, proven = list[str](), 0
    for draw in draws:
        file, machine = FILES[draw % len(FILES)], MACHINES[draw // len(FILES) % len(MACHINES)]
        said = outcome(file, machine, draw, folder)
        proven += said == "proven"
        if said not in ("proven", "refused"):
            found.append(f"{file.stem} {machine} {draw}: {said}")
    return found, proven
