"""Kernels: functions that run as machine code, and the folders that keep it.

``@kernel`` marks a function that Python calls, ``@inner`` one that only kernels call. Numba compiles a kernel when it
is first called, once, for the types that its signature declares, together with the inner functions it calls.

The machine code is kept on disk under a digest of everything that was compiled into it: the kernel's own code, that of
the functions it calls in whatever file, and their constants. Numba by itself looks at the kernel's own file only. A
change in the sources so renews the kernels that it reaches, and no others. Checksums tell a damaged file, which is
compiled anew.

What a user should know goes to the log ``trunnion.jit``: that kernels are being compiled (INFO), and that machine code
was damaged or cannot be kept (WARNING).
"""

import hashlib
import inspect
import json
import logging
import os
import stat
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from enum import Enum
from functools import cache, cached_property, update_wrapper
from importlib import import_module
from pathlib import Path
from shutil import rmtree
from types import CodeType, FunctionType, ModuleType
from typing import IO, Annotated, Any, TypeVar, cast, get_args, get_origin, get_type_hints

import numba
import numpy as np
from numba.extending import register_jitable

if sys.platform == "win32":
    import msvcrt
    import time
else:
    import fcntl

Function = TypeVar("Function", bound=Callable[..., Any])

#: Kernels that go over bytes keep places as unsigned numbers: Numba asks of every signed index whether it counts from
#: the end, which takes a third of their time. A sum of signed and unsigned would be a float: add ``ONE``, and come
#: back with ``signed``.
unsigned: Any = np.uint64
signed: Any = np.int64
ONE: Any = np.uint64(1)

#: Missing kernels from which on a second process is worth its start.
_WORTH_A_PROCESS = 3

_CHECKSUMS = "checksums.json"
_LOCK = "lock"

_log = logging.getLogger(__name__)

_config: Any = numba.config

#: Held while ``numba.config.CACHE_DIR``, which is the process's, is that of one kernel.
_enabling = threading.Lock()

#: Names of kernels whose compilation has been logged.
_logged: set[str] = set()


def inner(function: Function) -> Function:
    """Compile a function into the kernels that call it. Called from Python, it is the plain function."""
    return register_jitable(function)


def inlined(function: Function) -> Function:
    """Make an inner function part of each of its callers before they are compiled, where calls take too long."""
    return cast(Function, numba.njit(inline="always")(function))


def kernel(*, writes: str = "") -> Callable[[Function], Function]:
    """Compile a function that Python calls, for the types that its signature declares.

    Arrays are C-contiguous and have one dimension, unless their annotation says more (``trunnion.arrays.Floats2``).
    Those that ``writes`` names are written to; the others may be read-only, and of any layout. The function gives up
    the interpreter's lock while it runs.
    """

    def compiled(function: Function) -> Function:
        if _config.DISABLE_JIT:
            return function
        return cast(Function, Kernel(function, frozenset(writes.split())))

    return compiled


