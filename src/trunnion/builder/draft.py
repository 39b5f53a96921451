"""A definition that is being written: what it says, where each value comes from, and what is wrong with it.

In:     the text of a definition, and the file that it would be saved as.
Out:    what the builder's page shows, as JSON has it.
"""

import tomllib
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

from trunnion.builder.fields import PAGES, Field, SettingNotes, fields_of, named_path, tables_of, value_at
from trunnion.controls import load_control
from trunnion.controls.loading import with_control
from trunnion.definitions import LocatedValue, Table, load_draft
from trunnion.definitions.toml_text import written
from trunnion.definitions.value_marks import marked_values
from trunnion.errors import InputError, Problem
from trunnion.jobs.describe.controls import describe_settings
from trunnion.jobs.describe.definition_checks import machine_problems
from trunnion.machines import Machine
from trunnion.machines.jog_table import jog_table
from trunnion.machines.loading import machine_library, read_machine
from trunnion.messages import LIBRARY, Wording, Words, joined, phrase, said_in
from trunnion.records import dataclass
from trunnion.results import to_data
from trunnion.simulation.collisions.bodies import machine_bodies
from trunnion.viewer.content import body_scene, machine_scene
from trunnion.viewer.shown import problem_text, said

#: A longer definition is not edited here.
MOST_LETTERS: Final = 200_000

#: Bodies of more triangles together are not drawn.
_MOST_TRIANGLES: Final = 100_000

#: From here on a whole number of the page has digits of its own.
_BEYOND_PAGE: Final = 2.0**53


@dataclass(frozen=True, slots=True, eq=False)
class Draft:
    """A definition as it stands.

    text      as it would be saved
    path      where it would be saved
    root      merged with all that it extends, its control too; None: it cannot even be read
    machine   what it describes; None: it has mistakes
    problems  all mistakes
    """

    text: str
    path: Path
    root: LocatedValue | None
    machine: Machine | None
    problems: tuple[Problem, ...]


def judge(text: str, path: Path) -> Draft:
    """Read a definition, and find every mistake of it.

    text  of the definition; lines end with a newline alone
    path  where it would be saved. What it extends lies beside or below it
    """
    if len(text) > MOST_LETTERS:
        return Draft(
            text,
            path,
            None,
            None,
            (Problem(str(path), 0, Wording("PAG213", "letters_more_not", count=len(text), most_letters=MOST_LETTERS)),),
        )
    try:
        table = load_draft(text, path, machine_library())
    except InputError as error:
        return Draft(text, path, None, None, error.problems)
    problems = machine_problems(table, path.stem)
    machine = None
    with suppress(InputError):
        machine = read_machine(table.unread_copy(), path.stem)
    return Draft(text, path, with_control(table), machine, tuple(problems))


def draft_data(draft: Draft, words: Words = LIBRARY) -> dict[str, Any]:
    """Return what the page shows of a definition: pages of fields, mistakes, the machine, and its jog table."""
    root = draft.root
    base = None if root is None else _base(draft)
    fields = [] if root is None else fields_of(root, _notes(root))
    return {
        "pages": {
            page: [_field(each, root, base, draft, words) for each in fields if each.page == page] for page in PAGES
        },
        "problems": [_problem(each, draft, words) for each in draft.problems],
        "marks": [] if root is None else [_mark(root, words, *each) for each in marked_values(draft.text)],
        "axes": _axes(root),
        "extends": _plain_text(root and _own(draft).get("extends")),
        **_machine(draft.machine, words),
    }


def inherited_value(draft: Draft, path: tuple[Any, ...]) -> object:
    """Return what a definition would have at a path without a value of its own; None: nothing."""
    base = _base(draft)
    found = None if base is None else value_at(base, path)
    return None if found is None else _plain(found)


def _field(
    each: Field, root: LocatedValue | None, base: LocatedValue | None, draft: Draft, words: Words
) -> dict[str, Any]:
    found = None if root is None else value_at(root, each.path)
    below = None if base is None else value_at(base, each.path)
    name, help_ = _texts(each, words)
    return {
        **to_data(each),
        "name": name,
        "help": help_,
        "value": None if found is None else _shown(found, each),
        "inherited": None if below is None else _shown(below, each),
        "own": found is not None and found.file == str(draft.path),
        "from": "" if found is None else f"{Path(found.file).name}:{found.line}",
    }


def _texts(field: Field, words: Words) -> tuple[str, str]:
    """Return the name of a field and its help: by its own key, else by the table that it is in.

    Settings, which definitions name themselves, bring what their definition says of them.
    """

    def of(part: str) -> str:
        keys = (field.key, field.key.rpartition(".")[0])
        return next((text for key in keys if (text := said_in(words.language, "builder", "fields", key, part))), "")

    notes: list[str] = said([field.note, field.allowed], words)
    return of("name") or str(field.path[-1]), of("help") or " — ".join(filter(None, notes))


