"""The JSON Schemas of definitions and projects, made of what their loaders ask for; run as a module, this writes them.

A loader asks a table key by key (``Table``), and each question says form, bounds, words and default. Loaders run over
every shipped definition and over one that has all that no shipped one has; the questions together are the schema, and
the pages of the docs bring what keys mean. ``KINDS`` is the list: a new kind of file is one entry in it.
"""

import json
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Any, Final

from tests.support.locations import DOCS, ROOT, TESTS
from trunnion.batch.jobs_file import read_batch_table
from trunnion.controls import load_control
from trunnion.controls.loading import control_library, shipped_controls
from trunnion.definitions import Table, load_table
from trunnion.definitions.expected import GREATEST, Expected, Form, Question
from trunnion.errors import InputError
from trunnion.impeller.definition import read_impeller_table
from trunnion.jobs.describe.definition_checks import stand_in
from trunnion.jobs.project.file import read_project_table
from trunnion.machines import shipped_machines
from trunnion.machines.loading import machine_library, read_machine
from trunnion.readers import check_reading
from trunnion.schemas import KINDS as NAMES
from trunnion.schemas import file_name
from trunnion.simulation.tools.library.toml_library import read_library_table
from trunnion.twin.recording.nodes import node_list_names, read_nodes

FOLDER: Final = ROOT / "src" / "trunnion" / "schemas"
COMPLETE: Final = TESTS / "data" / "definitions"
NODES: Final = ROOT / "src" / "trunnion" / "twin" / "recording" / "library"

Json = dict[str, Any]

#: Arrays of tables that must have names, by which those of a file that extends another merge.
NAMED: Final = ("axis", "body", "format", "word")


@dataclass(frozen=True)
class Kind:
    """A kind of file.

    title     what it is
    read      its loader, for a table and the file in which it stands
    files     definitions that are read: names of shipped ones, and paths
    library   of the names
    docs      pages with tables of keys: page, heading above the first table, what stands before the keys
    variants  arrays of tables of several sorts -> the key that says which
    needs     keys that a loader wants before it asks for others
    table     a table that may hold all keys of the file; empty: there is none
    """

    title: str
    read: Callable[[Table, Path], object]
    files: Sequence[str]
    library: Any
    docs: Sequence[tuple[str, str, str]]
    variants: Mapping[str, str] = field(default_factory=dict)
    needs: Sequence[str] = ()
    table: str = ""


def _read_control(table: Table, path: Path) -> None:
    for judge in (load_control, lambda each: check_reading(stand_in(str(path), each))):
        with suppress(InputError):
            judge(table)


def _machine(table: Table, path: Path) -> None:
    read_machine(table, path.stem)


#: Projects with every key: of one set-up and of several, posted and simulated.
PROJECTS: Final = ("project", "project_setups", "simulation", "simulation_setups")


def _read_project(table: Table, path: Path) -> None:
    """As what it is: a project with an output is posted."""
    top = table.to_dict()
    keys = top.get("simulation", top)
    setups = keys.get("setup") if isinstance(keys, dict) else ()
    tables = [keys, *(setups if isinstance(setups, list) else ())]
    read_project_table(table, path, is_posted=any(isinstance(each, dict) and "output" in each for each in tables))


