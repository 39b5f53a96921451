"""The library of a kernel, loaded and called: without Numba, and without LLVM where a linker made the library.

A kernel's function takes the address of a block of eight-byte slots and gives 0, or what was wrong. In the block are:

    the arguments, flat: numbers, and addresses of array objects
    the type objects that those arrays must have, in the same order
    room for the results, or for where an exception is described

The function itself looks into the array objects, as every extension module does: the C structure of NumPy's arrays is
part of its public interface. It looks before it runs: type, dimensions, contiguous, writeable.
"""

import ctypes
import struct
import sys
from collections.abc import Callable, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any, Final

import numpy as np

from trunnion.jit.arguments import Array, Kind, UnfitError, fitted, flatten, leaves

#: The name of the function in each library.
ENTRY: Final = "trunnion_kernel"

#: What comes back: 0, one of these, or the first unfit argument and ``UNFIT``.
RAISED: Final = 1
UNFIT: Final = 2

#: Where NumPy keeps things in an array object, from its address on (``PyArrayObject`` in its C interface).
HEADER: Final = object.__basicsize__
DATA: Final = HEADER
DIMENSIONS: Final = HEADER + 8
SHAPE: Final = HEADER + 16
TYPE: Final = HEADER + 40
FLAGS: Final = HEADER + 48

#: Bits of its flags.
CONTIGUOUS: Final = 0x0001
ALIGNED: Final = 0x0100
WRITEABLE: Final = 0x0400

#: Functions of the system that machine code may call, but for those that none needs.
SYSTEM: Final = (
    "malloc", "realloc", "free", "memcpy", "memmove", "memset",
    "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "hypot", "sqrt",
    "pow", "exp", "log", "log10", "log2", "fmod", "floor", "ceil", "trunc", "rint", "round", "nearbyint",
    "copysign", "fabs", "fmin", "fmax", "ldexp", "frexp",
)  # fmt: skip

_FORMATS = {int: "q", float: "d", bool: "?7x"}


class Entry:
    """A kernel that can be called."""

    def __init__(self, address: int, kinds: Sequence[Kind], results: tuple[tuple[type, ...], bool], keeps: Any) -> None:
        self._run = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_void_p)(address)
        self._kinds = kinds
        self._keeps = keeps
        flat = list(leaves(kinds))
        self._types = [id(kind.dtype) for kind in flat if isinstance(kind, Array)]
        self._pack = struct.Struct(
            "".join("q" if isinstance(kind, Array) else _FORMATS[kind] for kind in flat) + "q" * len(self._types)
        )
        self._given, self._is_tuple = results
        self._unpack = struct.Struct("".join(_FORMATS[kind] for kind in self._given))
        self._block = ctypes.c_char * (self._pack.size + 8 * max(len(self._given), 2))

    def __call__(self, arguments: Sequence[Any]) -> Any:
        """Run it.

        Raises what the kernel raises, and ``TypeError`` for arguments that it does not take.
        """
        block = self._block()
        try:
            self._fill(block, arguments)
            status = self._run(block)
        except UnfitError:
            status = UNFIT
        if status >= UNFIT:
            arguments = fitted(self._kinds, arguments)
            self._fill(block, arguments)
            status = self._run(block)
        if status:
            self._raise(block)
        if not self._given:
            return None
        found = self._unpack.unpack_from(block, self._pack.size)
        return found if self._is_tuple else found[0]

    def _fill(self, block: Any, arguments: Sequence[Any]) -> None:
        """Write the arguments into a block.

        Raises ``UnfitError`` where an array is needed and something else is there, and ``TypeError``.
        """
        slots: list[Any] = []
        try:
            flatten(self._kinds, arguments, slots)
            self._pack.pack_into(block, 0, *slots, *self._types)
        except (ValueError, struct.error) as error:
            raise TypeError(f"arguments that the kernel does not take: {error}") from error

    def _raise(self, block: Any) -> None:
        """Raise what the kernel has raised: Numba describes it by a pickle, in the machine code itself."""
        import pickle

        address, size = struct.unpack_from("qq", block, self._pack.size)
        if not address:
            raise RuntimeError("a kernel has failed")
        kind, given, *_ = pickle.loads(ctypes.string_at(address, size))
        raise kind(*(given or ()))

    @cached_property
    def address(self) -> int:
        """Where its machine code is."""
        return ctypes.cast(self._run, ctypes.c_void_p).value or 0


def loaded(file: Path, kinds: Sequence[Kind], results: tuple[tuple[type, ...], bool]) -> Entry:
    """Load a kept library, or object code.

    Raises ``OSError`` or ``RuntimeError`` for one that cannot be loaded.
    """
    if file.suffix == ".o":
        return from_object(file.read_bytes(), kinds, results)
    library = ctypes.CDLL(str(file))
    address = ctypes.cast(getattr(library, ENTRY), ctypes.c_void_p).value
    return Entry(address or 0, kinds, results, library)


def from_object(code: bytes, kinds: Sequence[Kind], results: tuple[tuple[type, ...], bool]) -> Entry:
    """Load object code, for which LLVM links it in memory.

    Raises ``RuntimeError`` where it cannot.
    """
    from llvmlite import binding as llvm

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    find_system(llvm)
    machine = llvm.Target.from_default_triple().create_target_machine()
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), machine)
    engine.add_object_file(llvm.ObjectFileRef.from_data(code))
    engine.finalize_object()
    return Entry(engine.get_function_address(ENTRY), kinds, results, engine)


def find_system(llvm: Any) -> set[str]:
    """Tell LLVM where the functions of the system are that machine code may call; give those that there are."""
    found = set()
    libraries: list[ctypes.CDLL] | None = None
    for name in SYSTEM:
        if not llvm.address_of_symbol(name):
            libraries = _system_libraries() if libraries is None else libraries
            function = next((getattr(each, name) for each in libraries if hasattr(each, name)), None)
            if function is None:
                continue
            llvm.add_symbol(name, ctypes.cast(function, ctypes.c_void_p).value)
        found.add(name)
    return found


def _system_libraries() -> list[ctypes.CDLL]:
    from ctypes.util import find_library

    names = [name for name in map(find_library, ("m", "c", "ucrtbase", "msvcrt")) if name]
    return [ctypes.CDLL(name) for name in names]


def is_as_expected() -> bool:
    """Whether array objects are laid out here as kernels read them."""
    array: Callable[[int], Any] = ctypes.c_int64.from_address
    probe = np.zeros((2, 3))
    at = id(probe)
    return (
        sys.implementation.name == "cpython"  # elsewhere an object's ``id`` is no address
        and sys.byteorder == "little"
        and struct.calcsize("P") == 8
        and array(at + DATA).value == probe.ctypes.data
        and ctypes.c_int32.from_address(at + DIMENSIONS).value == 2
        and (array(array(at + SHAPE).value).value, array(array(at + SHAPE).value + 8).value) == probe.shape
        and array(at + TYPE).value == id(probe.dtype)
        and ctypes.c_int32.from_address(at + FLAGS).value & 0xFFFF == probe.flags.num
    )
