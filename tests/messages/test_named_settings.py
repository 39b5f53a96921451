"""Every setting, argument and option that a cure names exists, and takes the value that it names."""

import re
from collections.abc import Iterator
from functools import cache
from typing import Final

import pytest

from trunnion.controls.vocabulary import PROGRAM_CHOICES
from trunnion.errors import InputError
from trunnion.explanations import explanations
from trunnion.jobs.arguments import VerifyArguments
from trunnion.jobs.inputs.run_settings import RUN_SETTINGS
from trunnion.jobs.post.post_job import prepare
from trunnion.jobs.registry import JOBS
from trunnion.machines import load_machine
from trunnion.messages import CATALOGUES, CHECKS, catalogue
from trunnion.options.kinds import WrongValueError
from trunnion.options.option import Option

#: One machine of each control.
MACHINES: Final = ("yl569", "dmu65", "mikron_600u", "matsuura_mx330", "haas_umc750", "hs664rt", "xyzac_trt")

#: What stands for a value in a cure, and such a value.
SAMPLES: Final = {
    "MM": "5", "DEGREES": "0.05", "X,Y,Z": "1,2,3", "OPERATION:NUMBER": "OP1:7", "OPERATION:tilted": "OP1:tilted",
    "NUMBER": "4843", "ADDRESS": "tls://one:8786", "FILE or FOLDER": "part.mpf",
    "G54=X,Y,Z,G55=X,Y,Z": "G54=1,2,3,G55=4,5,6",
}  # fmt: skip

#: Settings of which a cure names the values elsewhere: one of each.
ANY_VALUE: Final = {
    "work_offset": ("G55", "7"), "mode": ("tilted",), "units": ("mm",), "title": ("PART",), "max_tilt": ("30",),
    "tool_length": ("100",),
}  # fmt: skip

#: Settings that a message has filled in for each operation.
OF_OPERATIONS: Final = {"tool": "A:1,B:2", "spindle": "A:100,B:200"}

#: Words behind "setting" and "=" of other things: keys of definitions, results of hooks, values of tools.
NO_SETTINGS: Final = {
    "and", "another", "differs", "for", "in", "of", "or", "out", "that", "to", "limits_mm", "output", "namespace",
    "number", "row", "moves", "length", "flutes", "shank", "holder",
}  # fmt: skip

#: Arguments of ``trunnion.verify`` that the command does not have.
LIBRARY_ALONE: Final = {"columns"}

#: Options of other programs.
OF_OTHERS: Final = {"--nthreads"}


def cures() -> Iterator[tuple[str, str]]:
    """Code and text of each cure, of messages and of explanations."""
    for name in (*CATALOGUES.values(), CHECKS):
        for code, variants in catalogue("en", name).items():
            yield from ((f"{code} {variant}", parts["cure"]) for variant, parts in variants.items() if "cure" in parts)
    yield from ((each.code, each.cure) for each in explanations().values())


def named(kind: str) -> list[tuple[str, str, str]]:
    """Message, name and value of what cures name as a setting, an argument or a switch."""
    found = []
    for message, text in cures():
        for name, _, value in (
            each.partition("=") for each in re.findall(rf"\{{{kind}:((?:[^{{}}]|\{{[^}}]*\}})*)\}}", text)
        ):
            if not name.startswith("{"):
                found.append((message, name, value))
    return found


@cache
def options() -> dict[str, list[Option]]:
    """The options of all commands, by the argument that they are."""
    found: dict[str, list[Option]] = {}
    for job in JOBS.values():
        for option in job.options:
            found.setdefault(option.name, []).append(option)
    return found


def is_filled_in(value: str) -> bool:
    """Whether a part of a value is only known where the message is said."""
    return "{" in value


def takes(machine: str, setting: str, value: str) -> bool:
    """Whether a post for a machine takes a setting; others that it needs come with it."""
    beside = {"clearance": {}, "first_number": {"programs": "operations"}}.get(setting, {})
    try:
        prepare(load_machine(machine), {**beside, setting: value})
    except InputError as error:
        return not any(each.setting in (setting, "") for each in error.problems)
    return True


def test_settings_take_the_values_that_cures_name() -> None:
    wrong = []
    for message, name, value in sorted(set(named("setting"))):
        values = ANY_VALUE.get(name, ()) if value == "…" or is_filled_in(value) else (SAMPLES.get(value, value),)
        if is_filled_in(value) and name in OF_OPERATIONS:
            values = (OF_OPERATIONS[name],)
        if is_filled_in(value) and not values:
            values = tuple(RUN_SETTINGS[name].choices or [RUN_SETTINGS[name].example]) if name in RUN_SETTINGS else ()
        if not any(takes(machine, name, each) for machine in MACHINES for each in values):
            wrong.append(f"{message}: {name}={value}")
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("kind", ["argument", "switch"])
def test_commands_have_the_arguments_that_cures_name(kind: str) -> None:
    wrong = []
    for message, name, value in named(kind):
        of_name = options().get(name, [])
        if not of_name and name in LIBRARY_ALONE:
            assert name in VerifyArguments.__annotations__
        elif not of_name:
            wrong.append(f"{message}: no command has {name}")
        elif value and not is_filled_in(value):
            try:
                of_name[0].kind.parse(SAMPLES.get(value, value))
            except WrongValueError as error:
                wrong.append(f"{message}: {name}={value}: {error}")
    assert not wrong, "\n".join(wrong)


def test_settings_and_options_in_sentences_exist() -> None:
    settings = {*RUN_SETTINGS, *PROGRAM_CHOICES}
    settings |= {key for machine in MACHINES for key in prepare(load_machine(machine)).control.settings}
    settings |= {option.setting for each in options().values() for option in each if option.setting}
    flags = {flag for each in options().values() for option in each for flag in (option.flag, *option.aliases)}
    wrong = []
    for message, text in cures():
        bare = re.sub(r"\{(?:[^{}]|\{[^}]*\})*\}", "", text)
        words = re.findall(r"\bsettings? `?([a-z_]+)\b(?!:)", bare) + re.findall(r"(?:^|[ (`])([a-z_]+)=[\w…]", bare)
        names = settings | NO_SETTINGS | set(options())
        wrong += [f"{message}: there is no setting {word}: {text}" for word in words if word not in names]
        wrong += [
            f"{message}: no command has {flag}: {text}"
            for flag in re.findall(r"--[a-z][a-z-]*", bare)
            if flag not in flags | OF_OTHERS | {"--help", "--version"}
        ]
    assert not wrong, "\n".join(wrong)
