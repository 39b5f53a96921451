"""What the definition of a control means, as records: what it can do, its words, its texts and its settings."""

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Annotated, Final

from trunnion.controls import Control, load_control, shipped_controls
from trunnion.controls.definition_files import is_control_file, load_control_table
from trunnion.controls.places import TEMPLATE_ORDER
from trunnion.controls.setting_rules import SettingKind
from trunnion.controls.vocabulary import (
    PROGRAM_MEANINGS,
    SUBPROGRAM_TEMPLATES,
    SURFACE_NORMAL_WORDS,
    TOOL_VECTOR_WORDS,
    UNKNOWN_FEED,
)
from trunnion.errors import InputError, Problem
from trunnion.families import FAMILIES, load_reader
from trunnion.jobs.describe.template_motions import motions_in_branches
from trunnion.jobs.inputs.arguments import check_path
from trunnion.jobs.inputs.reading import FilePath, load_machine
from trunnion.jobs.inputs.run_settings import RUN_SETTINGS
from trunnion.messages import Wording, declared, foreign, phrase
from trunnion.model.motion import MachiningMode
from trunnion.model.toolpath import Sense
from trunnion.planning.holes.cycles import Cycle, HoleCycleError, HoleMethod, SpindleState, UnsupportedCycleError
from trunnion.records import dataclass
from trunnion.results import Figure

#: What F counts without TCP while rotary axes turn.
_FEEDS: Final = {
    "inverse_time": phrase("feed_is_inverse_time"),
    "all_axes": phrase("feed_is_of_all_axes"),
    "slides": phrase("feed_is_of_linear_axes"),
}

#: What becomes of a hole, by what a control has for it.
_CYCLES: Final = ("ability_cycles", "ability_holes_as_motion", "ability_cycles_refused")

#: A value that no setting with a form of its own can have: what is said of it tells the form.
_IMPOSSIBLE: Final = "?"


@dataclass(frozen=True, slots=True)
class SettingDescription:
    """A setting, for people.

    name           as it is written
    meant          what it changes, in sentences; empty if its definition does not say it
    default_said   what holds where it is not given
    allowed_said   what it may be, in words
    by_operation   operations of one program can have different values

    ``meaning``, ``default`` and ``allowed`` are these in English.
    """

    name: str
    meant: Annotated[Wording, Figure("meaning", take=str)]
    default_said: Annotated[Wording, Figure("default", take=str)]
    allowed_said: Annotated[Wording, Figure("allowed", take=str)]
    by_operation: bool = False

    @property
    def meaning(self) -> str:
        """What it changes, in sentences."""
        return str(self.meant)

    @property
    def default(self) -> str:
        """What holds where it is not given."""
        return str(self.default_said)

    @property
    def allowed(self) -> str:
        """What it may be, in words."""
        return str(self.allowed_said)


@dataclass(frozen=True, slots=True)
class WordDescription:
    """A word of motion blocks.

    name      its key in the definition
    letter    what is printed before the number; for rotary axes, what follows their name
    decimals  most digits after the point in five-axis and three-axis operations; None: it has no number
    modal     left out of a block while it would print the same
    """

    name: str
    letter: str
    decimals: tuple[int, int] | None
    modal: bool


@dataclass(frozen=True, slots=True)
class TemplateDescription:
    """A text of a program: its name and its lines, with ``{field}`` where a value is printed."""

    name: str
    lines: tuple[str, ...]


def _sentences(said: Iterable[Wording]) -> tuple[str, ...]:
    return tuple(map(str, said))


@dataclass(frozen=True, slots=True)
class ControlDescription:
    """What a control's definition means.

    key           name of the shipped definition, or the file
    name          of the control
    family        whose writer and reader it has
    description   a sentence about it; may be empty
    extension     of its program files
    able          what it can do, and what it cannot; ``abilities`` are the sentences
    words         of motion blocks, in their order
    texts         templates in the order in which a program has them
    settings      its own
    run_settings  those that every control has
    remarks       warnings of what the proof of a program may not see
    """

    key: str
    name: str
    family: str
    description: str
    extension: str
    able: Annotated[tuple[Wording, ...], Figure("abilities", take=_sentences)]
    words: tuple[WordDescription, ...]
    texts: tuple[TemplateDescription, ...]
    settings: tuple[SettingDescription, ...]
    run_settings: tuple[SettingDescription, ...]
    remarks: tuple[Problem, ...] = ()

    @property
    def abilities(self) -> tuple[str, ...]:
        """What it can do, and what it cannot, in sentences."""
        return _sentences(self.able)


