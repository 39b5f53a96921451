"""Which texts each language has, and which are behind the English ones.

``python -m tests.support.translations`` counts what is untranslated and stale; with a language it lists both, and with
``--taken`` as well it keeps the digests of the English texts that the translations have now been compared with.
"""

import json
import re
import sys
from collections import Counter
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from string import Formatter
from typing import Any, NamedTuple

from tests.support.locations import TESTS
from trunnion import messages
from trunnion.batch.worker_task import Status
from trunnion.explanations import SUBJECTS
from trunnion.jobs.capability.fitting import FitStatus
from trunnion.jobs.describe.controls import describe_controls
from trunnion.jobs.registry import GROUPS, JOBS
from trunnion.machines import load_machine, shipped_machines
from trunnion.machines.sensitivity import NumberKind
from trunnion.messages import DECLARED, ENGLISH, LANGUAGES, digest
from trunnion.model.motion import DecisionTopic, MachiningMode
from trunnion.simulation.finding import What
from trunnion.simulation.tools.profile import Role
from trunnion.survey.found_files import FileKind
from trunnion.survey.result import Became

FOLDER = Path(messages.__file__).parent
DATA = TESTS / "data" / "translated"

#: All languages but English.
TRANSLATED = tuple(language for language in LANGUAGES if language != ENGLISH)

#: Fields that are what a user may set: a translation has them letter for letter.
SETTABLE = {"setting", "argument", "switch"}


#: Words of the library that results print: kinds of operations and tools, and outcomes.
WORDS = (
    "three-axis", "3+2", "simultaneous", "empty", "tilted", "tcp",
    "bed", *FitStatus, *What, "rubs", "stock", "part", "fixture", "hub", *Role,
    "Rotary speeds", "Tip feed", "tip", "programmed", "linear axes at rapid", "limits not stated", "endless", "limits",
    "from above", "from below, from the other side", *DecisionTopic,
    *MachiningMode, "ROUGH", "SEMI", "FINISH", "on", "flood", "mist", "through the tool", "air", "for tapping",
    "ball mill", "mill", "T-cutter", "barrel cutter", "drill", "clockwise", "counterclockwise", "standing",
    "contour", "tool's centre", "diameter", "radius", *FileKind, *Became, *NumberKind, "APT CL data (ISO 4343)",
    "CAMWorks CL data", "Autodesk Fusion or HSMWorks APT",
    "of rapid speed", "Spindle", "spindle", "fastest", "writing", "placing", "turns", "tool paths", "steps", "tilts",
    *Status, "fit", "machines", "sensitivity", "motions", "states of the stock", "states", "survey", "files", "cutting",
    "blocks", "batch", "tasks", "prepare", "kernels", "points", "of acceleration", "tool axes", "places",
    "field of tool axes", "rounds", "layers", "links", "passes", "fit of a flank",
)  # fmt: skip


class Key(NamedTuple):
    """A text: its file without ``.toml``, which is its room, and where it stands there."""

    room: str
    path: str


def _flat(table: Mapping[str, Any], path: tuple[str, ...] = ()) -> Iterator[tuple[str, str]]:
    for name, value in table.items():
        if isinstance(value, str):
            yield ".".join((*path, name)), value
        else:
            yield from _flat(value, (*path, name))


def rooms(language: str = ENGLISH) -> list[str]:
    """The files of a language."""
    folder = FOLDER / language
    return sorted(file.relative_to(folder).with_suffix("").as_posix() for file in folder.rglob("*.toml"))


def _of_files(language: str) -> dict[Key, str]:
    return {
        Key(room, path): text
        for room in rooms(language)
        for path, text in _flat(messages.catalogue(language, room))
    }  # fmt: skip


def _of_declarations() -> Iterator[tuple[str, str]]:
    """English texts of ``--help`` and of explanations that stand where they are declared."""
    for title in GROUPS:
        yield f"groups.{title}", title
    for subject, title in SUBJECTS.items():
        yield f"subjects.{subject}", title
    helps: dict[str, set[str]] = {}
    for job in JOBS.values():
        yield f"command.{job.name}.title", job.title
        for number, (_, what) in enumerate(job.examples, 1):
            yield f"command.{job.name}.example_{number}", what
        for option in job.options:
            helps.setdefault(option.name, set()).add(option.help)
            if option.heading:
                yield f"headings.{option.heading}", option.heading
    for job in JOBS.values():
        for option in job.options:
            alone = len(helps[option.name]) == 1
            yield (f"options.{option.name}" if alone else f"command.{job.name}.options.{option.name}"), option.help


