"""Variables of a Sinumerik program: R parameters, DEF variables and predefined names."""

import math
from typing import Final

from trunnion.messages import Wording
from trunnion.readers.families.sinumerik.expressions import ExpressionError, Value, whole
from trunnion.readers.families.sinumerik.words import CONSTANTS
from trunnion.readers.program.declared_variables import NOTHING_DECLARED, DeclaredVariables

#: The elements of a variable by index; () if it is no array.
Elements = dict[tuple[int, ...], Value]

#: The highest R parameter and array index.
MAX_NUMBER: Final = 32767

#: Assignments after which variables are counted; a program may have half as many.
MAX_VARIABLES: Final = 100_000


class Variables:
    """The variables of a running program or subprogram; R parameters and global variables are shared.

    arguments   of the call, for the PROC line, and their texts
    declared    the values that the definition declares
    """

    def __init__(self, declared: DeclaredVariables = NOTHING_DECLARED, shared: "Variables | None" = None) -> None:
        self.declared = declared
        self._local: dict[str, Elements] = {}
        self._types: dict[str, str] = {}
        self._places: dict[str, tuple[int, int]] = {}
        self._sizes: dict[str, tuple[int, ...]] = {}
        self._parameters: dict[int, float] = {} if shared is None else shared._parameters
        self._global: dict[str, Elements] = {} if shared is None else shared._global
        self._assignment_count: list[int] = [0] if shared is None else shared._assignment_count
        self.arguments: list[Value | None] = []
        self.argument_texts: list[str] = []
        self._caller = shared

    def pass_arguments(self, arguments: list[Value | None], texts: list[str]) -> None:
        """Store the arguments of a call, and how they are written."""
        self.arguments, self.argument_texts = arguments, texts

    def named_field(self, place: int) -> str:
        """Return the name of the caller's field that is an argument; empty: the argument is a value, or missing."""
        text = self.argument_texts[place] if place < len(self.argument_texts) else ""
        return text if self._caller is not None and self._caller.size(text) else ""

    def take_variable(self, kind: str, name: str, place: int) -> bool:
        """Define a parameter as the caller's variable (VAR); False if the argument is none of which the name tells."""
        caller, text = self._caller, self.argument_texts[place]
        elements = None if caller is None else caller._local.get(text, caller._global.get(text))
        if caller is None or elements is None:
            return False
        self.define(kind, name)
        self._local[name] = elements
        return True

    def take_field(self, kind: str, name: str, place: int, bounds: tuple[int | None, ...], *, copies: bool) -> None:
        """Define a parameter as the caller's field, or as a copy of it; ``bounds``: its size, None where it is open."""
        caller = self._caller
        text = self.argument_texts[place] if place < len(self.argument_texts) else ""
        size = tuple(MAX_NUMBER + 1 if bound is None else bound for bound in bounds)
        if caller is None or not text:
            self.define(kind, name, size=size)
            return
        given = caller.size(text)
        if len(given) != len(bounds) or any(b not in (None, g) for b, g in zip(bounds, given, strict=True)):
            raise ExpressionError(Wording("NC210", "parameter_is_field", name=name, given=text))
        self.define(kind, name, size=given)
        self._local[name] = dict(caller._local[text]) if copies else caller._local[text]

    def parameter(self, number: int) -> float:
        """Return an R parameter; it keeps what earlier programs have written until this one sets it."""
        self._check_index(number)
        if number in self._parameters:
            return self._parameters[number]
        return self._declared_value(f"R{number}")

    def set_parameter(self, number: int, value: float) -> None:
        """Set an R parameter."""
        self._check_index(number)
        self._parameters[number] = value
        self.declared.set(f"R{number}", value, outlives=True)

    def define(
        self,
        kind: str,
        name: str,
        value: Value | None = None,
        *,
        place: tuple[int, int] = (0, 0),
        size: tuple[int, ...] = (),
    ) -> None:
        """DEF: define a variable of this program, once; a jump may lead to the same place, line and word, again.

        size   how many elements a field has, by index; () for a variable that is none
        """
        if self._places.setdefault(name, place) != place:
            raise ExpressionError(Wording("NC223", "defined_twice", name=name))
        self._types[name] = kind
        self._sizes[name] = size
        self._local[name] = {}
        if not size:
            self.assign(name, (), value if value is not None else ("" if kind in ("STRING", "AXIS") else 0.0))

    def size(self, name: str) -> tuple[int, ...]:
        """Return how many elements a field of this program has, by index; () if it is none, or not known."""
        return self._sizes.get(name, ())

    def check_element(self, name: str, index: tuple[int, ...]) -> None:
        """Refuse an index that a variable of this program does not have, and a field without one."""
        size = self._sizes.get(name)
        if size is None or (self._types[name] == "STRING" and len(index) > len(size)):
            return  # another program's, or a character of a text
        if len(index) == len(size) and all(0 <= at < most for at, most in zip(index, size, strict=True)):
            return
        element = f"{name}[{','.join(map(str, index))}]" if index else name
        if not size:
            raise ExpressionError(Wording("NC215", "not_a_field", element=element, name=name))
        elements = ", ".join(f"0 to {most - 1}" for most in size)
        raise ExpressionError(Wording("NC215", "no_such_element", element=element, name=name, elements=elements))

    def __contains__(self, name: str) -> bool:
        """Whether this program defined the name."""
        return name in self._types

    def text(self, name: str) -> str | None:
        """Return the text of a STRING variable, None if there is no such variable."""
        value = self._local.get(name, {}).get(())
        return value if isinstance(value, str) else None

    def assign(self, name: str, index: tuple[int, ...], value: Value) -> bool:
        """Set a variable; False if it was not defined, and so became a global one."""
        for number in index:
            self._check_index(number)
        self.check_element(name, index)
        kind = self._types.get(name)
        if kind in ("INT", "BOOL", "CHAR", "REAL") and isinstance(value, str) and kind != "CHAR":
            raise ExpressionError(Wording("NC210", "takes_number_not_text", name=name))
        if kind == "INT" and isinstance(value, float):
            value = float(whole(math.copysign(math.floor(abs(value) + 0.5), value)))
        if kind == "BOOL" and isinstance(value, float):
            value = float(bool(value))
        self._assignment_count[0] += 1
        if self._assignment_count[0] > MAX_VARIABLES:
            self._recount()
        if kind is not None:
            self._local[name][index] = value
            return True
        known = name in self._global
        self._global.setdefault(name, {})[index] = value
        return known

    def _recount(self) -> None:
        """Count variables exactly; called only when there may be too many."""
        count = sum(map(len, self._local.values())) + sum(map(len, self._global.values()))
        if count > MAX_VARIABLES // 2:
            raise ExpressionError(Wording("NC210", "too_many_variables", most=MAX_VARIABLES // 2))
        self._assignment_count[0] = count

    def variable(self, name: str, index: tuple[int, ...]) -> Value:
        """Return the value of a variable or predefined name; DEF alone makes it 0."""
        self.check_element(name, index)
        for table in (self._local, self._global):
            elements = table.get(name)
            if elements is not None and index in elements:
                return elements[index]
        if name in self._types and index:
            return "" if self._types[name] == "STRING" else 0.0
        if name in CONSTANTS and not index:
            return float(CONSTANTS[name])
        place = f"[{','.join(map(str, index))}]" if index else ""
        return self._declared_value(f"{name}{place}")

    def _declared_value(self, name: str) -> float:
        value = self.declared.get(name)
        if value is not None:
            return value
        if name.startswith("$"):
            raise ExpressionError(Wording("NC222", "system_variable", name=name))
        raise ExpressionError(Wording("NC223", "no_value_in_program", name=name))

    @staticmethod
    def _check_index(number: int) -> None:
        if not 0 <= number <= MAX_NUMBER:
            raise ExpressionError(Wording("NC215", "index_out_of_range", number=number, most=MAX_NUMBER))
