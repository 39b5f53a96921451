"""Settings in a project: read from its tables, and what is wrong with them told where it states them."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any, Final

from trunnion.definitions import Table
from trunnion.errors import InputError, Problem, key_subject
from trunnion.jobs.inputs.run_settings import RUN_SETTINGS
from trunnion.jobs.inputs.settings import Settings, SettingValue, as_texts
from trunnion.jobs.project.keys import SETTINGS
from trunnion.jobs.project.project import PostedSetup
from trunnion.messages import Wording
from trunnion.options.words import WORDS_TO_FILL

#: Settings that a table may have.
_MOST_SETTINGS: Final = 500

#: Settings that have a key of another name.
OWN_KEYS: Final = {each.setting: each.key for each in SETTINGS if each.key != each.setting} | {"programs": "divide"}


def read_settings(table: Table) -> tuple[dict[str, SettingValue], dict[str, tuple[str, int, str]]]:
    """Return settings that a table states, in its own keys and in its table ``settings``; and where."""
    own = table.table("settings")
    found: dict[str, Any] = {}
    places = {"settings": (*table.location("settings" if "settings" in table else ""), own.path)}
    own.names()  # the control chooses them: each is known or told below
    stated = own.to_dict()
    if len(stated) > _MOST_SETTINGS:
        table.add_problem("settings", Wording("DEF330", "too_many_settings", count=len(stated), most=_MOST_SETTINGS))
        stated = {}
    for name, value in stated.items():
        if key := OWN_KEYS.get(name):
            own.add_problem(name, Wording("DEF330", "setting_has_key", key=key))
            continue
        try:
            as_texts({name: value})  # type: ignore[dict-item]  # of any type: that is what is judged
        except InputError as error:
            own.problems.extend(
                replace(each, file=own.location(name)[0], line=own.location(name)[1], subject=None)
                for each in error.problems
            )
            continue
        if word := _word_to_fill(name, value):
            own.add_problem(name, Wording("DEF330", "word_to_fill", word=word))
            continue
        found[name], places[name] = value, (*own.location(name), own.key_path(name))
    own.mark_read(*own.keys())
    for name, key in ((each.setting, each.key) for each in SETTINGS if each.key in table):
        if name in found:
            own.add_problem(name, Wording("DEF330", "setting_and_key", key=key))
        value = table.to_dict()[key]
        if isinstance(value, str | float | int | list | dict):  # anything else is a mistake that is told already
            found[name], places[name] = value, (*table.location(key), table.key_path(key))
    if "divide" in table:
        places["programs"] = (*table.location("divide"), table.key_path("divide"))
    return found, places


def _word_to_fill(name: str, value: object) -> str:
    """Return the word of a suggested project in whose place nobody has written a value yet; empty if there is none."""
    if not isinstance(value, str):
        return ""
    if name in RUN_SETTINGS and value in WORDS_TO_FILL:
        return value
    entries = [entry.rpartition(":") for entry in value.split(",")]
    return next((word for _, colon, word in entries if colon and word in WORDS_TO_FILL), "")


#: How a project writes what parameters of messages about the setting ``programs`` say: by its key ``divide``.
_OF_DIVIDE: Final = {"divided": '"subprograms"', "dividing": 'divide = "subprograms"'}


@contextmanager
def told_in_project(setup: PostedSetup, given: Settings) -> Iterator[None]:
    """Tell problems with settings where the project states them; those that are ``given`` otherwise as they are."""
    try:
        yield
    except InputError as error:
        raise InputError([_in_project(problem, setup, given) for problem in error.problems]) from None


def _in_project(problem: Problem, setup: PostedSetup, given: Settings) -> Problem:
    name = problem.setting
    if problem.argument != "settings" or name in given:
        return problem
    stated = dict(problem.wording.parameters)
    wording = problem.wording.with_parameters(**{each: word for each, word in _OF_DIVIDE.items() if each in stated})
    if name in setup.places:
        file, line, key = setup.places[name]
        wording = wording.bare().of_key(key)
    else:
        file, line, key = setup.places["settings"]
        wording = wording.within("of", name=key)
    return Problem(file, line, wording, severity=problem.severity, subject=key_subject(key))
