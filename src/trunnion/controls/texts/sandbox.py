"""Jinja's environment for templates: without its functions, filters and globals, with bounded arithmetic."""

from typing import Any, Final

from jinja2 import StrictUndefined
from jinja2.runtime import Context, LoopContext
from jinja2.sandbox import ImmutableSandboxedEnvironment

from trunnion.controls.texts import filters
from trunnion.controls.texts.values import Fault, Later, Length, Record, calculated, number_of, shown
from trunnion.definitions.messages import meant_word

#: What a loop tells of itself.
LOOP_VALUES: Final = frozenset({"index", "index0", "first", "last", "length"})


class Sandbox(ImmutableSandboxedEnvironment):
    """What compiled templates ask for everything that is not plain comparison."""

    intercepted_binops = frozenset(("+", "-", "*", "/", "//", "%"))
    intercepted_unops = frozenset(("+", "-"))

    def __init__(self) -> None:
        super().__init__(
            undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True, optimized=False, finalize=filters.printed
        )
        self.globals.clear()
        self.filters = dict(filters.ALL)
        self.tests = dict(filters.TESTS)

    def call_binop(self, context: Context, operator: str, left: Any, right: Any) -> Any:
        """Calculate with two numbers."""
        return calculated(operator, left, right)

    def call_unop(self, context: Context, operator: str, arg: Any) -> Any:
        """Return a number with a sign."""
        if arg is None:
            return None
        number = number_of(arg, operator)
        number = -number if operator == "-" else number
        return Length(number) if isinstance(arg, Length) else number

    def getattr(self, obj: Any, attribute: str) -> Any:
        """Return a value of a record, or of a loop; nothing else has any."""
        if obj is None:
            return None
        if isinstance(obj, LoopContext) and attribute in LOOP_VALUES:
            return getattr(obj, attribute)
        if not isinstance(obj, Record):
            raise Fault("attribute_of_other_thing", attribute=attribute, value=shown(obj))
        if attribute not in obj.values:
            if near := meant_word(attribute, obj.values):
                raise Fault("attribute_not_there_but_near", attribute=attribute, owner=str(obj), near=near)
            raise Fault("attribute_not_there", attribute=attribute, owner=str(obj))
        value = obj.values[attribute]
        return value.value() if isinstance(value, Later) else value

    def getitem(self, obj: Any, argument: Any) -> Any:
        """Return one of a list, counted from 0; None beyond its ends."""
        if not isinstance(obj, tuple) or not isinstance(argument, int):
            raise Fault("index_of_no_list")
        return obj[argument] if -len(obj) <= argument < len(obj) else None

    def is_safe_attribute(self, obj: Any, attr: str, value: Any) -> bool:
        """Nothing is: ``getattr`` has what there is."""
        return False

    def is_safe_callable(self, obj: Any) -> bool:
        """Nothing is."""
        return False


#: Templates keep no state in it.
SANDBOX: Final = Sandbox()
