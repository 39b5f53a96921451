"""Data classes whose methods are made when first used: they do what those of the standard library do."""

import ast
import copy
import dataclasses
import inspect
import pickle
from collections.abc import Callable, Hashable, Iterator
from dataclasses import field, fields, is_dataclass
from functools import partial
from typing import Any, ClassVar, Generic, TypeVar

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.support.locations import ROOT
from trunnion import records
from trunnion.records import dataclass

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Point:
    x: float
    y: float = 0.0
    notes: list[str] = field(default_factory=list)
    KIND: ClassVar[str] = "point"


@dataclasses.dataclass(frozen=True, slots=True)
class Labelled(Point):
    label: str = ""


@dataclass(frozen=True, slots=True)
class Twice(Labelled):
    again: int = 2


@dataclass(slots=True, eq=False)
class Box(Generic[T]):
    content: T
    opened: int = field(default=0, init=False)

    def __post_init__(self) -> None:
        self.opened += 1


@dataclass(frozen=True, slots=True, kw_only=True)
class Keywords:
    first: int = 1
    second: str


def test_methods_are_made_at_first_use() -> None:
    @dataclass(frozen=True, slots=True)
    class Fresh:
        x: int

    before = {name: Fresh.__dict__[name] for name in ("__init__", "__repr__", "__eq__", "__hash__")}
    assert not any(inspect.isfunction(method) for method in before.values())
    assert Fresh(1) == Fresh(1)
    assert inspect.isfunction(Fresh.__dict__["__init__"])
    assert inspect.isfunction(Fresh.__dict__["__eq__"])
    assert Fresh.__dict__["__repr__"] is before["__repr__"]
    assert repr(Fresh(1)) == "test_methods_are_made_at_first_use.<locals>.Fresh(x=1)"
    assert hash(Fresh(1)) == hash(Fresh(1)) == hash((1,))
    assert isinstance(Fresh(1), Hashable)


def test_fields_and_helpers_of_the_standard_library() -> None:
    point = Point(1.0)
    assert [each.name for each in fields(point)] == ["x", "y", "notes"]
    assert is_dataclass(Point)
    assert dataclasses.replace(point, y=2.0) == Point(1.0, 2.0)
    assert dataclasses.asdict(point) == {"x": 1.0, "y": 0.0, "notes": []}
    assert dataclasses.astuple(point) == (1.0, 0.0, [])
    assert Point(1.0).notes is not Point(1.0).notes
    assert str(inspect.signature(Point)) == "(x: float, y: float = 0.0, notes: list[str] = <factory>) -> None"
    assert Point.__init__.__qualname__ == "Point.__init__"
    assert not hasattr(point, "__dict__")
    match point:
        case Point(x, y):
            assert (x, y) == (1.0, 0.0)
        case _:
            pytest.fail("no match")


@pytest.mark.parametrize("thing", [Point(1.0, 2.0, ["a"]), Labelled(1.0, label="b"), Twice(1.0), Keywords(second="c")])
def test_copies_and_pickles(thing: Any) -> None:
    for made in (copy.copy(thing), copy.deepcopy(thing), pickle.loads(pickle.dumps(thing))):
        assert made == thing
        assert made is not thing


def test_frozen() -> None:
    point: Any = Point(1.0)
    with pytest.raises(dataclasses.FrozenInstanceError, match="cannot assign to field 'x'"):
        point.x = 2.0
    with pytest.raises(dataclasses.FrozenInstanceError, match="cannot assign to field 'other'"):
        point.other = 2.0
    with pytest.raises(dataclasses.FrozenInstanceError, match="cannot delete field 'x'"):
        del point.x
    with pytest.raises(TypeError, match="sets attributes"):

        @dataclass(frozen=True)
        class Own:
            x: int

            def __setattr__(self, name: str, value: object) -> None:
                raise AssertionError


def test_a_class_that_inherits_may_have_attributes_of_its_own() -> None:
    class Free(Keywords):
        pass

    free: Any = Free(second="a")
    free.other = 3
    assert free.other == 3
    del free.other
    with pytest.raises(dataclasses.FrozenInstanceError):
        free.first = 2


def test_both_kinds_inherit_from_each_other() -> None:
    assert Labelled(1.0, 2.0, [], "a") == Labelled(1.0, 2.0, [], "a") != Point(1.0, 2.0, [])
    assert repr(Twice(1.0)) == "Twice(x=1.0, y=0.0, notes=[], label='', again=2)"
    for thing in (Labelled(1.0), Twice(1.0)):
        with pytest.raises(dataclasses.FrozenInstanceError):
            thing.x = 3.0  # type: ignore[misc]
    with pytest.raises(TypeError, match="non-frozen dataclass from a frozen one"):

        @dataclass(slots=True)
        class Thawed(Point):  # type: ignore[misc]
            z: int = 0


def test_generic_and_post_init() -> None:
    box: Box[int] = Box(3)
    assert (box.content, box.opened) == (3, 1)
    assert box != Box(3)
    assert Box[int](4).content == 4


