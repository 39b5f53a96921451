"""The decorators that make kernels, and the life of a kernel: declared, loaded or compiled, called."""

import hashlib
import logging
import threading
from collections.abc import Callable
from functools import cached_property, update_wrapper
from typing import Any, TypeVar, cast

import numba
from numba.extending import register_jitable

from trunnion.jit.argument_types import as_readable, is_read, numba_types
from trunnion.jit.digest import ingredients
from trunnion.jit.store import Store, cache_folder
from trunnion.messages import Wording, phrase

Function = TypeVar("Function", bound=Callable[..., Any])

_log = logging.getLogger("trunnion.jit")

_config: Any = numba.config

#: What has been said of compiling in this process, which is one line.
_said: list[Wording] = []

#: Held while ``numba.config.CACHE_DIR``, which is the process's, is that of one kernel.
_enabling = threading.Lock()


def say_once(count: int = 0) -> None:
    """Say that kernels are compiled, and how many if that is known: the first time in this process only."""
    if not _said:
        _said.append(phrase("compiling_some", count=count) if count else phrase("compiling"))
        _log.info("%s", _said[0])


def inner(function: Function) -> Function:
    """Compile a function into the kernels that call it. Called from Python, it is the plain function."""
    return register_jitable(function)


def inlined(function: Function) -> Function:
    """Copy a function into the kernels that call it before they are compiled, for functions shorter than a call."""
    return cast(Function, numba.njit(inline="always")(function))


def kernel(*, writes: str = "", checks_division: bool = True) -> Callable[[Function], Function]:
    """Compile a function that Python calls, for the types that its signature declares.

    Arrays have one dimension, unless their annotation says more (``trunnion.arrays.Floats2``). Those that ``writes``
    names are written to and must be C-contiguous; the others may be read-only, and of any layout. The function gives up
    the interpreter's lock while it runs.

    A division by zero raises, but for a kernel without ``checks_division``: there it gives an infinity or NaN, and
    loops that divide can do several steps at a time.
    """

    def compiled(function: Function) -> Function:
        if _config.DISABLE_JIT:
            return function
        return cast(Function, Kernel(function, frozenset(writes.split()), checks_division))

    return compiled


class Kernel:
    """A function that is compiled when it is first called, or loaded if its machine code is kept."""

    def __init__(self, function: Callable[..., Any], writes: frozenset[str], checks_division: bool = True) -> None:
        update_wrapper(self, function)
        self.py_func = function
        self.name = f"{function.__module__}.{function.__qualname__}"
        self._writes = writes
        self._options: dict[str, Any] = {"nogil": True} if checks_division else {"nogil": True, "error_model": "numpy"}
        self._ready = False
        self._whole = False
        #: Whether the log has said that it is compiled.
        self.announced = False
        self._preparing = threading.Lock()

    def __call__(self, *arguments: Any) -> Any:
        """Run it. Arrays that it reads are copied if they are not C-contiguous."""
        if not self._ready:
            self.prepare()
        given = list(arguments)
        for k in self._read:
            given[k] = as_readable(given[k])
        return self._dispatcher(*given)

    @cached_property
    def _dispatcher(self) -> Any:
        """What compiles it: made when it is prepared, as most runs need few kernels."""
        return numba.njit(**self._options)(self.py_func)

    @cached_property
    def types(self) -> tuple[Any, ...]:
        """The Numba types of the arguments."""
        return numba_types(self.py_func, self._writes)

    @cached_property
    def _read(self) -> list[int]:
        """Which arguments are, or hold, arrays that it does not write to."""
        return [k for k, kind in enumerate(self.types) if is_read(kind)]

    @cached_property
    def digest(self) -> str:
        """A short name for everything that is compiled into the kernel."""
        options = {**self._options, "nopython": True, "boundscheck": None}  # as Numba keeps them
        digest = hashlib.sha256(repr((self.types, options)).encode())
        for part in ingredients(self.py_func):
            digest.update(b"%d:" % len(part) + part)  # 1.5 and 23.0 are not 1.52 and 3.0
        return digest.hexdigest()[:16]

    @property
    def is_kept(self) -> bool:
        """Whether its machine code is on disk, undamaged."""
        self._whole = self._whole or (self._store is not None and self._store.is_whole())
        return self._whole

    @property
    def was_loaded(self) -> bool:
        """Whether it runs the machine code that was kept on disk."""
        return self._ready and bool(self._dispatcher.stats.cache_hits)

    def prepare(self, *, wait: bool = True) -> None:
        """Load the machine code, or compile it.

        While another process compiles it, wait, and load what that process made; without ``wait``, return.
        """
        with self._preparing:
            if self._ready:
                return
            store = self._store
            if store is None:
                self._announce()
                self._dispatcher.compile(self.types)
            elif self._load(store):
                if self._is_new:
                    with store.locked():
                        store.seal()
            else:
                with store.locked(wait=wait) as held:
                    if not held:
                        return
                    if not self._load(store):  # nor has another process made it meanwhile
                        self._renew(store)
                    elif self._is_new:
                        store.seal()
            self._dispatcher.disable_compile()
            self._ready = True

    def _announce(self) -> None:
        if not self.announced:
            self.announced = True
            say_once()

    @cached_property
    def _store(self) -> Store | None:
        root = cache_folder()
        return None if root is None else Store(root, self.name, self.digest)

    def _load(self, store: Store) -> bool:
        """Load what is kept; False if there is nothing, or nothing that can be used."""
        if not self.is_kept:
            return False
        try:
            self._compile_into(store)
        except Exception as error:  # whatever the unpickling of a foreign file raises
            _log.warning("the machine code of %s cannot be loaded and is compiled anew: %r", self.name, error)
            store.remove()
            self._whole = False
            return False
        return True

    @property
    def _is_new(self) -> bool:
        """Whether what was kept is for another processor or checkout, and this one's was compiled and added."""
        return not self._dispatcher.stats.cache_hits

    def _renew(self, store: Store) -> None:
        """Compile, and keep it."""
        if store.is_sealed:
            _log.warning("the machine code of %s was damaged on disk and is compiled anew", self.name)
        self._announce()
        store.clear()
        self._compile_into(store)
        store.seal()

    def _compile_into(self, store: Store) -> None:
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
