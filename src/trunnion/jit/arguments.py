"""What a kernel takes and gives, by its annotations: numbers and arrays, alone or in tuples."""

import inspect
from collections.abc import Callable, Iterable, Iterator, Sequence
from operator import index
from typing import Annotated, Any, NamedTuple, TypeAlias, get_args, get_origin

import numpy as np

_NUMBERS = (int, float, bool)


class Array(NamedTuple):
    """An array, C-contiguous when the kernel reads it."""

    dtype: np.dtype[Any]
    dimensions: int
    is_written: bool


class Parts(NamedTuple):
    """A tuple, or a named one, of its parts."""

    kinds: "tuple[Kind, ...]"
    made: type


#: ``int``, ``float``, ``bool``, an array, or a tuple of these.
Kind: TypeAlias = type | Array | Parts


class UnfitError(Exception):
    """An argument is not an array or a tuple as a kernel reads it, and may become one."""


def argument_kinds(function: Callable[..., Any], writes: frozenset[str]) -> tuple[Kind, ...]:
    """Return the kinds of all arguments.

    ``int``, ``float`` and ``bool``; arrays as ``trunnion.arrays`` names them; tuples of these, and named ones.

    writes  names of arguments whose arrays are written to; the others' are only read
    """
    hints = inspect.get_annotations(function, eval_str=True)
    return tuple(_kind(hint, name in writes) for name, hint in hints.items() if name != "return")


def result_kinds(function: Callable[..., Any]) -> tuple[tuple[type, ...], bool]:
    """Return what a kernel gives, and whether it is a tuple: ``int``, ``float``, ``bool``; nothing is an empty one."""
    hint = inspect.get_annotations(function, eval_str=True).get("return")
    if hint is None:
        return (), False
    origin: Any = get_origin(hint)
    is_tuple = origin is tuple
    found: tuple[Any, ...] = get_args(hint) if is_tuple else (hint,)
    if not set(found) <= set(_NUMBERS):
        raise TypeError(f"a kernel cannot give {hint}")
    return found, is_tuple


def _kind(annotation: Any, written: bool) -> Kind:
    size = 1
    if get_origin(annotation) is Annotated:
        annotation, size = get_args(annotation)
    annotation = _without_alias(annotation)
    if annotation in _NUMBERS:
        number: type = annotation
        return number
    if get_origin(annotation) is np.ndarray:
        (scalar,) = get_args(get_args(annotation)[1])
        return Array(np.dtype(scalar), size, written)
    if get_origin(annotation) is tuple:
        parts = get_args(annotation)
        parts = parts[:1] * size if parts[1:] == (...,) else parts
        return Parts(tuple(_kind(part, written) for part in parts), tuple)
    if hasattr(annotation, "_fields"):
        fields = inspect.get_annotations(annotation, eval_str=True)
        return Parts(tuple(_kind(fields[name], written) for name in annotation._fields), annotation)
    raise TypeError(f"no kernel takes {annotation}")


def _without_alias(annotation: Any) -> Any:
    """``ndarray[...]`` for ``NDArray[...]``, which is an alias with a value of its own from NumPy 2.5 on."""
    value = getattr(get_origin(annotation), "__value__", None)
    return annotation if value is None else value[get_args(annotation)]


def leaves(kinds: Sequence[Kind]) -> Iterator[type | Array]:
    """Yield numbers and arrays in their order, those in tuples too."""
    for kind in kinds:
        if isinstance(kind, Parts):
            yield from leaves(kind.kinds)
        else:
            yield kind


def flatten(kinds: Sequence[Kind], values: Sequence[Any], into: list[Any]) -> None:
    """Append numbers and the addresses of array objects in the order of ``leaves``.

    Only a tuple's parts are taken as they are: it keeps them alive for as long as it is there itself. What a generator
    gives, or an array as its rows, would be gone before the kernel reads it.

    Raises ``UnfitError`` where an array or a tuple is needed and something else is there, ``ValueError`` for another
    number of values.
    """
    for kind, value in zip(kinds, values, strict=True):
        if type(kind) is Array:
            if type(value) is not np.ndarray:
                raise UnfitError
            into.append(id(value))
        elif type(kind) is Parts:
            if not isinstance(value, tuple):
                raise UnfitError
            flatten(kind.kinds, value, into)
        else:
            into.append(bool(value) if kind is bool else value)


def fitted(kinds: Sequence[Kind], values: Iterable[Any]) -> tuple[Any, ...]:
    """Return arguments as a kernel takes them: an array that it reads is copied if it is not C-contiguous.

    Raises ``TypeError`` for another number of values, an array of another type or number of dimensions, and one that
    cannot be written to.
    """
    values = tuple(values)
    if len(values) != len(kinds):
        raise TypeError(f"{len(values)} values for {len(kinds)}")
    return tuple(_fitted(kind, value) for kind, value in zip(kinds, values, strict=True))


def _fitted(kind: Kind, value: Any) -> Any:
    if isinstance(kind, Parts):
        parts = fitted(kind.kinds, value)
        return parts if kind.made is tuple else kind.made(*parts)
    if not isinstance(kind, Array):
        return index(value) if kind is int else value
    array = value if kind.is_written else np.require(value, requirements=("C", "A"))
    if not isinstance(array, np.ndarray) or array.dtype != kind.dtype or array.ndim != kind.dimensions:
        raise TypeError(f"{type(value).__name__} for {kind.dtype} in {kind.dimensions} dimensions")
    if kind.is_written and not (array.flags.c_contiguous and array.flags.aligned and array.flags.writeable):
        raise TypeError("an array that is written to must be C-contiguous and writeable")
    return array.view(kind.dtype, np.ndarray)
