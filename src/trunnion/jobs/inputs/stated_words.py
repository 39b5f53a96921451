"""What is stated for one run besides the definition: values of variables, and what unknown words do.

In:     settings, among which variables have their values, and words with their effects.
Out:    the machine whose definition says so too, and the settings that are none of its variables.
"""

import math
from collections.abc import Iterable, Mapping
from typing import Final

from trunnion import readers
from trunnion.errors import InputError, Problem, argument_problem, setting_problem
from trunnion.jobs.inputs.arguments import no_mapping
from trunnion.jobs.inputs.settings import Settings, SettingValue, as_texts
from trunnion.machines import Machine
from trunnion.messages import Wording

#: Where the machine has the values that a call states.
_VARIABLES: Final = "control.reading.variables."


def with_stated(
    machine: Machine, settings: Settings | None, assume: Mapping[str, str] | None
) -> tuple[Machine, Mapping[str, SettingValue]]:
    """Return the machine with what is stated besides, and the settings that are no variables of its control.

    Raises ``InputError`` of the setting or the argument, if a variable has no number or a word cannot be declared.
    """
    settings, words = settings or {}, assumed_words(assume)
    names = _variables_of(machine, settings)
    texts = as_texts({name: settings[key] for key, name in names.items()})
    if not (texts or words):
        return machine, settings
    stated = readers.with_stated(machine, words, {name: _number(name, text) for name, text in texts.items()})
    try:
        readers.check_reading(stated)
    except InputError as error:
        raise InputError([_of_argument(each) for each in error.problems]) from None
    return stated, {key: value for key, value in settings.items() if key not in names}


def _variables_of(machine: Machine, settings: Settings) -> dict[str, str]:
    """Return the settings that are variables of the control -> how it calls them.

    Raises ``InputError`` of a setting that is the variable of one before it.
    """
    reader = readers.reader_of(machine) if readers.can_read(machine) else None
    names: dict[str, str] = {}
    for key in settings:
        name = reader.variable(key) if reader is not None and isinstance(key, str) else ""
        if name in names.values():
            raise InputError(setting_problem(key, Wording("ARG230", "variable_stated_twice", name=name)))
        if name:
            names[key] = name
    return names


def refuse_settings(left: Iterable[str], *machines: Machine) -> None:
    """Refuse settings that are variables of none of the controls, where there is nothing else to set.

    Raises ``InputError`` of the settings.
    """
    names = tuple(dict.fromkeys(machine.key for machine in machines))
    if problems := [setting_problem(key, Wording("ARG210", "no_variable", machines=names)) for key in left]:
        raise InputError(problems)


def assumed_words(assume: object) -> dict[str, str]:
    """Return words and effects; the command line has them as pairs.

    Raises ``InputError`` of the argument.
    """
    if assume is None:
        return {}
    found = list(assume.items()) if isinstance(assume, Mapping) else assume
    if not isinstance(found, list) or not all(_is_pair_of_texts(each) for each in found):
        raise no_mapping("assume", assume)
    return dict(found)


def _is_pair_of_texts(value: object) -> bool:
    return isinstance(value, tuple | list) and len(value) == 2 and all(isinstance(text, str) for text in value)


def _number(name: str, text: str) -> float:
    """Return the value of a variable."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(
            setting_problem(name, Wording("ARG220", "no_number_of_variable", value=repr(text), variable=name))
        )
    return value


def _of_argument(problem: Problem) -> Problem:
    """Return a problem with what was given as one with the argument; one of the definition as it is."""
    if problem.file != readers.GIVEN:
        return problem
    if problem.subject is not None and problem.subject.name.startswith(_VARIABLES):
        return setting_problem(problem.subject.name.removeprefix(_VARIABLES), problem.wording.bare())
    return argument_problem("assume", problem.wording)
