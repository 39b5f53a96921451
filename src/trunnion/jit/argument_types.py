"""The Numba types of a kernel's arguments, by its annotations, and arguments made to fit them."""

import inspect
from collections.abc import Callable
from typing import Annotated, Any, get_args, get_origin

import numba
import numpy as np

_SCALARS = {int: numba.int64, float: numba.float64, bool: numba.boolean}

_tuple_of: Callable[..., Any] = numba.types.BaseTuple.from_types


def numba_types(function: Callable[..., Any], writes: frozenset[str]) -> tuple[Any, ...]:
    """Numba types of all arguments.

    ``int``, ``float`` and ``bool``; arrays as ``trunnion.arrays`` names them; tuples of these, and named ones.

    writes  names of arguments whose arrays are written to; the others' are read-only
    """
    hints = inspect.get_annotations(function, eval_str=True)
    return tuple(_numba_type(hint, name in writes) for name, hint in hints.items() if name != "return")


def _numba_type(annotation: Any, written: bool) -> Any:
    size = 1
    if get_origin(annotation) is Annotated:
        annotation, size = get_args(annotation)
    annotation = _without_alias(annotation)
    if annotation in _SCALARS:
        return _SCALARS[annotation]
    if get_origin(annotation) is np.ndarray:
        (scalar,) = get_args(get_args(annotation)[1])
        return numba.types.Array(numba.from_dtype(np.dtype(scalar)), size, "C", readonly=not written)
    if get_origin(annotation) is tuple:
        parts = get_args(annotation)
        parts = parts[:1] * size if parts[1:] == (...,) else parts
        return _tuple_of([_numba_type(part, written) for part in parts])
    if hasattr(annotation, "_fields"):
        fields = inspect.get_annotations(annotation, eval_str=True)
        return _tuple_of([_numba_type(fields[name], written) for name in annotation._fields], annotation)
    raise TypeError(f"no Numba type for {annotation}")


def _without_alias(annotation: Any) -> Any:
    """``ndarray[...]`` for ``NDArray[...]``, which is an alias with a value of its own from NumPy 2.5 on."""
    value = getattr(get_origin(annotation), "__value__", None)
    return annotation if value is None else value[get_args(annotation)]


def is_read(kind: Any) -> bool:
    """Whether an argument of a Numba type is, or holds, an array that is not written to."""
    if isinstance(kind, numba.types.Array):
        return not kind.mutable
    parts: Any = kind if isinstance(kind, numba.types.BaseTuple) else ()
    return any(is_read(part) for part in parts)


def as_readable(value: Any) -> Any:
    """Return an array, or a named tuple with arrays, as a kernel reads it: C-contiguous."""
    if isinstance(value, np.ndarray):
        return np.ascontiguousarray(value)
    # Numba takes an array that may be written to for a read-only one, but not within a tuple.
    return type(value)(*map(_read_only, value))


def _read_only(value: Any) -> Any:
    if isinstance(value, tuple):
        return as_readable(value) if hasattr(value, "_fields") else tuple(map(_read_only, value))
    if not isinstance(value, np.ndarray) or (value.flags.c_contiguous and not value.flags.writeable):
        return value
    view = np.ascontiguousarray(value).view()
    view.flags.writeable = False
    return view