class Kernel:
    """A function that is compiled when it is first called, or loaded if its machine code is kept."""

    def __init__(self, function: Callable[..., Any], writes: frozenset[str]) -> None:
        update_wrapper(self, function)
        self.py_func = function
        self.name = f"{function.__module__}.{function.__qualname__}"
        self._writes = writes
        self._dispatcher: Any = numba.njit(nogil=True)(function)
        self._ready = False
        self._preparing = threading.Lock()

    def __call__(self, *arguments: Any) -> Any:
        """Run it. Arrays that it reads are copied if they are not C-contiguous."""
        if not self._ready:
            self.prepare()
        given = list(arguments)
        for k in self._read:
            given[k] = _readable(given[k])
        return self._dispatcher(*given)

    @cached_property
    def types(self) -> tuple[Any, ...]:
        """The Numba types of the arguments."""
        hints = get_type_hints(self.py_func, include_extras=True)
        names = inspect.signature(self.py_func).parameters
        return tuple(_numba_type(hints[name], name in self._writes) for name in names)

    @cached_property
    def _read(self) -> list[int]:
        """Which arguments are, or hold, arrays that it does not write to."""
        return [k for k, kind in enumerate(self.types) if _reads(kind)]

    @cached_property
    def digest(self) -> str:
        """A short name for everything that is compiled into the kernel."""
        digest = hashlib.sha256(repr((self.types, self._dispatcher.targetoptions)).encode())
        for part in _ingredients(self.py_func, set()):
            digest.update(part)
        return digest.hexdigest()[:16]

    @property
    def is_kept(self) -> bool:
        """Whether its machine code is on disk, undamaged."""
        return self._store is not None and self._store.is_whole()

    @property
    def was_loaded(self) -> bool:
        """Whether it runs as it was kept on disk."""
        return self._ready and bool(self._dispatcher.stats.cache_hits)

    def prepare(self, *, wait: bool = True) -> None:
        """Load the machine code, or compile it.

        When another process is compiling it, wait for that process and load what it made; without ``wait``, return.
        """
        with self._preparing:
            if self._ready:
                return
            store = self._store
            if store is None:
                _log_once(self)
                self._dispatcher.compile(self.types)
            elif not self._load(store):
                with store.locked(wait=wait) as held:
                    if not held:
                        return
                    if not self._load(store):  # nor has another process made it meanwhile
                        self._renew(store)
            self._dispatcher.disable_compile()
            self._ready = True

    @cached_property
    def _store(self) -> "_Store | None":
        root = cache_folder()
        return None if root is None else _Store(root, self.name, self.digest)

    def _load(self, store: "_Store") -> bool:
        """Load what is kept; False if there is nothing, or nothing that can be used."""
        if not store.is_whole():
            return False
        try:
            self._compile_into(store)
        except Exception as error:  # whatever the unpickling of a foreign file raises
            _log.warning("the machine code of %s cannot be loaded and is compiled anew: %r", self.name, error)
            store.remove()
            return False
        if not self._dispatcher.stats.cache_hits:  # what is kept was for other processors; now it is for this one too
            with store.locked():
                store.seal()
        return True

    def _renew(self, store: "_Store") -> None:
        """Compile, and keep it."""
        if store.is_sealed:
            _log.warning("the machine code of %s was damaged on disk and is compiled anew", self.name)
        _log_once(self)
        store.make()
        self._compile_into(store)
        store.seal()

    def _compile_into(self, store: "_Store") -> None:
        """Compile and keep it in a folder, or load it from there."""
        with _enabling:
            chosen, _config.CACHE_DIR = _config.CACHE_DIR, str(store.folder)
            try:
                self._dispatcher.enable_caching()
            except RuntimeError:  # "no locator available": the folder cannot be written to any more
                _log.warning("the machine code of %s cannot be kept in %s", self.name, store.folder)
            finally:
                _config.CACHE_DIR = chosen
        try:
            self._dispatcher.compile(self.types)
        except OSError as error:
            if not self._dispatcher.signatures:
                raise
            # It was compiled before it was written.
            _log.warning("the machine code of %s cannot be kept: %s", self.name, error)


def compile_ahead(kernels: Sequence[Any]) -> None:
    """Have the kernels that are not on disk compiled by a second process, the last one first.

    This process compiles from the front, each kernel when it is called: both meet half-way. Does nothing where nothing
    is missing.

    Parameters
    ----------
    kernels
        In the order in which they will be called.
    """
    missing = [one for one in kernels if isinstance(one, Kernel) and not one.is_kept]
    if not missing:
        return
    _log.info("compiling %d kernels for this computer, once; this takes some seconds", len(missing))
    _logged.update(one.name for one in missing)
    folder = cache_folder()
    alone = (os.cpu_count() or 1) < 2 or not sys.executable or getattr(sys, "frozen", False)
    if folder is None or alone or len(missing) < _WORTH_A_PROCESS:
        return
    command = [sys.executable, "-c", "from trunnion.jit import compile_named; compile_named()", str(folder.parent)]
    path = [str(Path(__file__).parents[1]), os.environ.get("PYTHONPATH", "")]
    try:
        subprocess.Popen(
            [*command, *(one.name for one in reversed(missing))],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, path))},
        )
    except OSError as error:
        _log.debug("no second process: %s", error)


def compile_named() -> None:
    """What the second process of ``compile_ahead`` does: compile the kernels that its arguments name."""
    _config.CACHE_DIR, *names = sys.argv[1:]
    for name in names:
        module, _, kernel_name = name.rpartition(".")
        getattr(import_module(module), kernel_name).prepare(wait=False)