KINDS: Final[Mapping[str, Kind]] = {
    "machine": Kind(
        "machine definition", _machine, [*shipped_machines(), str(COMPLETE / "machine.toml")], machine_library(),
        [("definitions.md", heading, "") for heading in (
            "### The file", "### `[[axis]]`", "Of a linear axis:", "Of a rotary axis:", "### `[spindle]`",
            "### `[workpiece]`", "### `[facts]`", "### `[[body]]`", "### `[cl.words]`",
        )],
        {"axis": "kind", "body": "shape"},
    ),
    "control": Kind(
        "control definition", _read_control, [*shipped_controls(), str(COMPLETE / "control.toml")], control_library(),
        [("definitions.md", heading, "") for heading in (
            "#### Keys of a control", "`[[control.format]]`, a", "`[[control.word]]`, a", "Other tables:",
        )] + [("reader.md", "| key | may be", "reading."), ("reader-fanuc.md", "| key | meaning |", "reading.")],
        needs=("family",),
    ),
    "project": Kind(
        "project", _read_project,
        [str(ROOT / "examples" / "project" / "part.toml"), str(ROOT / "examples" / "simulation" / "plate.toml"),
         *(str(COMPLETE / f"{name}.toml") for name in PROJECTS)], COMPLETE,
        [("projects.md", "| key of the project", ""), ("projects.md", "| key of a set-up", ""),
         ("simulation.md", "A file is a project if", "")], table="simulation",
    ),
    "tools": Kind(
        "tool library", read_library_table,
        [str(ROOT / "examples" / "simulation" / "tools.toml"), str(COMPLETE / "tools.toml")], COMPLETE,
        [("tool-libraries.md", "## Sizes", "tool.")], {"tool": "kind"},
    ),
    "impeller": Kind(
        "impeller", read_impeller_table,
        [*(str(each) for each in sorted((ROOT / "examples" / "impeller").glob("*.toml"))),
         str(COMPLETE / "impeller.toml")], COMPLETE,
        [("impeller.md", "## The definition", ""), ("impeller.md", "A ball is `ball`", "operation."),
         ("tool-libraries.md", "## Sizes", "tool.")],
        {"tool": "kind", "operation": "kind"},
    ),
    "nodes": Kind(
        "list of OPC UA nodes to record", lambda table, _path: read_nodes(table),
        [*(str(NODES / f"{name}.toml") for name in node_list_names()), str(COMPLETE / "nodes.toml")], COMPLETE,
        [("twin.md", "namespace = \"SinumerikVarProvider\"", "columns.*.")],
    ),
    "batch": Kind(
        "file of jobs", read_batch_table, [str(COMPLETE / "batch.toml")], COMPLETE,
        [("batch.md", "## A file of jobs", ""), ("batch.md", "Keys of a job;", "job."),
         ("batch.md", "Keys of a job;", "defaults.")],
    ),
}  # fmt: skip


@dataclass
class Node:
    """A table of the schema, of all tables that loaders have seen at a path.

    asked      key -> what was asked for it
    required   keys that every one of these tables must have
    variants   value of the deciding key -> keys that are known then, and those that are required
    any_key    keys are chosen by the definition; they are then asked for under ``*``
    children   tables below
    """

    asked: dict[str, list[Expected]] = field(default_factory=dict)
    required: set[str] = field(default_factory=set)
    variants: dict[str, tuple[set[str], set[str]]] = field(default_factory=dict)
    any_key: bool = False
    children: dict[str, "Node"] = field(default_factory=dict)


def schema(name: str) -> Json:
    """The schema of a kind of files, as JSON has it."""
    kind = KINDS[name]
    root = _tree(name)
    meanings = _meanings(kind)
    found: Json = {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": f"Trunnion: {kind.title}",
        **_object(root, "", meanings, kind),
    }
    root.required |= set(kind.needs)
    complete = _complete(root)
    if kind.table:
        _add_table(kind.table, found, complete)
    found["properties"] = {"extends": _extends(kind, meanings), **found["properties"]}
    if name == "machine":
        control = schema("control")
        for key in ("$schema", "title", "if", "else"):
            control.pop(key)
        complete_control = control.pop("$defs")["complete"]
        control["description"] = meanings.get("control", "")
        found["properties"]["control"] = control
        short = {"anyOf": [{"maxProperties": 0}, {"maxProperties": 1, "required": ["family"]}]}
        complete["properties"]["control"] = {
            "if": {"anyOf": [{"required": ["extends"]}, short]}, "else": complete_control
        }  # fmt: skip
    return {
        **found,
        "if": {"required": ["extends"]},
        "else": {"$ref": "#/$defs/complete"},
        "$defs": {"complete": complete},
    }


