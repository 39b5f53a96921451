"""A long campaign: ``python -m tests.fuzz.campaign program --seconds 600 --seed 1``.

Mangles and grows files without end and holds every reader to the oracle of the tests. What fails is written beside the
report with its seed. A file that takes longer than ``--patience`` seconds counts as a hang (where the system has
alarms). Exit code 1 if anything failed.
"""

import argparse
import random
import signal
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from typing import NoReturn

from tests.support.fuzz import klartext, oracle, pieces, rs274, seeds
from tests.support.fuzz.mangle import mangle


class Hang(BaseException):
    """A file took too long. No ``except Exception`` may swallow this."""


def _alarm(*_: object) -> NoReturn:
    raise Hang


def a_program(rng: random.Random) -> bytes:
    """Return the bytes of an NC program."""
    grown = pieces.program(rng.randint(1, 60), rng.choice).encode()
    return _mangled(rng, grown, seeds.programs())


def a_cl_file(rng: random.Random) -> bytes:
    """Return the bytes of a CL file."""
    grown = pieces.cl_file(rng.randint(1, 60), rng.choice).encode()
    return _mangled(rng, grown, seeds.cl_files())


def a_klartext(rng: random.Random) -> bytes:
    """Return the bytes of a Klartext program."""
    return _mangled(rng, klartext.program(rng.randint(1, 60), rng.choice).encode(), klartext.SOUND)


def a_rs274(rng: random.Random) -> bytes:
    """Return the bytes of a program of LinuxCNC, Fanuc or Fidia."""
    language = rng.choice(rs274.LANGUAGES)
    return _mangled(rng, language.program(rng.randint(1, 60), rng.choice), language.sound)


def a_definition(rng: random.Random) -> bytes:
    """Return the bytes of a definition."""
    library = [entry.read_bytes() for entry in files("trunnion.machines").joinpath("library").iterdir()]
    return mangle(rng.choice(library), library, rng)


def _mangled(rng: random.Random, grown: bytes, known: tuple[bytes, ...]) -> bytes:
    match rng.randrange(4):
        case 0:
            return grown
        case 1:
            return mangle(grown, known, rng)
        case _:
            return mangle(rng.choice(known), known, rng)


def judge_program(data: bytes, folder: Path, rng: random.Random) -> object:
    """Run a program on one of the machines."""
    return oracle.judge_program(data, folder, rng.choice(oracle.MACHINES))


def judge_klartext(data: bytes, folder: Path, rng: random.Random) -> object:
    """Run a Klartext program on one of the machines."""
    return klartext.judge(data, folder, rng.choice(klartext.MACHINES))


def judge_rs274(data: bytes, folder: Path, rng: random.Random) -> object:
    """Run a program as one of the three languages takes it, whichever it is in."""
    language = rng.choice(rs274.LANGUAGES)
    return language.judge(data, folder, rng.choice(language.machines))


def judge_cl(data: bytes, folder: Path, rng: random.Random) -> object:
    """Read a CL file."""
    return oracle.judge_cl(data, folder, strict=rng.random() < 0.2)


def judge_definition(data: bytes, folder: Path, rng: random.Random) -> object:
    """Read a definition."""
    return oracle.judge_definition(data, folder)


TARGETS: dict[str, tuple[Callable[[random.Random], bytes], Callable[[bytes, Path, random.Random], object]]] = {
    "program": (a_program, judge_program),
    "klartext": (a_klartext, judge_klartext),
    "rs274": (a_rs274, judge_rs274),
    "cl": (a_cl_file, judge_cl),
    "definition": (a_definition, judge_definition),
}


def one(target: str, seed: int, folder: Path, patience: int) -> str:
    """Judge the file of a seed: READ, REFUSED, or what went wrong with its place."""
    make, judge = TARGETS[target]
    rng = random.Random(seed)
    data = make(rng)
    if hasattr(signal, "alarm"):
        signal.signal(signal.SIGALRM, _alarm)
        signal.alarm(patience)
    try:
        return "READ" if judge(data, folder, rng) is not None else "REFUSED"
    except (Exception, Hang) as error:
        place = traceback.extract_tb(error.__traceback__)[-1]
        return f"{type(error).__name__} {str(error)[:150]} in {Path(place.filename).name}:{place.lineno}"
    finally:
        if hasattr(signal, "alarm"):
            signal.alarm(0)


def main() -> int:
    """Run from the command line."""
    parser = argparse.ArgumentParser(description="Fuzz a reader for a while.")
    parser.add_argument("target", choices=[*TARGETS, "every"])
    parser.add_argument("--seconds", type=float, default=600.0)
    parser.add_argument("--seed", type=int, default=0, help="first seed; the next ones follow")
    parser.add_argument("--patience", type=int, default=30, help="seconds after which a file is a hang")
    parser.add_argument("--keep", type=Path, help="folder for the files that failed")
    arguments = parser.parse_args()
    targets = [*TARGETS] if arguments.target == "every" else [arguments.target]
    outcomes: Counter[str] = Counter()
    slowest = 0.0, 0
    end = time.monotonic() + arguments.seconds
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        oracle.prepare(folder)
        klartext.prepare(folder)
        seed = arguments.seed
        while time.monotonic() < end:
            start = time.monotonic()
            target = targets[seed % len(targets)]
            outcome = one(target, seed, folder, arguments.patience)
            slowest = max(slowest, (time.monotonic() - start, seed))
            failed = outcome not in ("READ", "REFUSED")
            if failed and outcome not in outcomes:
                print(f"{target}, seed {seed}: {outcome}", flush=True)
                if arguments.keep:
                    rng = random.Random(seed)
                    (arguments.keep / f"{target}-{seed}").write_bytes(TARGETS[target][0](rng))
            outcomes[outcome] += 1
            seed += 1
    print(
        f"{outcomes.total()} files from seed {arguments.seed}; the slowest, seed {slowest[1]}, took {slowest[0]:.2f} s"
    )
    for outcome, count in outcomes.most_common():
        print(f"{count:8d}  {outcome}")
    return 1 if set(outcomes) - {"READ", "REFUSED"} else 0


if __name__ == "__main__":
    sys.exit(main())
