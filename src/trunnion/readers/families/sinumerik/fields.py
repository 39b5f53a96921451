"""Fields: several elements set at once, from a list (SET) or with one value (REP).

Facts: SINUMERIK 840D, *Job planning*, definition of fields: the last index counts on first.
"""

import math

from trunnion.errors import Severity
from trunnion.messages import Wording
from trunnion.readers.control.event_recorder import Note
from trunnion.readers.families.sinumerik.expressions import ExpressionError, ExpressionReader, Value
from trunnion.readers.families.sinumerik.variables import MAX_VARIABLES, Variables


def assign(reader: ExpressionReader, variables: Variables, name: str, index: tuple[int, ...]) -> bool:
    """Assign what comes next behind ``=``; False if the variable was not defined, and so became a global one."""
    word = reader.peek()
    if word not in ("SET", "REP") or reader.peek(1) != "(":
        return variables.assign(name, index, reader.value())
    reader.at += 1
    _fill(reader, variables, name, index, word)
    return True


def _fill(reader: ExpressionReader, variables: Variables, name: str, index: tuple[int, ...], word: str) -> None:
    """Assign the values in parentheses that come next, to the elements of a field from an index on."""
    given = reader.arguments()
    size = variables.size(name)
    if not size or (index and len(index) != len(size)):
        raise ExpressionError(Wording("NC210", "no_field_to_fill", name=name, word=word))
    count = math.prod(size)
    if count > MAX_VARIABLES // 2:
        raise ExpressionError(Wording("NC210", "too_many_variables", most=MAX_VARIABLES // 2))
    if index:
        variables.check_element(name, index)
    begin = 0
    for at, most in zip(index, size, strict=False):
        begin = begin * most + at
    values = _repeated(given, count - begin, name) if word == "REP" else given
    if begin + len(values) > count:
        raise ExpressionError(Wording("NC210", "more_than_field_has", name=name, count=count))
    for place, value in enumerate(values, begin):
        if value is not None:
            variables.assign(name, _index(place, size), value)


def define(reader: ExpressionReader, variables: Variables, name: str, note: Note) -> None:
    """Give a variable that was just defined its first value, or values; a list needs no SET here."""
    if variables.size(name) and reader.peek() == "(":
        _fill(reader, variables, name, (), "SET")
        return
    if variables.size(name) and reader.peek() not in ("SET", "REP"):
        reader.value()
        note(Wording("NC215", "field_takes_set", name=name), Severity.ERROR)
        return
    assign(reader, variables, name, ())


def _repeated(given: list[Value | None], rest: int, name: str) -> list[Value | None]:
    """Return the values of REP: one value, as often as it says, or up to the end of the field."""
    if not 1 <= len(given) <= 2 or given[0] is None:
        raise ExpressionError(Wording("NC210", "no_field_to_fill", name=name, word="REP"))
    times = rest if len(given) == 1 else given[1]
    if not isinstance(times, int | float) or not 0 <= times <= rest or times != int(times):
        raise ExpressionError(Wording("NC210", "more_than_field_has", name=name, count=rest))
    return [given[0]] * int(times)


def _index(place: int, size: tuple[int, ...]) -> tuple[int, ...]:
    found: list[int] = []
    for most in reversed(size):
        place, at = divmod(place, most)
        found.append(at)
    return tuple(reversed(found))
