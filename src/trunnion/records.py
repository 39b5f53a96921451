"""Data classes that start at once: ``dataclass`` of the standard library, with methods made when they are first used.

``dataclasses.dataclass`` writes and compiles ``__init__``, ``__repr__``, ``__eq__``, ``__hash__`` and, for a frozen
class, two more methods while a module is imported. For hundreds of classes that is a third of a small post, which uses
few of these methods. Here, a class has its fields and slots at once, as ``dataclasses`` makes them, and a method at its
first use. ``fields``, ``replace``, ``asdict``, ``match``, copies and pickles work as ever, and both kinds may inherit
from each other. ``InitVar`` is not for these classes, and a wrong order of defaults is reported at the first instance.
"""

from collections.abc import Callable
from dataclasses import MISSING, Field, FrozenInstanceError, fields, is_dataclass, make_dataclass
from dataclasses import dataclass as _at_once
from functools import cache
from types import CodeType, FunctionType
from typing import TYPE_CHECKING, Any, Final

__all__ = ["dataclass"]

#: The methods that ``dataclasses`` makes when they are asked for, and the option that asks for each.
_OPTIONS: Final = {"__repr__": "repr", "__eq__": "eq", "__hash__": "unsafe_hash"}


class _Factory:
    """Stands for a default that is made anew for each instance."""

    def __repr__(self) -> str:
        return "<factory>"


_FACTORY: Final = _Factory()


class _Later:
    """A method that is made when it is first looked up, and then stands in the class itself."""

    __slots__ = ("_cls", "_make", "_name")

    def __init__(self, cls: type, name: str, make: Callable[[Any, str], FunctionType]) -> None:
        self._cls, self._name, self._make = cls, name, make

    def __get__(self, instance: object, owner: type | None = None) -> Any:
        method = self._make(self._cls, self._name)
        method.__module__, method.__qualname__ = self._cls.__module__, f"{self._cls.__qualname__}.{self._name}"
        setattr(self._cls, self._name, method)
        return method.__get__(instance, owner)


def _make_by_twin(cls: Any, name: str) -> FunctionType:
    """Take a method from a class with the same fields and no other method."""
    options: dict[str, Any] = {option: method == name for method, option in _OPTIONS.items()}
    columns = [(field.name, field.type, field) for field in fields(cls)]
    method: FunctionType = make_dataclass(cls.__name__, columns, init=False, **options).__dict__[name]
    return method


def _make_init(cls: Any, name: str) -> FunctionType:
    """Make ``__init__`` from code that all classes of this shape share: only its names are those of the fields."""
    scope: dict[str, Any] = {"factory": _FACTORY, "store": object.__setattr__}
    store = "store(self, '{0}', {1})" if cls.__dataclass_params__.frozen else "self.{0} = {1}"
    stored = [
        store.format(f"_{index}", value)
        for index, field in enumerate(fields(cls))
        if (value := _value_of(field, index, scope, slots="__slots__" in cls.__dict__))
    ]
    if hasattr(cls, "__post_init__"):
        stored.append("self.__post_init__()")
    places = [f"_{index}" for index, field in enumerate(fields(cls)) if field.init and not field.kw_only]
    keywords = [f"_{index}" for index, field in enumerate(fields(cls)) if field.init and field.kw_only]
    parameters = ", ".join(["self", *places, *(["*", *keywords] if keywords else ())])
    code = _compile(f"def made({parameters}):\n " + "\n ".join(stored or ["pass"]))
    names = {f"_{index}": field.name for index, field in enumerate(fields(cls))}
    code = code.replace(
        co_name=name,
        co_varnames=tuple(names.get(each, each) for each in code.co_varnames),
        co_names=tuple(names.get(each, each) for each in code.co_names),
        co_consts=tuple(names.get(each, each) for each in code.co_consts),
    )
    method = FunctionType(code, scope, name, _defaults_of(cls))
    method.__kwdefaults__ = {
        each.name: _default_of(each) for each in fields(cls) if each.kw_only and _has_default(each)
    }
    method.__annotations__ = {each.name: each.type for each in fields(cls) if each.init} | {"return": None}
    return method