def _of_definitions() -> Iterator[tuple[str, str]]:
    """English texts that stand where they are declared: what settings mean and are, what machines and controls are."""
    controls = describe_controls()
    for setting in (setting for control in controls for setting in (*control.settings, *control.run_settings)):
        for wording in (setting.meant, setting.default_said, setting.allowed_said):
            subject = wording.parameter("declared")
            if isinstance(subject, tuple) and (subject[0] != "defaults" or " " in wording.what):
                yield ".".join((*subject, digest(wording.what))), wording.what
    descriptions = [control.description for control in controls]
    for description in (*descriptions, *(load_machine(key).description for key in shipped_machines())):
        if description:
            yield f"descriptions.{digest(description)}", description
    bodies = (body.name for key in shipped_machines() for body in load_machine(key).bodies)
    for word in dict.fromkeys((*WORDS, *bodies)):
        yield f"words.{digest(word)}", word


@cache
def english() -> dict[Key, str]:
    """Every text in English."""
    helps = {Key("help", path): text for path, text in _of_declarations()}
    return _of_files(ENGLISH) | helps | {Key(DECLARED, path): text for path, text in _of_definitions()}


@cache
def translated(language: str) -> dict[Key, str]:
    """Every text of a language."""
    return _of_files(language)


def taken(language: str) -> dict[Key, str]:
    """The digests of the English texts that translations were made of."""
    file = DATA / f"{language}.json"
    kept = json.loads(file.read_text(encoding="utf-8")) if file.is_file() else {}
    return {Key(room, path): found for room, digests in kept.items() for path, found in digests.items()}


def completed() -> dict[str, list[str]]:
    """The rooms of each language in which nothing is missing or stale."""
    found: dict[str, list[str]] = json.loads((DATA / "completed.json").read_text(encoding="utf-8"))
    return found


def missing(language: str) -> list[Key]:
    """Texts without a translation."""
    return [key for key in english() if key not in translated(language)]


def stale(language: str) -> list[Key]:
    """Translations of a text that has changed, or is gone."""
    known = taken(language)
    return [
        key
        for key in translated(language)
        if key not in english() or known.get(key) != digest(english()[key])
    ]  # fmt: skip


def fields(template: str) -> set[tuple[str, str]]:
    """The parameters of a template, with what a translation may not change of them.

    How a number is counted and what stands between names may change; what counts without being printed may go.
    """
    found = set()
    for _, name, spec, _ in Formatter().parse(template):
        if name is None or (spec and "|" in spec and "#" not in spec):
            continue
        fixed = name in SETTABLE or re.fullmatch(r"[-+<>=^,0-9.]*[a-z]?|cure", spec or "")
        found.add((name, spec or "" if fixed else ""))
        if spec and "{" in spec:
            found |= fields(spec)
    return found


def is_filled_in(key: Key) -> bool:
    """Whether a text has parameters: explanations and what is declared have none, and may have braces."""
    return (
        not key.room.startswith("explanations/")
        and key.room != DECLARED
        and (key.room != "help" or key.path.startswith("words."))
    )


def wrong_fields(language: str) -> list[str]:
    """Translations, made of the English text as it is, whose parameters are not those of it."""
    behind = set(stale(language))
    wrong = []
    for key, text in translated(language).items():
        if key in behind or not is_filled_in(key):
            continue
        try:
            if fields(text) != fields(english()[key]):
                wrong.append(f"{key.room} {key.path}: {sorted(fields(text) ^ fields(english()[key]))}")
        except ValueError as error:
            wrong.append(f"{key.room} {key.path}: {error}")
    return wrong


def take(language: str) -> None:
    """Keep the digests of the English texts of all translations that there are."""
    kept: dict[str, dict[str, str]] = {}
    for key in sorted(key for key in translated(language) if key in english()):
        kept.setdefault(key.room, {})[key.path] = digest(english()[key])
    DATA.mkdir(exist_ok=True)
    (DATA / f"{language}.json").write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")


def main(words: list[str]) -> None:
    """Count, list or take over."""
    if "--taken" in words:
        for language in words[:1]:
            take(language)
    for language in words[:1] or TRANSLATED:
        lacking, behind = missing(language), stale(language)
        print(f"{language}: {len(english())} texts, {len(lacking)} untranslated, {len(behind)} stale")
        for room, count in sorted(Counter(key.room for key in lacking).items()):
            print(f"  {room}: {count} untranslated")
        if words:
            for line in (
                *(f"untranslated: {key.room} {key.path}: {english()[key]}" for key in lacking),
                *(f"stale: {key.room} {key.path}" for key in behind),
                *(f"parameters: {line}" for line in wrong_fields(language)),
            ):
                print(line)


if __name__ == "__main__":
    main(sys.argv[1:])