def _extends(kind: Kind, meanings: Mapping[str, str]) -> Json:
    """The key that every loader follows before it asks for any other."""
    shipped = [each for each in kind.files if not each.endswith(".toml")]
    meaning = meanings.get("extends") or "a .toml file beside this one or below, whose keys count where this has none"
    return {"type": "string", "description": meaning} | ({"examples": shipped} if shipped else {})


def _add_table(table: str, found: Json, complete: Json) -> None:
    """Let all keys of a file stand in one table too; then none stands beside it."""
    keys = {key: found[key] for key in ("type", "properties", "additionalProperties")}
    meaning = "in place of the keys at the top: all of them in this table"
    others = {"properties": dict.fromkeys(found["properties"], False)}
    found["allOf"] = [*found.get("allOf", ()), {"if": {"required": [table]}, "then": others}]
    found["properties"] = {**found["properties"], table: {"description": meaning, **keys}}
    at_top = dict(complete)
    complete.clear()
    complete.update({"if": {"required": [table]}, "then": {"properties": {table: at_top}}, "else": at_top})


@cache
def questions(name: str) -> tuple[tuple[dict[str, Any], list[Question]], ...]:
    """What the loader asks of each definition of a kind, with the definition."""
    kind, found = KINDS[name], []
    for file in kind.files:
        asked: list[Question] = []
        table = replace(load_table(file, kind.library), questions=asked)
        with suppress(InputError):
            kind.read(table, Path(file))
        found.append((table.to_dict(), asked))
    return tuple(found)


def _tree(name: str) -> Node:
    """The tables of a kind."""
    kind, root = KINDS[name], Node()
    runs = [(content.get(kind.table, content), _at_top(asked, kind.table)) for content, asked in questions(name)]
    open_tables = {_plain(each.path) for _, asked in runs for each in asked if each.expected.form is Form.ANY_KEY}
    instances: dict[tuple[str, ...], dict[tuple[int, str], dict[str, bool]]] = {}
    values: dict[tuple[int, str], Any] = {}
    for run, (content, asked) in enumerate(runs):
        for path, key, expected in asked:
            if kind.table and not path and key == kind.table:
                continue
            steps = tuple(_steps(path, open_tables))
            node = _node(root, steps)
            keys = instances.setdefault(steps, {}).setdefault((run, path), {})
            if expected.form is Form.ANY_KEY:
                node.any_key = True
                continue
            key = "*" if _plain(path) in open_tables else key
            node.asked.setdefault(key, []).append(expected)
            keys[key] = keys.get(key, True) and expected.required
            values.setdefault((run, path), _at(content, path))
    for steps, tables in sorted(instances.items(), key=lambda each: -len(each[0])):
        node = _node(root, steps)
        node.required = set.intersection(*({key for key, needed in keys.items() if needed} for keys in tables.values()))
        for key in set.intersection(*(set(keys) for keys in tables.values())) - {"*"}:
            if node.asked[key][0].form is Form.TABLE and _node(root, (*steps, key)).required - {"*"}:
                node.required.add(key)  # a table that must have something in it
        decides = kind.variants.get(".".join(steps))
        for place, keys in tables.items() if decides else ():
            sort = (values.get(place) or {}).get(decides)
            if isinstance(sort, str):
                needed = {key for key, required in keys.items() if required}
                known, must = node.variants.get(sort, (set(), needed))
                node.variants[sort] = known | keys.keys(), must & needed
    return root


def _at_top(asked: Sequence[Question], table: str) -> list[Question]:
    """Questions as they are where the keys of the table stand at the top of the file."""
    if not table:
        return list(asked)
    return [each._replace(path=re.sub(rf"^{table}(\.|$)", "", each.path)) for each in asked]


def _plain(path: str) -> str:
    return re.sub(r"\[\d+\]", "", path)


def _steps(path: str, open_tables: set[str]) -> Iterator[str]:
    """The keys on the way to a table; ``*`` for one that the definition chooses."""
    at = ""
    for part in _plain(path).split(".") if path else ():
        yield "*" if at in open_tables else part
        at = f"{at}.{part}" if at else part