def _value_of(field: Field[Any], index: int, scope: dict[str, Any], *, slots: bool) -> str:
    """Give what ``__init__`` stores of a field; nothing where the class has the default itself."""
    if field.default_factory is not MISSING:
        scope[f"make_{index}"] = field.default_factory
        return f"make_{index}() if _{index} is factory else _{index}" if field.init else f"make_{index}()"
    if field.init:
        return f"_{index}"
    if field.default is MISSING or not slots:
        return ""
    scope[f"default_{index}"] = field.default
    return f"default_{index}"


def _has_default(field: Field[Any]) -> bool:
    return field.init and (field.default is not MISSING or field.default_factory is not MISSING)


def _default_of(field: Field[Any]) -> Any:
    return field.default if field.default_factory is MISSING else _FACTORY


def _defaults_of(cls: Any) -> tuple[Any, ...]:
    """Give the defaults of what may be passed by its place, which are those of the last fields."""
    defaults: list[Any] = []
    for field in fields(cls):
        if field.init and not field.kw_only:
            if _has_default(field):
                defaults.append(_default_of(field))
            elif defaults:
                raise TypeError(f"non-default argument {field.name!r} follows default argument")
    return tuple(defaults)


@cache
def _compile(source: str) -> CodeType:
    scope: dict[str, Any] = {}
    exec(source, scope)
    code: CodeType = scope["made"].__code__
    return code


def _get_state(self: Any) -> list[object]:
    return [getattr(self, field.name) for field in fields(self)]


def _set_state(self: Any, state: list[object]) -> None:
    for field, value in zip(fields(self), state, strict=True):
        object.__setattr__(self, field.name, value)


def _freeze(cls: Any) -> None:
    """Let no attribute of an instance be set or deleted."""
    names = frozenset(field.name for field in fields(cls))

    def set_attribute(self: object, name: str, value: object) -> None:
        if type(self) is cls or name in names:
            raise FrozenInstanceError(f"cannot assign to field {name!r}")
        super(cls, self).__setattr__(name, value)

    def delete_attribute(self: object, name: str) -> None:
        if type(self) is cls or name in names:
            raise FrozenInstanceError(f"cannot delete field {name!r}")
        super(cls, self).__delattr__(name)

    cls.__setattr__, cls.__delattr__ = set_attribute, delete_attribute
    cls.__dataclass_params__.frozen = True
    if "__slots__" in cls.__dict__:  # the state of slots is set as attributes otherwise
        for name, method in (("__getstate__", _get_state), ("__setstate__", _set_state)):
            if name not in cls.__dict__:
                setattr(cls, name, method)


if TYPE_CHECKING:
    from dataclasses import dataclass
else:

    def dataclass(cls=None, /, *, init=True, repr=True, eq=True, frozen=False, kw_only=False, slots=False):  # noqa: A002
        """Make a data class: ``dataclasses.dataclass``, with those of its options that Trunnion uses."""

        def make(cls):
            own, inherits = set(cls.__dict__), is_dataclass(cls)
            if "__eq__" in own and cls.__hash__ is None:
                own.remove("__hash__")  # Python takes it away where only __eq__ is given
            if frozen and own & {"__setattr__", "__delattr__"}:
                raise TypeError(f"{cls.__name__} is frozen and sets attributes")
            # What inherits is frozen by the standard library, which checks it against its bases.
            cls = _at_once(
                cls, init=False, repr=False, eq=False, frozen=frozen and inherits, kw_only=kw_only, slots=slots
            )
            for name, wanted in (("__init__", init), ("__repr__", repr), ("__eq__", eq), ("__hash__", eq and frozen)):
                if wanted and name not in own:
                    setattr(cls, name, _Later(cls, name, _make_by_twin if name in _OPTIONS else _make_init))
            if eq and not frozen and "__hash__" not in own:
                cls.__hash__ = None
            if frozen and not inherits:
                _freeze(cls)
            return cls

        return make if cls is None else make(cls)
