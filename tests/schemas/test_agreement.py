"""Schemas and loaders agree: what a schema refuses a loader refuses, and the other way but for what is listed here."""

import copy
import json
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft7Validator

from tests.support.locations import ROOT
from tests.support.schemas import COMPLETE, FOLDER, KINDS, PROJECTS, questions, schema, text_of
from trunnion.controls import load_control
from trunnion.definitions import Table, load_draft
from trunnion.definitions.source_lines import locate_values
from trunnion.errors import InputError
from trunnion.jobs.describe.definition_checks import machine_problems, stand_in
from trunnion.machines.loading import machine_library
from trunnion.readers import check_reading
from trunnion.schemas import KINDS as NAMES
from trunnion.schemas import file_name

Json = dict[str, Any]

#: What a schema cannot say, by what a loader tells of it: judgements between several keys, and of files.
BETWEEN_SIZES = [
    r"is that of", r"neither number nor name", r"_diameter_mm is not a key", r"(lower|upper)_diameter_mm is missing",
    r"not stated", r"more than", r"but the tool", r"not between", r"_deg is (90|180)", r"tip_diameter_mm is", r"teeth",
    r"reach the tool axis", r"less than both corners",
]  # fmt: skip
JUDGED = {
    "machine": [
        r"limits_deg is (missing|given for an endless axis)", r"outside of the limits", r"link is ", r"above max_rpm",
        r"has \d+ linear", r"is parallel to", r"low < high", r"the name of", r"file is ", r"never shows it",
        r"for an axis with limits",
    ],
    "control": [
        r"there is no format", r"(word\[\d+\]\.format|by_method\[\d+\]\.setting|word\[\d+\]\.name|letter) is ",
        r"format\[\d+\].name is", r"word has no entry", r"calls$", r"templates\.\w+ (is missing|is not a key|prints)",
        r"rule of no setting", r"extension is ", r"explains no setting", r"numbers start at",
        r"numbers without a letter",
        r"settings\.\w+ is ", r"units\.mm is missing",
        r"subprograms\.longest_name is (missing|not a)",
        r"codes\.\w+ is (missing|not a)",
        r"word\[\d+\]\.(letter|format) is (missing|not a key)", r"has no words for that", r"by_method\[\d+\]\.value",
        r"setting_rules\.\w+\.\w+ is not a key", r"in_force\.\w+ is not a key", r"reading\.\w+ is not a key",
        r"reading\.words\.\S+ is (not|no word)", r"known\.\S+ (has no effect|is a word)", r"settings is missing",
    ],
    "project": [r"there is no such file", r"leads out", r"is \[\]", r"the first set-up", r"work_offset", r"stock",
                r"(machine|programs|output|cl) is missing", r"tools", r"beside set-ups", r"beside output",
                r"until ends the simulation early", r"belongs to a program that is posted",
                r"every operation has a program of its own", r"posts nothing"],
    "tools": BETWEEN_SIZES,
    "impeller": [*BETWEEN_SIZES, r"(points|curves|name) is ", r"names '", r"way is ", r"is not among the tools",
                 r"needs either", r"^tool is missing", r"wants", r"flutes of tool",
                 r"not less than the diameter", r"a wall would stay"],
    "nodes": [r"is empty", r"is given beside", r"does not say which variable", r"has no namespace"],
    "batch": [r"there is no such file", r"leads out", r"has no meaning with", r"matches no file", r"is \[\]",
              r"(machine|stock) is missing", r"say where a conversion leads"],
}  # fmt: skip

#: Documents that are mutated, of each kind, and the table in which; empty: in all.
DOCUMENTS = {
    "machine": [(str(COMPLETE / "machine.toml"), "")],
    "control": [("sinumerik_840d", ""), ("fanuc_31i", "reading"), ("heidenhain_tnc640", "by_method")],
    "project": [(str(COMPLETE / f"{name}.toml"), "") for name in PROJECTS],
    "tools": [(str(COMPLETE / "tools.toml"), "")],
    "impeller": [(str(ROOT / "examples" / "impeller" / "impeller.toml"), "")],
    "nodes": [(str(COMPLETE / "nodes.toml"), "")],
    "batch": [(str(COMPLETE / "batch.toml"), "")],
}

#: Tables whose keys are all alike: the first and the last of them stand for all.
ALIKE = {"templates", "codes", "coolant", "in_force", "tool_types", "phases"}

UNKNOWN = "no_such_key"


def told(kind: str, content: Json, path: Path) -> list[str]:
    """What the loader tells of a definition that extends nothing."""
    table = Table(locate_values(copy.deepcopy(content), str(path), {}))
    try:
        if kind == "control":
            load_control(table)
            check_reading(stand_in(str(path), table))
        else:
            KINDS[kind].read(table, path)
    except InputError as error:
        return [problem.what for problem in error.problems]
    return []


