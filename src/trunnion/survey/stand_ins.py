"""Stand-ins for the settings that the errors of a post ask for, as a person would fill them in.

With them a post shows whether anything else is wrong: the program is proven, and for nobody to run.
"""

from collections.abc import Iterable
from itertools import count
from typing import Final

from trunnion.errors import Problem, Severity
from trunnion.jobs.post.asked_settings import WAIVES, AskedSetting, asked_settings

#: What is written in place of the words in capitals.
_VALUES: Final = {"RPM": "1000", "MM_MIN": "300", "PITCH_MMPR": "1MMPR", "MM": "0.5", "DEGREES": "0.1"}

#: A tool of its own for each operation, from this number on: above those that most CL files have.
_NUMBER: Final = "NUMBER"
_FIRST_TOOL: Final = 51


def stand_ins(problems: Iterable[Problem]) -> dict[str, str]:
    """Return settings that answer errors, by their names; of an error that offers decisions alone the first one.

    Nothing is decided that lets through what is refused otherwise, and nothing is said of where a part sits.
    """
    found: dict[str, list[str]] = {}
    taken = set[str]()
    numbers = count(_FIRST_TOOL)
    for problem in problems:
        if problem.severity is not Severity.ERROR:
            continue
        asked = asked_settings([problem])
        for each in [one for one in asked if one.to_fill] or _decisions(asked)[:1]:
            values = found.setdefault(each.name, [])
            if ":" not in each.value and values:
                continue
            stated = {value.rpartition(":")[0] for value in values}
            new = [
                one
                for one in each.values
                if one not in taken and (each.to_fill or one.rpartition(":")[0] not in stated)
            ]
            values += [_filled(one, numbers) for one in new]
            taken |= {*new}
    return {name: ",".join(values) for name, values in found.items() if all(values)}


def _decisions(asked: list[AskedSetting]) -> list[AskedSetting]:
    return [each for each in asked if not each.value.endswith(WAIVES)]


def _filled(value: str, numbers: "count[int]") -> str:
    """Return a value with stand-ins for its words; empty where nobody can know one."""
    head, colon, last = value.rpartition(":")
    if last == _NUMBER:
        return f"{head}{colon}{next(numbers)}"
    is_word = last == "…" or (last.isupper() and last.replace("_", "").replace(",", "").isalpha())
    filled = _VALUES.get(last, "" if is_word else last)
    return f"{head}{colon}{filled}" if filled else ""