@cache
def cache_folder() -> Path | None:
    """The folder in which machine code is kept; None if no folder can be written to.

    It is the one that the user has chosen for Numba (``NUMBA_CACHE_DIR``), the package's own, the user's, or one for
    the user among the temporary ones.
    """
    for folder in _candidates():
        try:
            folder.mkdir(parents=True, exist_ok=True)
            tempfile.TemporaryFile(dir=folder).close()
        except OSError:
            continue
        return folder
    _log.warning("no folder can be written to: kernels are compiled in every run; NUMBA_CACHE_DIR can name a folder")
    return None


def _candidates() -> Iterator[Path]:
    version = f"trunnion-{sys.implementation.cache_tag}-numba-{numba.__version__}"
    if _config.CACHE_DIR:
        yield Path(_config.CACHE_DIR) / version
    yield Path(__file__).parent / "__pycache__" / version
    local = os.environ.get("LOCALAPPDATA")
    yield (Path(local) if local else Path("~/.cache").expanduser()) / "trunnion" / version
    if hasattr(os, "getuid"):
        shared = Path(tempfile.gettempdir()) / f"trunnion-{os.getuid()}"
        if _is_private(shared):
            yield shared / version
    else:
        yield Path(tempfile.gettempdir()) / "trunnion" / version


def _is_private(folder: Path) -> bool:
    """Whether a folder, made if need be, is the user's alone: machine code that others can write to is not run."""
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
        found = folder.lstat()
    except OSError:
        return False
    return stat.S_ISDIR(found.st_mode) and found.st_uid == os.getuid() and not found.st_mode & 0o077


def _log_once(one: Kernel) -> None:
    if one.name not in _logged:
        _logged.add(one.name)
        _log.info("compiling the kernel %s, once", one.name)


def _numba_type(annotation: Any, written: bool) -> Any:
    """The Numba type of an argument, by its annotation."""
    scalars = {int: numba.int64, float: numba.float64, bool: numba.boolean}
    if annotation in scalars:
        return scalars[annotation]
    size, from_types = 1, cast(Callable[..., Any], numba.types.BaseTuple.from_types)
    if get_origin(annotation) is Annotated:
        annotation, size = get_args(annotation)
    if get_origin(annotation) is np.ndarray:
        (kind,) = get_args(get_args(annotation)[1])
        return numba.types.Array(numba.from_dtype(np.dtype(kind)), size, "C", readonly=not written)
    if get_origin(annotation) is tuple:
        parts = get_args(annotation)
        parts = parts[:1] * size if parts[1:] == (...,) else parts
        return from_types([_numba_type(part, written) for part in parts])
    if hasattr(annotation, "_fields"):
        fields = get_type_hints(annotation, include_extras=True)
        return from_types([_numba_type(fields[name], written) for name in annotation._fields], annotation)
    raise TypeError(f"no Numba type for {annotation}")


def _reads(kind: Any) -> bool:
    """Whether an argument of a type is, or holds, an array that is not written to."""
    if isinstance(kind, numba.types.Array):
        return not kind.mutable
    parts: Any = kind if isinstance(kind, numba.types.BaseTuple) else ()
    return any(_reads(part) for part in parts)


def _readable(value: Any) -> Any:
    """An array, or a named tuple with arrays, as a kernel reads it."""
    if isinstance(value, np.ndarray):
        return np.ascontiguousarray(value)
    # Numba takes an array that may be written to for a read-only one, but not within a tuple.
    return type(value)(*(_read_only(part) if isinstance(part, np.ndarray) else part for part in value))


def _read_only(array: Any) -> Any:
    view = np.ascontiguousarray(array).view()
    view.flags.writeable = False
    return view


def _ingredients(value: Any, seen: set[int]) -> Iterator[bytes]:
    """Everything that is compiled into a function, or that a constant is, as bytes."""
    if id(value) in seen:
        return
    if hasattr(value, "py_func"):
        seen.add(id(value))
        yield repr(getattr(value, "targetoptions", "")).encode()
        yield from _ingredients(value.py_func, seen)
    elif isinstance(value, FunctionType):
        seen.add(id(value))
        yield from _ingredients((value.__code__, value.__defaults__), seen)
        for cell in value.__closure__ or ():
            yield from _ingredients(cell.cell_contents, seen)
        for code in _codes(value.__code__):
            for name in code.co_names:
                if name in value.__globals__:
                    yield name.encode()
                    yield from _ingredients(_of_module(value.__globals__[name], code.co_names), seen)
    elif isinstance(value, CodeType):
        yield value.co_code
        yield repr((value.co_names, value.co_varnames)).encode()
        yield from _ingredients(value.co_consts, seen)
    elif isinstance(value, np.ndarray | np.generic):
        yield repr((value.dtype, value.shape)).encode()
        yield value.tobytes()
    elif isinstance(value, type) and issubclass(value, Enum):
        yield repr([(name, member.value) for name, member in value.__members__.items()]).encode()
    elif isinstance(value, type):
        yield repr((value.__name__, getattr(value, "_fields", ()))).encode()
    elif isinstance(value, tuple | list):
        for part in value:
            yield from _ingredients(part, seen)
        yield b"end"
    elif isinstance(value, int | float | complex | str | bytes | None):
        yield repr(value).encode()
    # Numba has no constants of any other kind, but for functions and numbers of other packages.