def describe_control(control: FilePath) -> ControlDescription:
    """Describe what the definition of a control means.

    Parameters
    ----------
    control
        The name of a shipped control, such as ``"sinumerik_840d"``; that of a shipped machine, whose control is meant;
        or the path of a ``.toml`` file that defines a control or a machine.

    Returns
    -------
    ControlDescription
        What it can do, its words, its texts, and every setting with default, allowed values and meaning.

    Raises
    ------
    InputError
        With every mistake of the definition, each at its file and line.

    Examples
    --------
    >>> import trunnion
    >>> control = trunnion.describe_control("sinumerik_840d")
    >>> next(setting.default for setting in control.settings if setting.name == "work_offset")
    'G54'
    """
    name = str(check_path("control", control))
    return _describe(name, load_any_control(name))


def describe_controls() -> tuple[ControlDescription, ...]:
    """Describe every shipped control.

    Returns
    -------
    tuple of ControlDescription
        In the order of their names.

    Raises
    ------
    InputError
        If a shipped definition has been damaged.

    Examples
    --------
    >>> import trunnion
    >>> [control.key for control in trunnion.describe_controls()][:2]
    ['fanuc_31i', 'fanuc_31i_basic']
    """
    return tuple(describe_control(key) for key in shipped_controls())


def main_texts(control: Control) -> tuple[TemplateDescription, ...]:
    """Return the texts that a program with one tool has in any machining mode, by the control's own settings."""
    suffixes = {control.template_suffix(mode, {}) for mode in MachiningMode} - {""}
    starts = ("approach", "plane_on", "next_plane", "operation_end")
    wanted = {f"{start}_{suffix}" for start in starts for suffix in suffixes}
    wanted |= {"program_start", "operation_start", "tool_change", "spindle_on", "program_end"}
    names = sorted((name for name in control.templates if name in wanted), key=_template_rank)
    return tuple(TemplateDescription(name, control.templates[name].lines) for name in names)


def load_any_control(name: str) -> Control:
    """Return the control of a shipped control or machine, or of a file that defines one of them.

    Raises ``InputError`` with every mistake of the definition.
    """
    is_file = name.endswith(".toml")
    if not is_file and name not in shipped_controls():
        try:
            return load_control(load_machine(name).control)
        except InputError:
            return load_control(load_control_table(name))  # names the controls that there are
    if is_file and not is_control_file(Path(name)):
        return load_control(load_machine(name).control)
    return load_control(load_control_table(name))


def _describe(key: str, control: Control) -> ControlDescription:
    words = tuple(
        WordDescription(
            word.name,
            word.letter + word.closing,
            None if word.bare else _decimals(control, word.format),
            word.modal,
        )
        for word in control.words
    )
    names = sorted(control.templates, key=_template_rank)
    return ControlDescription(
        key=key,
        name=control.name,
        family=control.family_name,
        description=control.description,
        extension=control.extension,
        able=tuple(_abilities(control)),
        words=words,
        texts=tuple(TemplateDescription(name, control.templates[name].lines) for name in names),
        settings=describe_settings(control),
        run_settings=tuple(setting for setting in run_settings() if setting.name not in control.settings),
        remarks=tuple(motions_in_branches(control)),
    )


def describe_settings(control: Control) -> tuple[SettingDescription, ...]:
    """Return the settings of a control that have an effect."""
    return tuple(_control_setting(control, name) for name in control.settings if control.has_effect(name))


def run_settings() -> tuple[SettingDescription, ...]:
    """Return the settings that every control has."""
    return tuple(
        SettingDescription(
            key,
            declared(setting.meaning, "meanings", key),
            _stated(setting.default, key),
            setting.allowed,
            key == "mode",
        )
        for key, setting in RUN_SETTINGS.items()
    )


def _decimals(control: Control, number_format: str) -> tuple[int, int]:
    pair = control.formats[number_format]
    return pair.five_axis.decimals, pair.three_axis.decimals


def _template_rank(name: str) -> int:
    return next((rank for rank, start in enumerate(TEMPLATE_ORDER) if name.startswith(start)), len(TEMPLATE_ORDER))


