"""The templates of a control's definition: which it must have, and what they are."""

from dataclasses import replace
from typing import Final

from trunnion.controls.family_writer import FamilyWriter
from trunnion.controls.places import EVENT_PLACE, OWN_TEMPLATES
from trunnion.controls.template import Template
from trunnion.controls.vocabulary import (
    AGAIN,
    DRAW_BACK,
    FIVE_AXIS,
    FOLLOWING,
    LEAVING,
    M114,
    NEW_SPEED_WITH_M114,
    NEW_SPEED_WITH_TCP,
    REQUIRED_TEMPLATES,
    SPINDLE_ON,
    SUBPROGRAM_TEMPLATES,
    THREE_AXIS,
    WITHOUT_TCP,
)
from trunnion.definitions import Table
from trunnion.errors import Problem, key_subject
from trunnion.messages import Wording

#: What only a template with statements or expressions has in it.
_TEXT_SIGNS: Final = ("{%", "{{", "{#")

#: Suffixes of the templates for operations whose tool axis changes.
_SIMULTANEOUS: Final = (FIVE_AXIS, WITHOUT_TCP, M114)

#: Parts of the templates of a plane command that it may share with another.
_SHARED_PLANE_PARTS: Final = ("approach", "next_plane", "operation_end")


def read_templates(
    table: Table, family: FamilyWriter, plane_from_pose: bool, *, subprograms: bool
) -> dict[str, Template]:
    """Return the templates of a definition by their names; what it must have depends on what it can do."""
    found = {}
    for name in _template_names(table, family, plane_from_pose, subprograms):
        text = table.lines(name)
        file, line = table.text_location(name)
        step = 0 if table.is_in_one_line(name) else 1
        if any(sign in text for sign in _TEXT_SIGNS):
            found[name] = _read_text_template(table, name, text, step)
        else:
            line += bool(line) * step * (len(text) - len(text.lstrip("\n")))
            lines = tuple(text.strip("\n").split("\n")) if text.strip() else ()
            found[name] = Template(name, lines, file, line, step=step)
    for command, other in family.PLANE_TEMPLATES_OF.items():
        shared = (f"{part}_" for part in (*_SHARED_PLANE_PARTS, LEAVING)) if f"plane_on_{command}" in found else ()
        for part in shared:
            if f"{part}{other}" in found:
                found.setdefault(f"{part}{command}", found[f"{part}{other}"])
    table.mark_read(*OWN_TEMPLATES)
    table.report_unread_keys()
    return found


def _template_names(table: Table, family: FamilyWriter, plane_from_pose: bool, subprograms: bool) -> list[str]:
    """Return the names of the templates that a definition must have.

    Those of TCP, of operations without it and of each plane command are needed only if one of them is there. The
    template that leads from home to the next tool axis of an operation with holes is optional, and so are those of an
    operation with the tool of the one before, and the one that retracts the tool where a tilted plane is taken from the
    rotary position: without it the tool always goes home.
    """
    plane_parts = ("plane_on", *_SHARED_PLANE_PARTS)
    groups: list[tuple[str, ...]] = [(SPINDLE_ON,), (NEW_SPEED_WITH_TCP,)]
    groups += [tuple(f"{part}_{suffix}" for part in ("approach", "operation_end")) for suffix in _SIMULTANEOUS]
    groups += [(NEW_SPEED_WITH_M114,), (FOLLOWING,), (AGAIN,)]
    groups += [(f"{LEAVING}_{suffix}",) for suffix in (THREE_AXIS, *_SIMULTANEOUS, *family.PLANE_COMMANDS)]
    groups += [(f"next_axis_{suffix}",) for suffix in _SIMULTANEOUS]
    groups += [
        tuple(f"{part}_{plane}" for part in plane_parts)
        for plane in family.PLANE_COMMANDS
        if plane not in family.PLANE_TEMPLATES_OF
    ]
    groups += [(f"{part}_{plane}",) for plane in family.PLANE_TEMPLATES_OF for part in plane_parts]
    groups += [(f"{DRAW_BACK}_{plane}",) for plane in family.PLANE_COMMANDS if plane_from_pose]
    for name in (name for group in groups for name in group):
        table.lines(name, None)  # known, though no definition needs it
    used = [name for group in groups if any(name in table for name in group) for name in group]
    places = [name for name in list(table.keys()) if name in OWN_TEMPLATES or name.startswith(EVENT_PLACE)]
    return [*REQUIRED_TEMPLATES, *(SUBPROGRAM_TEMPLATES if subprograms else ()), *used, *places]


def _read_text_template(table: Table, name: str, text: str, step: int) -> Template:
    """Return a template with statements or expressions; Jinja is imported for the first one."""
    from trunnion.controls.texts.template import text_template

    template, fault = text_template(name, text, *table.text_location(name))
    template = replace(template, step=step)
    if fault is not None:
        file, line = template.place_of(max(fault.line, 1) - 1)
        key = table.key_path(name)
        wording = Wording("DEF570", "cannot_be_read", fault=fault.wording).of_key(key)
        table.problems.append(Problem(file, line, wording, subject=key_subject(key)))
    return template
