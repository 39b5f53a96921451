"""How the fields and properties of a record stand in data."""

from collections.abc import Callable, Hashable, Iterator
from dataclasses import field, fields
from functools import cache
from typing import Annotated, Any, Final, TypeVar, cast, get_args, get_origin

from trunnion.records import dataclass

#: Annotation of a field that is not in data; those that begin with an underscore are not either.
NOT_DATA: Final = object()

#: Decimals of numbers that are never rounded.
EXACT: Final = -1

#: Behind this key stands what comes first.
FIRST: Final = "schema"

#: Where the getter of a property keeps its figures.
_FIGURES: Final = "_figures"

_Getter = TypeVar("_Getter", bound=Callable[..., Any])


@dataclass(frozen=True, slots=True)
class Figure:
    """A key in data: ``removed: Annotated[float, Figure(unit="mm3")]``, or ``@Figure()`` below ``@property``.

    A field without a figure has its own name in data, and one with several is there under each of them. A property is
    in data only if it has one.

    name      the key; by default the name of the field
    unit      of the numbers; the key ends with it
    decimals  to which numbers are rounded; None: as ``to_data`` is told; ``EXACT``: not at all
    none      the value that stands for none, and is null in data
    take      makes the value of the key from that of the field, unless that is None
    within    key of the group in which it stands
    after     key or group behind which it stands, with further figures of the same field; by default keys are in the
              order of the fields, then of the properties
    is_extra  the key is in data only where ``to_data`` is told to take it
    is_optional  the key is missing where there is no value; by default it is null
    is_flat   the keys of the record in this field stand among those of its own record
    """

    name: str = ""
    unit: str = field(default="", kw_only=True)
    decimals: int | None = field(default=None, kw_only=True)
    none: Any = field(default=None, kw_only=True)
    take: Callable[[Any], Any] | None = field(default=None, kw_only=True)
    within: str = field(default="", kw_only=True)
    after: str = field(default="", kw_only=True)
    is_extra: bool = field(default=False, kw_only=True)
    is_optional: bool = field(default=False, kw_only=True)
    is_flat: bool = field(default=False, kw_only=True)

    def __call__(self, getter: _Getter) -> _Getter:
        """Mark the getter of a property; the uppermost of several figures comes first."""
        setattr(getter, _FIGURES, (self, *getattr(getter, _FIGURES, ())))
        return getter

    def key_of(self, name: str) -> str:
        """Return the key of a field or property."""
        key = self.name or name
        return key if not self.unit or f"_{key}".endswith(f"_{self.unit}") else f"{key}_{self.unit}"


@dataclass(frozen=True, slots=True)
class KeyFigure:
    """A figure under its key; ``attribute`` is the field or property that it shows."""

    key: str
    attribute: str
    figure: Figure

    def value(self, record: object) -> Any:
        """Return the value in a record, before it becomes data; None where there is none."""
        found = getattr(record, self.attribute)
        if found is None or (self.figure.none is not None and found == self.figure.none):
            return None
        return found if self.figure.take is None else self.figure.take(found)


def figures_of(kind: type) -> tuple[KeyFigure, ...]:
    """Return the figures of a class of records, in the order of their data."""
    return _figures_of(cast("Hashable", kind))  # mypy takes a class for one of its instances there


@cache
def _figures_of(kind: type) -> tuple[KeyFigure, ...]:
    found = list[KeyFigure]()
    moved = list[tuple[str, list[KeyFigure]]]()
    for name, figures in _stated(kind):
        group = found
        for each in figures:
            if each.after:
                moved.append((each.after, group := []))
            group.append(KeyFigure(each.key_of(name), name, each))
    while moved:  # what stands behind one that is moved itself waits for that
        behind = {name: k + 1 for k, each in enumerate(found) for name in (each.key, each.figure.within)}
        ready = next((k for k, (after, _) in enumerate(moved) if after in behind or after == FIRST), None)
        assert ready is not None, f"{kind.__name__} has no {moved[0][0]}"
        after, own = moved.pop(ready)
        begin = behind.get(after, 0)
        found[begin:begin] = own
    return tuple(found)


def _stated(kind: type) -> Iterator[tuple[str, tuple[Figure, ...]]]:
    """Fields and properties that are in data, with their figures."""
    for each in fields(kind):
        metadata = get_args(each.type)[1:] if get_origin(each.type) is Annotated else ()
        if NOT_DATA not in metadata and not each.name.startswith("_"):
            yield each.name, tuple(one for one in metadata if isinstance(one, Figure)) or (Figure(),)
    for name, value in ((name, value) for base in reversed(kind.__mro__) for name, value in vars(base).items()):
        if isinstance(value, property) and hasattr(value.fget, _FIGURES):
            yield name, getattr(value.fget, _FIGURES)