def _at(content: Any, path: str) -> Any:
    for part in path.split(".") if path else ():
        key, _, index = part.partition("[")
        content = content.get(key, {}) if isinstance(content, dict) else {}
        if index:
            content = content[int(index.rstrip("]"))]
    return content


def _node(root: Node, steps: Iterable[str]) -> Node:
    for step in steps:
        root = root.children.setdefault(step, Node())
    return root


def _object(
    node: Node, path: str, meanings: Mapping[str, str], kind: Kind, *, is_item: bool = False
) -> Json:  # fmt: skip
    """The schema of a table, maybe one of several: what each of its keys may be, and no others; none is required."""
    properties = {
        key: _property(node, key, f"{path}{key}", meanings, kind) for key in node.asked if key != "*"
    }  # fmt: skip
    found: Json = {"type": "object", "properties": properties, "additionalProperties": False}
    if is_item and "name" in node.asked:
        properties["remove"] = {"type": "boolean", "description": "in a file that extends another: take it out"}
    if path.rstrip(".") in NAMED:
        found["required"] = ["name"]  # by which it is merged
    if node.any_key:
        rest = _property(node, "*", f"{path}*", meanings, kind) if "*" in node.asked else {}
        found = {"type": "object", "additionalProperties": rest}
    decides = kind.variants.get(path.rstrip("."), "")
    sorts = [
        {
            "if": {"properties": {decides: {"const": sort}}, "required": [decides]},
            "then": {"properties": {key: False for key in node.asked if key not in known}},
        }
        for sort, (known, _) in node.variants.items()
        if node.asked.keys() - known
    ]
    return found | ({"allOf": sorts} if sorts else {})


def _property(node: Node, key: str, path: str, meanings: Mapping[str, str], kind: Kind) -> Json:
    asked = list(dict.fromkeys(map(_hashable, node.asked[key])))
    by_form: dict[Form, list[Expected]] = {}
    for expected in asked:
        by_form.setdefault(expected.form, []).append(expected)
    child = node.children.get(key, Node())
    choices = [_value(form, each, child, path, meanings, kind) for form, each in by_form.items()]
    found: Json = choices[0] if len(choices) == 1 else {"anyOf": choices}
    above, _, last = path.rpartition(".")
    if meaning := meanings.get(path) or meanings.get(f"{above.rpartition('.')[0]}.{last}".lstrip(".")):
        found = {"description": meaning, **found}
    defaults = [each.default for each in asked if each.default not in (None, "", ())]
    if len({json.dumps(default) for default in defaults}) == 1 and len(defaults) == len(asked):
        default = defaults[0]
        found["default"] = list(default) if isinstance(default, tuple) else default
    return found


def _hashable(expected: Expected) -> Expected:
    default = expected.default
    return replace(expected, default=tuple(default) if isinstance(default, list) else default)


def _value(
    form: Form, asked: Sequence[Expected], node: Node, path: str, meanings: Mapping[str, str], kind: Kind
) -> Json:
    number = {"type": "number", "minimum": int(-GREATEST), "maximum": int(GREATEST)}
    match form:
        case Form.TEXT:
            return _text(asked)
        case Form.SETTING:
            return {"type": ["string", "number", "boolean"]}
        case Form.NUMBER:
            bounds = _bounds(asked)
            return {
                key: value for key, value in number.items() if key != "minimum" or "exclusiveMinimum" not in bounds
            } | bounds
        case Form.WHOLE:
            whole: Json = {"type": "integer", **_bounds(asked)}
            words = [each.nothing for each in asked if each.nothing]
            return {"anyOf": [whole, {"const": words[0]}]} if words else whole
        case Form.FLAG:
            return {"type": "boolean"}
        case Form.VECTOR | Form.INTERVAL:
            return {"type": "array", "items": number, "minItems": asked[0].size, "maxItems": asked[0].size}
        case Form.LINES:
            return {"type": ["string", "array"], "items": {"type": "string"}}
        case Form.TEXTS:
            return {"type": "array", "items": {"type": "string"}}
        case Form.TABLE:
            return _object(node, f"{path}.", meanings, kind)
        case Form.TABLES:
            return {"type": "array", "items": _object(node, f"{path}.", meanings, kind, is_item=True)}
    raise AssertionError(form)