def _codes(code: CodeType) -> Iterator[CodeType]:
    """A function's code and that of the functions in it."""
    yield code
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _codes(constant)


def _of_module(value: Any, names: Sequence[str]) -> Any:
    """What a function may take from a module of this package by these names; any other value itself."""
    if isinstance(value, ModuleType) and value.__name__.startswith(f"{__package__}."):
        return [getattr(value, name) for name in names if hasattr(value, name)]
    return value


class _Store:
    """The folder that keeps the machine code of one kernel, with a checksum of each file."""

    def __init__(self, root: Path, name: str, digest: str) -> None:
        self._root = root
        # Short, for Windows, where whole paths have 260 characters.
        self._prefix = f"{name.rpartition('.')[2]}-{hashlib.sha256(name.encode()).hexdigest()[:6]}-"
        self.folder = root / f"{self._prefix}{digest}"

    @property
    def is_sealed(self) -> bool:
        """Whether it was once complete."""
        return (self.folder / _CHECKSUMS).exists()

    def is_whole(self) -> bool:
        """Whether it is complete and undamaged."""
        try:
            sums = json.loads((self.folder / _CHECKSUMS).read_text(encoding="utf-8"))
            return bool(sums) and sums == self._sums(list(sums))
        except (OSError, ValueError):
            return False

    def seal(self) -> None:
        """Take down the checksums: from here on it is complete."""
        files = [str(file.relative_to(self.folder)) for file in self.folder.rglob("*.nb[ic]")]
        text = json.dumps(self._sums(files))
        try:
            part = self.folder / f"{_CHECKSUMS}.{os.getpid()}"
            part.write_text(text, encoding="utf-8")
            part.replace(self.folder / _CHECKSUMS)
        except OSError as error:
            _log.debug("%s: %s", self.folder, error)

    def make(self) -> None:
        """Make it empty, and remove what other states of the sources left."""
        self.remove()
        for old in self._root.glob(f"{self._prefix}*"):
            if old != self.folder:
                rmtree(old, ignore_errors=True)

    def remove(self) -> None:
        """Remove all but the lock."""
        (self.folder / _CHECKSUMS).unlink(missing_ok=True)
        for found in self.folder.glob("*/"):
            rmtree(found, ignore_errors=True)

    @contextmanager
    def locked(self, *, wait: bool = True) -> Iterator[bool]:
        """Keep other processes from compiling into it; gives False if one does and ``wait`` is off.

        The system lifts the lock of a process that ends. Where there are no locks, processes do the same work twice.
        """
        with ExitStack() as held:
            try:
                self.folder.mkdir(parents=True, exist_ok=True)
                free = _lock(held.enter_context((self.folder / _LOCK).open("ab")), wait)
            except OSError:
                free = True
            yield free

    def _sums(self, files: Sequence[str]) -> dict[str, str]:
        return {file: hashlib.sha256((self.folder / file).read_bytes()).hexdigest() for file in files}


if sys.platform == "win32":

    def _lock(file: IO[bytes], wait: bool) -> bool:
        """Lock a file until it is closed; False if another process has locked it and ``wait`` is off."""
        file.seek(0)
        while True:
            try:
                msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
            except OSError:
                if not wait:
                    return False
                time.sleep(0.05)
            else:
                return True

else:

    def _lock(file: IO[bytes], wait: bool) -> bool:
        """Lock a file until it is closed; False if another process has locked it and ``wait`` is off."""
        try:
            fcntl.flock(file, fcntl.LOCK_EX if wait else fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return False
        return True
