"""Machine code that a wheel brings: one library for the system, or several, of which this processor can run one.

Each kernel's function is named by what it was made from: the files of all functions that are compiled into it, and
their constants. A function of another name is not looked for, so that changed sources never meet old machine code.
"""

import ctypes
import hashlib
from functools import cache
from pathlib import Path
from typing import Any, Final

from trunnion.jit.arguments import Kind
from trunnion.jit.library import HEADER, Entry, is_as_expected

#: Where a wheel has them. A checkout has none.
FOLDER: Final = Path(__file__).parent / "shipped"

#: The library that every processor can load, and its function that gives the level of this one: 2 and 3 are those of
#: x86-64 (``x86-64-v2``, ``x86-64-v3``), 1 is any processor of ARM.
BASE: Final = "kernels-base"
LEVEL: Final = "trunnion_level"


def library_name(level: int) -> str:
    """Return the name of the file with machine code for a level, without what the system appends."""
    return f"kernels-{level}"


def function_name(digest: str) -> str:
    """Return the name of a kernel's function."""
    return f"trunnion_{digest}"


@cache
def shipped_library(folder: Path = FOLDER) -> ctypes.CDLL | None:
    """Load the library for this processor; None where none was brought, or none fits."""
    if not folder.is_dir() or not is_as_expected():
        return None
    files = {file.stem: file for file in folder.iterdir() if file.suffix in (".so", ".dll", ".dylib")}
    try:
        level: int = getattr(ctypes.CDLL(str(files[BASE])), LEVEL)()
        best = max(each for each in range(1, level + 1) if library_name(each) in files)
        return ctypes.CDLL(str(files[library_name(best)]))
    except (
        OSError,
        AttributeError,
        KeyError,
        ValueError,
    ):  # a file system that nothing may be run from, an old processor
        return None


def shipped_entry(digest: str, kinds: tuple[Kind, ...], results: tuple[tuple[type, ...], bool]) -> Entry | None:
    """Return a kernel that a wheel brought; None if it brought none, or one of other sources."""
    library = shipped_library()
    function: Any = getattr(library, function_name(digest), None)
    if library is None or function is None:
        return None
    return Entry(ctypes.cast(function, ctypes.c_void_p).value or 0, kinds, results, library)


@cache
def made_by() -> bytes:
    """Return what stands for how machine code is called: the files that say it, and where an array's data are."""
    files = [Path(__file__).with_name(f"{name}.py") for name in ("build", "runtime", "library", "arguments")]
    return b"".join(hashlib.sha256(file.read_bytes()).digest() for file in files) + b"%d" % HEADER
