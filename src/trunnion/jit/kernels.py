"""The decorators that make kernels, and the life of a kernel: declared, loaded or compiled, called."""

import hashlib
import logging
import os
import threading
from collections.abc import Callable, Iterable
from functools import cached_property, update_wrapper
from typing import TYPE_CHECKING, Any, TypeVar, cast

from trunnion.jit.arguments import Kind, argument_kinds, result_kinds
from trunnion.jit.digest import ingredients, of_source
from trunnion.jit.library import Entry, from_object, loaded
from trunnion.jit.shipped import made_by, shipped_entry, shipped_library
from trunnion.jit.store import Store, cache_folder
from trunnion.messages import Wording, phrase

if TYPE_CHECKING:
    from trunnion.jit.judge import Judge

Function = TypeVar("Function", bound=Callable[..., Any])

_log = logging.getLogger("trunnion.jit")

#: What has been said of compiling in this process, which is one line.
_said: list[Wording] = []


def say_once(count: int = 0) -> None:
    """Say that kernels are compiled, and how many if that is known: the first time in this process only."""
    if not _said:
        _said.append(phrase("compiling_some", count=count) if count else phrase("compiling"))
        _log.info("%s", _said[0])


def kernel(*, writes: str = "", checks_division: bool = True) -> Callable[[Function], Function]:
    """Compile a function that Python calls, for the types that its signature declares.

    Arrays have one dimension, unless their annotation says more (``trunnion.arrays.Floats2``). Those that ``writes``
    names are written to and must be C-contiguous; the others may be read-only, and of any layout. The function gives up
    the interpreter's lock while it runs.

    A division by zero raises, but for a kernel without ``checks_division``: there it gives an infinity or NaN, and
    loops that divide can do several steps at a time.
    """

    def compiled(function: Function) -> Function:
        if os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0"):
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
        self._options: dict[str, Any] = {} if checks_division else {"error_model": "numpy"}
        self._entry: Entry | Judge | None = None
        #: Whether it runs machine code that was kept on disk.
        self.was_loaded = False
        #: Whether the log has said that it is compiled.
        self.announced = False
        self._preparing = threading.Lock()

    def __call__(self, *arguments: Any) -> Any:
        """Run it. Arrays that it reads are copied if they are not C-contiguous.

        Raises ``TypeError`` for arguments of other types.
        """
        entry = self._entry
        if entry is None:
            self.prepare()
            entry = self._entry
            assert entry is not None
        return entry(arguments)

    @cached_property
    def kinds(self) -> tuple[Kind, ...]:
        """What the arguments are."""
        return argument_kinds(self.py_func, self._writes)

    @cached_property
    def _results(self) -> tuple[tuple[type, ...], bool]:
        return result_kinds(self.py_func)

    @cached_property
    def digest(self) -> str:
        """A short name for everything that is compiled into the kernel."""
        return self._digest(ingredients(self.py_func))

    @cached_property
    def source_digest(self) -> str:
        """The same by the sources, for all versions of Python.

        Raises ``OSError`` where they cannot be read.
        """
        return self._digest((made_by(), *ingredients(self.py_func, of_source)))

    def _digest(self, parts: Iterable[bytes]) -> str:
        digest = hashlib.sha256(repr((self.kinds, self._results, self._options)).encode())
        for part in parts:
            digest.update(b"%d:" % len(part) + part)  # 1.5 and 23.0 are not 1.52 and 3.0
        return digest.hexdigest()[:16]

    @cached_property
    def shipped(self) -> Entry | None:
        """The machine code of it that the wheel has brought; None where there is none, or none of these sources."""
        if shipped_library() is None:
            return None
        try:
            return shipped_entry(self.source_digest, self.kinds, self._results)
        except OSError:
            return None

    @property
    def is_kept(self) -> bool:
        """Whether its machine code is on disk, undamaged."""
        return self.shipped is not None or (self._store is not None and self._store.whole() is not None)

    def prepare(self, *, wait: bool = True) -> None:
        """Load the machine code, or compile it.

        While another process compiles it, wait, and load what that process made; without ``wait``, return.
        """
        with self._preparing:
            if self._entry is not None:
                return
            if self.shipped is not None:
                self._entry = self.shipped
                return
            store = self._store
            if store is None:
                self._entry = self._made(None)
                return
            self._entry = self._loaded(store)
            if self._entry is None:
                with store.locked(wait=wait) as held:
                    if held:  # perhaps another process has made it meanwhile
                        self._entry = self._loaded(store) or self._made(store)

    def module(self) -> Any:
        """Compile it into a module of LLVM, of which machine code for any processor can be made."""
        from trunnion.jit import build

        return build.kernel_module(self.py_func, self.kinds, self._results, self._options)

    def judge(self) -> "Judge":
        """Compile it by Numba's own way, to compare with."""
        from trunnion.jit.judge import Judge

        return Judge(self.py_func, self.kinds, self._options)

    def _announce(self) -> None:
        if not self.announced:
            self.announced = True
            say_once()

    @cached_property
    def _store(self) -> Store | None:
        root = cache_folder()
        return None if root is None else Store(root, self.name, self.digest)

    def _loaded(self, store: Store) -> Entry | None:
        """Load what is kept; None if there is nothing, or nothing that can be used."""
        file = store.whole()
        if file is None:
            return None
        try:
            entry = loaded(file, self.kinds, self._results)
        except Exception as error:  # whatever the loading of a foreign file raises
            _log.warning("some machine code cannot be loaded and is compiled anew")
            _log.debug("%s: %r", self.name, error)
            store.remove()
            return None
        self.was_loaded = True
        return entry

    def _made(self, store: Store | None) -> "Entry | Judge":
        """Compile it and, with a store, keep it."""
        if store is not None and store.is_sealed:
            _log.warning("some machine code was damaged on disk and is compiled anew")
            _log.debug("damaged: %s", self.name)
        self._announce()
        from trunnion.jit import build
        from trunnion.jit.judge import Judge

        try:
            code = build.object_code(self.py_func, self.kinds, self._results, self._options)
        except build.NotBuiltError as error:
            _log.debug("no library of %s: %s", self.name, error)
            return Judge(self.py_func, self.kinds, self._options, None if store is None else store.folder)
        if store is None:
            return from_object(code, self.kinds, self._results)
        for content in filter(None, (build.shared_library(code), code)):
            try:
                file = store.keep(content, is_linked=content is not code)
            except OSError as error:
                _log.warning("machine code cannot be kept: %s", error)
                _log.debug("not kept: %s", self.name)
                store.remove()
                break
            try:
                return loaded(file, self.kinds, self._results)
            except (OSError, AttributeError) as error:  # as from a file system that nothing may be run from
                _log.debug("no linked library of %s: %s", self.name, error)
        return from_object(code, self.kinds, self._results)