def _problem(problem: Problem, draft: Draft, words: Words) -> dict[str, Any]:
    own = problem.file == str(draft.path)
    path = () if draft.root is None else named_path(draft.root, problem.key)
    place = "" if own else f"{Path(problem.file).name}:{problem.line}"
    return {
        "text": problem_text(problem, words),
        "code": problem.code,
        "line": problem.line if own else 0,
        "place": place,
        "path": to_data(path),
    }


def _mark(root: LocatedValue, words: Words, key: str, line: int, text: str) -> dict[str, Any]:
    mark, _, what = text.partition(":")
    asked = phrase("to_enter" if mark == "enter" else "to_measure", what=what.strip()).text("what", words)
    return {"line": line, "path": to_data(named_path(root, key)), "text": asked}


def _base(draft: Draft) -> LocatedValue | None:
    """Return what the definition extends, merged, without anything of its own.

    Settings are those of the control that it names itself, if it does; the name of the control is that of the machine.
    """
    own = _own(draft)
    control = own.get("control")
    machine_name, control_name = own.get("extends"), control.get("extends") if isinstance(control, dict) else None
    below = _extending("", machine_name, draft.path)
    if not isinstance(control_name, str):
        return below
    root = _extending(f"[control]\nextends = {written(control_name)}\n", machine_name, draft.path)
    merged = None if root is None else value_at(root, ("control",))
    if merged is not None and isinstance(merged.value, dict):
        merged.value.pop("extends", None)
        named = None if below is None else value_at(below, ("control", "extends"))
        if named is not None:
            merged.value["extends"] = named
    return root


def _extending(text: str, name: object, path: Path) -> LocatedValue | None:
    """Return a merged definition with a text of its own that extends another; None: nothing, or it cannot be read."""
    text = (f"extends = {written(name)}\n" if isinstance(name, str) else "") + text
    with suppress(InputError):
        return with_control(load_draft(text, path, machine_library())) if text else None
    return None


def _own(draft: Draft) -> dict[str, Any]:
    try:
        return tomllib.loads(draft.text)
    except ValueError:
        return {}


def _notes(root: LocatedValue) -> SettingNotes:
    """Return what the settings of the control mean; nothing while it has mistakes."""
    with suppress(InputError):
        control = value_at(root, ("control",))
        assert control is not None
        assert isinstance(control.value, dict)
        merged = {key: value for key, value in control.value.items() if key != "extends"}
        found = describe_settings(load_control(Table(LocatedValue(merged, control.file, control.line), "control")))
        return SettingNotes({one.name: one.meant for one in found}, {one.name: one.allowed_said for one in found})
    return SettingNotes()


def _axes(root: LocatedValue | None) -> list[str]:
    """Names of the axes in their order."""
    found = None if root is None else value_at(root, ("axis",))
    items = [] if found is None else tables_of(found.value)
    return [str(name.value) for item in items if (name := value_at(item, ("name",))) is not None]


def _machine(machine: Machine | None, words: Words) -> dict[str, Any]:
    if machine is None:
        return {"machine": None, "bodies": [], "jogs": [], "remark": ""}
    remark = ""
    bodies: list[dict[str, Any]] = []
    try:
        for body in machine_bodies(machine):
            mesh = body.mesh
            shape = {"vertices": mesh.vertices.round(3).ravel().tolist(), "faces": mesh.faces.ravel().tolist()}
            bodies.append(body_scene(body, machine) | shape)
    except InputError as error:
        remark = "\n".join(problem.line_of_text(words) for problem in error.problems)
    if sum(len(body["faces"]) for body in bodies) > 3 * _MOST_TRIANGLES:
        bodies, remark = [], phrase("bodies_not_drawn", most=_MOST_TRIANGLES).text("what", words)
    jogs = jog_table(machine)
    told = [{"axis": each.axis.name, "what": joined((each.tool_said, each.iron_said), words)} for each in jogs.axes]
    homes = [axis.home for axis in machine.own_axes]
    return {"machine": {**machine_scene(machine), "homes": homes}, "bodies": bodies, "jogs": told, "remark": remark}


def _shown(found: LocatedValue, field: Field) -> object:
    """Return a value as its field takes it: what the field cannot hold, as the text has it."""
    value = _plain(found)
    if isinstance(value, list) and 0 < len(value) <= field.numbers and all(map(_is_exact, value)):
        return value
    return value if isinstance(value, str) or _is_exact(value) else written(value)


def _is_exact(value: object) -> bool:
    """Whether a value is a number that JSON and the page hold as it is."""
    return isinstance(value, int | float) and abs(value) < _BEYOND_PAGE


def _plain(found: LocatedValue) -> object:
    return Table(LocatedValue({"value": found}, found.file, found.line)).to_dict()["value"]


def _plain_text(value: object) -> str:
    return value if isinstance(value, str) else ""
