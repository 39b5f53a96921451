"""What is stated of a program besides the definition of its machine, for one run.

In:     a machine, words with what they do, and variables with their values.
Out:    the machine, whose definition says so too; and what of it a run has relied on.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from trunnion.definitions import LocatedValue, Table
from trunnion.errors import Severity
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.run import Diagnostic, Run
from trunnion.model.stated_words import StatedWord
from trunnion.readers.program.declared_variables import OF_VARIABLES
from trunnion.readers.program.known_words import KnownWord, normal_word, plain_code
from trunnion.readers.program.settings import GIVEN, control_of


def with_stated(machine: Machine, words: Mapping[str, str], variables: Mapping[str, float]) -> Machine:
    """Return the machine with ``[control.known]`` and ``[control.reading.variables]`` as they are stated besides.

    The family judges names and effects when the definition is checked.
    """
    known = {word: _located(effects) for word, effects in words.items()}
    values = {name: _located(value) for name, value in variables.items()}
    added = {"known": _located(known), "reading": _located({"variables": _located(values)})}
    return replace(machine, control=_merged(machine.control, added))


def with_reading(machine: Machine, keys: Mapping[str, object]) -> Machine:
    """Return the machine whose ``[control.reading]`` has some keys besides, as a trial."""
    added = {"reading": _located({key: _located(value) for key, value in keys.items()})}
    return replace(machine, control=_merged(machine.control, added))


def stated_words(known: Iterable[KnownWord], noted: Iterable[Diagnostic], machine: Machine) -> tuple[StatedWord, ...]:
    """Return what a run relied on: words that have whole blocks, or were given for the run, and variables.

    known  the declared words that the run met
    noted  its diagnostics, which name the variables that it read
    """
    words = [StatedWord(each.word, each.says, each.is_given) for each in known if each.code is None or each.is_given]
    control = control_of(machine)
    values, effects = control.table("reading").table("variables"), control.table("known")
    replaced = {normal_word(name): effects.replaced(name) for name in effects.names()}
    words = [replace(each, instead=str(replaced.get(each.word) or "")) for each in words]
    for each in noted:
        if each.code == OF_VARIABLES:
            name, value = str(each.wording.parameter("name")), each.wording.parameter("value")
            is_given, other = values.location(name)[0] == GIVEN, values.replaced(name)
            words.append(StatedWord(name, f"= {value:g}", is_given, "" if other is None else f"{other:g}"))
    return tuple(dict.fromkeys(words))


def unread_words(runs: Sequence[Run], machine: Machine) -> Iterator[Diagnostic]:
    """Yield a warning for each word and variable that was stated for the run alone, and that no meaning relied on."""
    control = control_of(machine)
    met = {plain_code(normal_word(each.word)) for run in runs for each in run.stated}
    for table in (control.table("known"), control.table("reading").table("variables")):
        for name in table.names():
            if table.location(name)[0] == GIVEN and plain_code(normal_word(name)) not in met:
                wording = Wording("NC228", "never_needed", word=name)
                yield Diagnostic(0, wording, Severity.WARNING, runs[0].files[0])


def _located(value: object) -> LocatedValue:
    return LocatedValue(value, GIVEN, 0)


def _merged(table: Table, added: Mapping[str, LocatedValue]) -> Table:
    """Return a table with further keys, those of tables within it merged."""
    content = table.content
    assert isinstance(content.value, dict)
    merged = LocatedValue(_merged_values(content.value, added), content.file, content.line)
    return table.other(merged, [])


def _merged_values(own: Mapping[str, LocatedValue], added: Mapping[str, LocatedValue]) -> dict[str, LocatedValue]:
    found = dict(own)
    for key, each in added.items():
        before = found.get(key)
        if before is not None and isinstance(before.value, dict) and isinstance(each.value, dict):
            each = LocatedValue(_merged_values(before.value, each.value), before.file, before.line)
        elif before is not None and before.value != each.value:
            each = replace(each, instead=before.value)
        found[key] = each
    return found