def _control_setting(control: Control, name: str) -> SettingDescription:
    rule = control.setting_rule(name)
    of_family = dict(control.family.validate_settings({**control.settings, name: _IMPOSSIBLE}))
    allowed = of_family.get(name, rule.allowed()).bare()
    if name == "work_offset" and FAMILIES[control.family_name].reader:
        allowed = load_reader(control.family_name).work_offsets.form_said
    elif rule.kind is SettingKind.TOOL and control.allowed_instead(name, "NAME") is None:
        allowed = phrase("number_or_name_of_tool")
    stated = control.settings[name]
    default = foreign(stated) if stated else _method_default(control, name)
    return SettingDescription(
        name,
        declared(control.setting_meanings.get(name) or PROGRAM_MEANINGS.get(name, ""), "meanings", name),
        default,
        allowed,
        control.differs_by_operation(name),
    )


def _stated(default: str, name: str) -> Wording:
    """Return a default: a value, or words."""
    return phrase("no_default") if default == "none" else declared(default, "defaults", name)


def _method_default(control: Control, name: str) -> Wording:
    rules = control.method_defaults.get(name, ())
    told = tuple(
        phrase("default_for_method", value=value, method=part) if part else phrase("default_else", value=value)
        for part, value in rules
    )
    return phrase("default_by_method", rules=told) if told else phrase("no_default")


def _abilities(control: Control) -> Iterator[Wording]:
    """Yield what a control can do with its own settings, and what it cannot, in sentences."""
    modes = control.modes({})
    planes = tuple(
        name.replace("_", ".") for name in control.family.PLANE_COMMANDS if f"approach_{name}" in control.templates
    )
    feed = _FEEDS.get(control.feed_without_tcp, "")
    without = (
        phrase("feed_not_known")
        if control.feed_without_tcp == UNKNOWN_FEED
        else phrase("yes_with_feed", feed=feed)
        if MachiningMode.WITHOUT_TCP in modes
        else _yes(answer=False)
    )
    arcs = control.arcs
    word_names = {word.name for word in control.words}
    yield phrase("ability_three_axis", answer=_yes(MachiningMode.THREE_AXIS in modes))
    tilted = phrase("these_words", words=planes) if planes else _yes(MachiningMode.TILTED in modes)
    yield phrase("ability_tilted", answer=tilted)
    yield phrase("ability_tcp", answer=_yes(MachiningMode.TCP in modes))
    if MachiningMode.M114 in modes:
        yield phrase("ability_m114", answer=_yes(answer=True))
    yield phrase("ability_without_tcp", answer=without)
    yield phrase("ability_tool_vector", answer=_yes(set(TOOL_VECTOR_WORDS) <= word_names))
    yield phrase("ability_normals", answer=_yes(set(SURFACE_NORMAL_WORDS) <= word_names))
    yield phrase(
        "ability_circles",
        about=phrase("circles_about_z" if arcs.only_about_z else "circles_about_all"),
        by=phrase("circles_by_radius" if arcs.by_radius else "circles_by_centre"),
        helices=_yes(arcs.helices),
        turns=_yes(arcs.multi_turn),
    )
    yield from _cycles(control)
    coolant = tuple(word for word in control.coolant if word != "OFF")
    yield phrase("ability_coolant", words=phrase("these_words", words=coolant) if coolant else phrase("no_default"))
    yield phrase("ability_subprograms", answer=_yes(all(name in control.templates for name in SUBPROGRAM_TEMPLATES)))


def _yes(answer: bool) -> Wording:
    return phrase("answer_yes" if answer else "answer_no")


def _cycles(control: Control) -> Iterator[Wording]:
    """Yield the hole-making cycles that a control has words for, those that become motion, and those that are
    refused.
    """
    outcomes = {method: _outcome(control, method) for method in HoleMethod}
    for kind in dict.fromkeys(kind for kind, _ in outcomes.values()):
        found = tuple(
            phrase("cycle_because", method=str(method), why=why) if why else foreign(f"CYCLE/{method}")
            for method, (each, why) in outcomes.items()
            if each == kind
        )
        yield phrase(kind, cycles=found)


def _outcome(control: Control, method: HoleMethod) -> tuple[str, Wording | None]:
    """Return what becomes of a hole with the control's own settings, and why."""
    hole = Cycle(method, 2.0, 20.0, 10.0, (5.0, 0.0, 0.0), 0.0, False, 1.0, True, 0.0)
    spindle, formats = SpindleState(1000.0, Sense.CLW), control.number_formats(three_axis=True)
    made, as_motion, refused = _CYCLES
    try:
        control.family.cycle_call(hole, 0.0, spindle, control.settings, formats)
    except UnsupportedCycleError as error:
        return as_motion, error.wording
    except HoleCycleError as error:
        return refused, error.wording.with_cure()
    return made, None