def _text(asked: Sequence[Expected]) -> Json:
    words = {each.one_of for each in asked}
    found: Json = {"type": "string"}
    if len(words) == 1 and asked[0].one_of:
        found["enum"] = list(asked[0].one_of)
    elif any(words):  # they depend on the rest of the definition
        found["examples"] = sorted({word for each in words for word in each})
    patterns = {each.pattern for each in asked}
    if len(patterns) == 1 and asked[0].pattern:
        found["pattern"] = f"^(?:{asked[0].pattern})$"
    return found


def _bounds(asked: Sequence[Expected]) -> Json:
    """The widest bounds of all questions."""
    found: Json = {}
    lows = [(each.at_least, False) if each.at_least is not None else (each.above, True) for each in asked]
    if all(low is not None for low, _ in lows):
        low, above = min((float(low or 0), above) for low, above in lows)
        found["exclusiveMinimum" if above else "minimum"] = low
    highs = [each.at_most for each in asked]
    if all(high is not None for high in highs):
        found["maximum"] = max(float(high or 0) for high in highs)
    return {key: int(value) if value.is_integer() else value for key, value in found.items()}


def _complete(node: Node) -> Json:
    """What a table must have that extends nothing, with the tables below it."""
    found: Json = {"required": sorted(node.required - {"*"})} if node.required - {"*"} else {}
    below: Json = {}
    for key, child in node.children.items():
        inner = _complete(child)
        if key == "*":
            if inner:
                found["additionalProperties"] = inner
            continue
        if any(each.form is Form.TABLES for each in node.asked[key]):
            sorts = [
                {
                    "if": {"properties": {_DECIDES[key]: {"const": sort}}},
                    "then": {"required": sorted(must - child.required)},
                }
                for sort, (_, must) in child.variants.items()
                if must - child.required
            ]
            removal = {"properties": {"remove": False}} if "name" in child.asked else {}
            parts = inner | removal | ({"allOf": sorts} if sorts else {})
            if removal and "properties" in inner:
                parts["properties"] = inner["properties"] | removal["properties"]
            inner = {"items": parts} if parts else {}
        if inner:
            below[key] = inner
    return found | ({"properties": below} if below else {})


_DECIDES: Final = {"axis": "kind", "body": "shape", "tool": "kind", "operation": "kind"}


def _meanings(kind: Kind) -> dict[str, str]:
    """What the tables of the docs say of keys: the last cell, as text."""
    found: dict[str, str] = {}
    for page, heading, before in kind.docs:
        text = (DOCS / page).read_text(encoding="utf-8")
        table = re.search(r"(?:^ *\|.*\n)+", text[text.index(heading) :], re.MULTILINE)
        assert table, heading
        for row in table.group().splitlines()[2:]:
            cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", row.strip().strip("|"))]
            keys = re.findall(
                r"`\[*([A-Za-z][A-Za-z0-9_.]*)\]*`", cells[1] if "in a text" in table.group() else cells[0]
            )
            for key in keys:
                key = key.removeprefix("control.") if kind.title.startswith("control") else key
                found.setdefault(before + key, _words(cells[-1]))
    return found


def _words(cell: str) -> str:
    """A cell of a table without marks and links."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", cell)
    return text.replace("`", "").replace("\\|", "|").strip()


def text_of(name: str) -> str:
    """The file of a schema."""
    return json.dumps(schema(name), indent=1, ensure_ascii=False) + "\n"


if __name__ == "__main__":
    for each in NAMES:
        (FOLDER / file_name(each)).write_text(text_of(each), encoding="utf-8", newline="\n")