def document(kind: str, file: str) -> Json:
    content = next(found for (found, _), name in zip(questions(kind), KINDS[kind].files, strict=True) if name == file)
    return {key: value for key, value in copy.deepcopy(content).items() if key != "extends"}


def keys_of(part: Json, at: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Json]]:
    """The keys of a schema: the way to the table, the key, and what it may be; ``[]`` for items, ``*`` for any key."""
    own = [(key, value) for key, value in part.get("properties", {}).items() if isinstance(value, dict)]
    for key, value in own if not own or not at or at[-1] not in ALIKE else [own[0], own[-1]]:
        yield (*at, key), value
        yield from keys_of(value, (*at, key))
        yield from keys_of(value.get("items", {}), (*at, key, "[]"))
    rest = part.get("additionalProperties")
    if isinstance(rest, dict):
        yield from keys_of(rest, (*at, "*"))


def tables_at(content: Any, steps: tuple[str, ...]) -> Iterator[Json]:
    if not steps:
        yield from [content] if isinstance(content, dict) else []
    elif steps[0] == "[]":
        for item in content if isinstance(content, list) else []:
            yield from tables_at(item, steps[1:])
    elif steps[0] == "*":
        for item in content.values():
            yield from tables_at(item, steps[1:])
    elif isinstance(content, dict) and steps[0] in content:
        yield from tables_at(content[steps[0]], steps[1:])


def wrong_values(may_be: Json) -> Iterator[Any]:
    """A value of another type; one beyond each bound, and out of the words; and one that is just inside."""
    yield 7 if may_be.get("type") == "string" else "?"
    if "enum" in may_be or "pattern" in may_be:
        yield "no such word"
    for key, step in (("minimum", -1), ("exclusiveMinimum", 0), ("maximum", 1)):
        if key in may_be:
            yield may_be[key] + step
    if "maximum" in may_be:
        yield may_be["maximum"]
    if may_be.get("type") == "array" and "minItems" in may_be:
        yield [1.5] * (may_be["minItems"] + 1)
    if may_be.get("type") == "array" and "items" in may_be:
        yield [True]


def mutants(kind: str, content: Json, within: str) -> Iterator[tuple[str, Json]]:
    """The definition with one key wrong, missing or too many; it is the same object each time, changed in place."""
    seen: set[tuple[str, ...]] = set()
    for steps, may_be in keys_of(schema(kind)):
        if kind == "machine" and steps[0] == "control":
            continue  # a machine's loader does not read it
        if within and steps[0] != within:
            continue
        tables = list(tables_at(content, steps[:-1]))
        table = next((each for each in tables if steps[-1] in each), tables[0] if tables else None)
        if table is None or steps == ("extends",):
            continue
        where, before = ".".join(steps), dict(table)
        changes: list[Json] = [{**before, steps[-1]: value} for value in wrong_values(may_be)]
        if steps[-1] in before:
            changes.append({key: value for key, value in before.items() if key != steps[-1]})
        if steps[:-1] not in seen:
            changes.append({**before, UNKNOWN: "?"})
            seen.add(steps[:-1])
        for change in changes:
            table.clear()
            table.update(change)
            yield f"{where}: {change.get(steps[-1], 'missing')}", content
        table.clear()
        table.update(before)


@pytest.mark.third
@pytest.mark.parametrize("kind", NAMES)
def test_the_file_of_a_schema_is_what_its_loader_asks_for(kind: str) -> None:
    """``python -m tests.support.schemas`` writes them."""
    assert (FOLDER / file_name(kind)).read_text(encoding="utf-8") == text_of(kind)
    Draft7Validator.check_schema(json.loads(text_of(kind)))


@pytest.mark.third
@pytest.mark.parametrize(("kind", "file"), [(kind, file) for kind in NAMES for file in KINDS[kind].files])
def test_a_schema_takes_what_is_shipped(kind: str, file: str) -> None:
    path = Path(file) if file.endswith(".toml") else Path(str(KINDS[kind].library)) / f"{file}.toml"
    own = tomllib.loads(path.read_text(encoding="utf-8"))
    assert [error.message for error in Draft7Validator(schema(kind)).iter_errors(own)] == []


