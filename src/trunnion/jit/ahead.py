"""Compiling side by side: in one process Numba compiles one function at a time, so that it takes more processes."""

import gc
import logging
import os
import subprocess
import sys
from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

from trunnion.jit.kernels import Kernel, say_once
from trunnion.jit.shipped import shipped_library
from trunnion.jit.store import cache_folder, holds_nothing

_log = logging.getLogger("trunnion.jit")

#: Processes that compile: Python warns of one that is forgotten while it runs, and nobody waits for these.
_compiling: list[subprocess.Popen[bytes]] = []

#: Missing kernels from which on a second process is worth its start.
_WORTH_A_PROCESS = 3


def is_first_run() -> bool:
    """Whether no machine code is on disk."""
    if shipped_library() is not None:
        return False
    folder = cache_folder()
    return folder is None or holds_nothing(folder)


def compile_ahead(kernels: Sequence[Any]) -> None:
    """Have a second process compile the kernels that are not on disk, the last one first.

    This process compiles from the front, each kernel when it is first called, and waits for one that the other process
    has begun: they meet half-way. Does nothing where no kernel is missing.

    kernels  in the order in which they will be called
    """
    missing = [one for one in kernels if isinstance(one, Kernel) and not (one.announced or one.is_kept)]
    if not missing:
        return
    say_once(len(missing))
    for one in missing:
        one.announced = True
    folder = cache_folder()
    if folder is not None and _can_start() and len(missing) >= _WORTH_A_PROCESS:
        _start(folder, [one.name for one in reversed(missing)])


def all_kernels(room: str = "") -> list[Kernel]:
    """Return the kernels of all rooms, or of one; but for those of rooms whose extras are not installed."""
    package = Path(__file__).parents[1]
    found = []
    for file in sorted((package / room).rglob("*.py")):
        if "\n@kernel(" not in file.read_text(encoding="utf-8"):
            continue
        name = ".".join((package.name, *file.relative_to(package).with_suffix("").parts))
        try:
            module = import_module(name)
        except ImportError as error:
            _log.debug("%s: %s", name, error)
            continue
        found += [
            each for each in vars(module).values() if isinstance(each, Kernel) and each.py_func.__module__ == name
        ]
    return found


def compile_all(kernels: Sequence[Kernel], advance: Callable[[int], None]) -> int:
    """Compile the kernels that are not on disk, a process for each processor; return how many there were.

    advance  is told how many more are on disk
    """
    missing = [each for each in kernels if not each.is_kept]
    if not missing:
        return 0
    say_once(len(missing))
    folder, done = cache_folder(), 0
    for each in missing:
        each.announced = True
    others = []
    if folder is not None and _can_start():
        for k in range(min((os.cpu_count() or 1), len(missing)) - 1):
            first = -(k + 1) * len(missing) // (os.cpu_count() or 1)
            others.append(_start(folder, [each.name for each in (*missing[first:], *missing[:first])]))
    for wait in (False, True):  # first what no other process has begun
        for each in missing:
            each.prepare(wait=wait)
            kept = sum(one.is_kept for one in missing)
            advance(kept - done)
            done = kept
    for process in filter(None, others):
        process.wait()
    return len(missing)


def _can_start() -> bool:
    return (os.cpu_count() or 1) > 1 and bool(sys.executable) and not getattr(sys, "frozen", False)


def _start(folder: Path, names: Sequence[str]) -> "subprocess.Popen[bytes] | None":
    """Start another process that compiles; without it, everything is compiled here."""
    package = str(Path(__file__).parents[2])
    path = os.pathsep.join(filter(None, (package, os.environ.get("PYTHONPATH"))))
    call = f"from {__name__} import compile_named; compile_named()"
    _compiling[:] = [process for process in _compiling if process.poll() is None]
    try:
        started = subprocess.Popen(
            [sys.executable, "-c", call, str(folder.parent), *names],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env={**os.environ, "PYTHONPATH": path},
        )
    except OSError as error:
        _log.debug("no other process: %s", error)
        return None
    _compiling.append(started)
    return started


def compile_named() -> None:
    """Compile the kernels that the arguments name, but for those that another process has begun."""
    gc.disable()
    os.environ["NUMBA_CACHE_DIR"], *names = sys.argv[1:]
    for name in names:
        module, _, kernel_name = name.rpartition(".")
        getattr(import_module(module), kernel_name).prepare(wait=False)