def test_keywords() -> None:
    assert Keywords(second="a") == Keywords(first=1, second="a")
    with pytest.raises(TypeError, match=r"Keywords\.__init__\(\) takes 1 positional argument but 2 were given"):
        Keywords(1)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="missing 1 required keyword-only argument: 'second'"):
        Keywords()  # type: ignore[call-arg]


def test_own_methods_stay() -> None:
    @dataclass(frozen=True)
    class Own:
        x: int

        def __eq__(self, other: object) -> bool:
            return True

        def __repr__(self) -> str:
            return "own"

    assert Own(1) == Own(2)
    assert repr(Own(1)) == "own"
    assert hash(Own(1)) == hash((1,))


def test_the_order_of_defaults_is_checked() -> None:
    namespace = {"__annotations__": {"a": int, "b": int}, "a": 1}
    wrong: Any = dataclass(type("Wrong", (), namespace))
    with pytest.raises(TypeError, match="non-default argument 'b' follows default argument"):
        wrong(1)


#: Names and kinds of fields, options, and whether the class has a ``__post_init__``.
Drawn = tuple[list[tuple[str, str]], dict[str, bool], bool]


@st.composite
def _classes(draw: st.DrawFn) -> Drawn:
    kinds = ["plain", "default", "factory", "keyword", "keyword default", "unasked", "unasked factory", "uncompared"]
    drawn = draw(st.lists(st.sampled_from(kinds), max_size=6))
    order = [kind for kind in drawn if kind in ("plain", "uncompared")]
    order += [kind for kind in drawn if kind not in ("plain", "uncompared")]
    options = {name: draw(st.booleans()) for name in ("frozen", "slots", "eq", "repr", "kw_only")}
    names = draw(st.permutations(["self_", "_0", "_1", "store", "factory", "made", "make_0", "x"]))
    return list(zip(names, order, strict=False)), options, draw(st.booleans())


def _namespace(columns: list[tuple[str, str]], *, post: bool) -> dict[str, Any]:
    made: dict[str, Callable[[], Any]] = {
        "default": lambda: 5,
        "factory": lambda: field(default_factory=list),
        "keyword": lambda: field(kw_only=True),
        "keyword default": lambda: field(default=6, kw_only=True),
        "unasked": lambda: field(default=7, init=False),
        "unasked factory": lambda: field(default_factory=dict, init=False),
        "uncompared": lambda: field(compare=False, repr=False),
    }
    space: dict[str, Any] = {name: made[kind]() for name, kind in columns if kind in made}
    seen: list[str] = []
    space |= {"__annotations__": dict.fromkeys((name for name, _ in columns), int), "__doc__": "", "SEEN": seen}
    if post:
        space["__post_init__"] = lambda self: seen.append(type(self).__name__)
    return space


def _outcome(ask: Callable[[], object]) -> object:
    try:
        return ask()
    except Exception as error:
        return type(error), str(error)


def _behaviour(cls: Any, columns: list[tuple[str, str]]) -> Iterator[object]:
    """Yield what can be seen of a class."""
    asked = [name for name, kind in columns if not kind.startswith("unasked")]
    yield str(inspect.signature(cls)), cls.__match_args__, [each.name for each in fields(cls)]
    yield cls.__init__.__annotations__
    yield _outcome(_made(cls)), _outcome(_made(cls, *range(9))), _outcome(_made(cls, unknown=1))
    one, same, other = (cls(**dict.fromkeys(asked, value)) for value in (1, 1, 2))
    yield None if "__repr__" not in cls.__dict__ else repr(one)
    yield one == same, one == other, one == 1, one.__eq__(1)
    yield _outcome(lambda: hash(one) == hash(same)), cls.__hash__ is None, hasattr(one, "__dict__"), cls.SEEN
    yield _values(one), _outcome(lambda: copy.copy(one) == one)
    yield _outcome(lambda: dataclasses.asdict(dataclasses.replace(one)))
    for name, _ in columns:
        yield _outcome(partial(setattr, one, name, 3)), _outcome(partial(delattr, one, name))
    for name in asked:
        yield _outcome(_made(cls, **{each: 1 for each in asked if each != name}))


def _made(cls: Any, *places: int, **names: int) -> Callable[[], list[object]]:
    return lambda: _values(cls(*places, **names))


def _values(thing: Any) -> list[object]:
    return [getattr(thing, each.name, None) for each in fields(thing)]


@given(_classes())
def test_any_class_behaves_as_of_the_standard_library(drawn: Drawn) -> None:
    columns, options, post = drawn
    seen = []
    for decorate in (dataclasses.dataclass, records.dataclass):
        cls: Any = decorate(**options)(type("Drawn", (), _namespace(columns, post=post)))
        seen.append(list(_behaviour(cls, columns)))
    assert seen[0] == seen[1]


def test_sources_use_no_other() -> None:
    sources = ROOT / "src" / "trunnion"
    names = [
        (str(path.relative_to(sources)), name.name)
        for path in sources.rglob("*.py")
        if path != sources / "records.py"
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Import) or (isinstance(node, ast.ImportFrom) and node.module == "dataclasses")
        for name in node.names
    ]
    assert any(name == "field" for _, name in names)
    assert [each for each in names if each[1] in {"dataclass", "dataclasses"}] == []