@pytest.mark.third
@pytest.mark.parametrize(("kind", "file", "within"), [(kind, *each) for kind in NAMES for each in DOCUMENTS[kind]])
def test_schema_and_loader_refuse_the_same(kind: str, file: str, within: str) -> None:
    content, path = document(kind, file), Path(file)
    before = set(told(kind, content, path))  # of files that are not there
    validator, judged = Draft7Validator(schema(kind)), re.compile("|".join(JUDGED[kind]))
    refused, apart = 0, []
    for where, mutant in mutants(kind, content, within):
        loader = [what for what in told(kind, mutant, path) if what not in before]
        is_valid = validator.is_valid(mutant)
        refused += not is_valid
        if not is_valid and not loader:
            apart.append(f"the schema alone refuses {where}")
        elif is_valid and not all(map(judged.search, loader)):
            apart.append(f"the loader alone refuses {where}: {loader}")
    assert not apart, "\n".join(apart)
    assert refused > 5


EXTENDS = 'extends = "yl569"\nname = "Ours"\n'


@pytest.mark.third
@pytest.mark.parametrize(
    ("text", "good"),
    [
        (EXTENDS, True),
        (EXTENDS + '[[axis]]\nname = "C"\npoint_mm = [0, 0, 1]\n', True),
        (EXTENDS + '[[axis]]\nname = "C"\npoint_mm = [0, 0]\n', False),
        (EXTENDS + "[[axis]]\npoint_mm = [0, 0, 1]\n", False),
        (EXTENDS + '[[body]]\nname = "head"\nremove = true\n', True),
        (EXTENDS + '[[body]]\nname = "head"\nremove = "yes"\n', False),
        (EXTENDS + '[[axis]]\nname = "C"\nkind = "rotary"\nlimits_mm = [0, 1]\n', False),
        (EXTENDS + '[control.settings]\nwork_offset = "G55"\n', True),
        (EXTENDS + "[control.settings]\nwork_offset = [55]\n", False),
        (EXTENDS + '[[control.format]]\nname = "coordinate"\ndecimals = 4\n', True),
        (EXTENDS + '[[control.format]]\nname = "coordinate"\ndecimals = 14\n', False),
        (EXTENDS + "[control.coolant]\nON = \"none\"\nAIR = 127\n", True),
        (EXTENDS + '[control.coolant]\nON = "off"\n', False),
        (EXTENDS + "[control]\nno_such_key = 1\n", False),
        (EXTENDS + '[control]\nextends = "fanuc_31i"\n', True),
        (EXTENDS.replace("extends", "#") + "schema = 1\n", False),
    ],
)  # fmt: skip
def test_a_machine_that_extends_another_is_judged_alike(text: str, good: bool) -> None:
    validator = Draft7Validator(schema("machine"))
    assert validator.is_valid(tomllib.loads(text)) == good
    assert (machine_problems(load_draft(text, Path("ours.toml"), machine_library()), "ours") == []) == good


PART = 'machine = "yl569"\ncl = ["a.cls"]\noutput = "a.mpf"\n'


@pytest.mark.third
@pytest.mark.parametrize(
    ("text", "good"),
    [
        (PART, True),
        ("[simulation]\n" + PART, True),
        (PART + "[simulation]\n" + PART, False),
        ('strict = true\n[simulation]\n' + PART, False),
        (PART + 'settings = { title = "A", tcp = false, feed_limit = 200, zero = [0, 0, 1] }\n', True),
        (PART + "settings = 7\n", False),
        (PART + '[[setup]]\nname = "top"\nremove = true\n', False),
        ('extends = "base.toml"\n[[setup]]\nname = "top"\nremove = true\n', True),
        ('extends = "base.toml"\noutputs = "b.mpf"\n', False),
        ("zero_mm = [0, 0]\n" + PART, False),
        (PART + '[checks]\nsimulate = "yes"\n', False),
    ],
)  # fmt: skip
def test_a_project_is_judged_with_its_keys_at_the_top_and_in_a_table(text: str, good: bool) -> None:
    assert Draft7Validator(schema("project")).is_valid(tomllib.loads(text)) == good


@pytest.mark.parametrize("kind", ["tools", "impeller", "nodes"])
def test_what_extends_another_file_needs_no_more(kind: str) -> None:
    validator = Draft7Validator(schema(kind))
    assert validator.is_valid({"extends": "base.toml"})
    assert not validator.is_valid({"extends": 7})


def test_every_toml_file_of_the_examples_names_its_schema() -> None:
    lessons = ROOT / "examples" / "course"  # texts of the course, which no command reads
    for path in sorted({*(ROOT / "examples").rglob("*.toml")} - {*lessons.glob("*.toml")}):
        first = path.read_text(encoding="utf-8").partition("\n")[0]
        assert first.startswith("#:schema "), path
        named = (path.parent / first.removeprefix("#:schema ")).resolve()
        kind = next(each for each in NAMES if named == (FOLDER / file_name(each)).resolve())
        own = tomllib.loads(path.read_text(encoding="utf-8"))
        assert [error.message for error in Draft7Validator(schema(kind)).iter_errors(own)] == [], path
