"""What ``--set`` may say besides what templates print: how to read, to place and to plan."""

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from trunnion.controls import Control
from trunnion.errors import InputError, Problem
from trunnion.files import OutputFiles
from trunnion.machines import Machine
from trunnion.model.motion import MachiningMode, PoleStrategy
from trunnion.output.subprograms import MIN_SUBPROGRAM_BYTES, SubprogramOutput
from trunnion.planning import Clearance, ClearanceSurface, PlanOptions

#: What the setting ``mode`` may say.
_MODES = {
    "auto": None,
    "three-axis": MachiningMode.THREE_AXIS,
    "tilted": MachiningMode.TILTED,
    "tcp": MachiningMode.TCP,
}

#: Settings that have but a few values, the usual one first.
_CHOICES = {
    "units": ("mm", "inch"),
    "numbers": ("on", "off"),
    "programs": ("one", "operations"),
    "tcp": ("on", "off"),
    "frame": ("first", "absolute"),
    "rewind": ("insert", "none"),
    "pole": tuple(PoleStrategy),
    "lower_feed": ("no", "yes"),
    "cycles": ("on", "off"),
}

#: Settings that are numbers: their limits, and what to write.
_NUMBERS = {
    "pole_angle": (1e-3, 10.0, "pole_angle=DEG, by how much the tool axis may lean near the pole, such as 0.1"),
    "tip_tolerance": (1e-4, 10.0, "tip_tolerance=MM, how far the tip may be off between points, such as 0.005"),
    "axis_tolerance": (1e-3, 10.0, "axis_tolerance=DEGREES, how far the tool axis may be off, such as 0.05"),
    "split": (
        MIN_SUBPROGRAM_BYTES,
        1e12,
        f"split=BYTES, the largest size of a subprogram, at least {MIN_SUBPROGRAM_BYTES}",
    ),
    "tool_length": (0.0, 1e4, "tool_length=MM, from the spindle's gauge point to the tip, such as tool_length=120.5"),
}

#: All settings of a run; the others are its control's.
RUN_SETTINGS = (*_CHOICES, *_NUMBERS, "mode", "zero", "clearance")


def check_settings(settings: Mapping[str, str], control: Control) -> None:
    """Raise ``InputError`` for settings that the control does not have, or that make no sense."""
    known = (*control.settings, *RUN_SETTINGS)
    problems = [
        Problem("--set", 0, f"{key} is no setting of {control.name}", f"write one of {', '.join(known)}")
        for key in settings
        if key not in known
    ]
    problems += [
        Problem("--set", 0, f"{key} has a line break or a control character in it", "write it in one line")
        for key, value in settings.items()
        if any(ord(character) < 32 for character in value)
    ]
    problems += [
        Problem("--set", 0, f"{key} is {settings[key]!r}", f"write {' or '.join(f'{key}={one}' for one in choices)}")
        for key, choices in {**_CHOICES, **control.family.SETTING_CHOICES}.items()
        if settings.get(key, choices[0]) not in choices
    ]
    problems += [
        Problem("--set", 0, f"{key} is {settings[key]!r}", cure)
        for key, cure in control.family.validate_settings(settings)
    ]
    if not settings.get("edge", "1").isdigit():
        problems.append(Problem("--set", 0, f"edge is {settings['edge']!r}", "write a whole number, such as edge=1"))
    if problems:
        raise InputError(problems)


def _parse_clearance(text: str) -> Clearance:
    """The setting ``clearance``."""
    kind, _, length = text.rpartition(":")
    try:
        surface, value = ClearanceSurface(kind or ClearanceSurface.DISTANCE), float(length)
    except ValueError:
        surface, value = ClearanceSurface.DISTANCE, math.nan
    least = -10000.0 if surface is ClearanceSurface.PLANE else 0.1
    if least <= value <= 10000.0:
        return Clearance(value, surface)
    cure = "write clearance=MM, how far the tool draws back for a rewind, such as clearance=50; or plane:Z, sphere:R"
    raise InputError(Problem("--set", 0, f"clearance is {text!r}", cure))


def _mode_setting(text: str, tcp: bool) -> tuple[MachiningMode | None, dict[str, MachiningMode | None]]:
    """The setting ``mode``: that of all operations, and those of some by their names, such as ``auto,SIDES:tcp``."""
    known = {word: mode for word, mode in _MODES.items() if tcp or mode is not MachiningMode.TCP}
    every, own = "auto", dict[str, MachiningMode | None]()
    for entry in text.split(","):
        name, _, word = entry.rpartition(":")
        if word not in known:
            what = "mode is tcp, and there is no TCP" if word == "tcp" else f"mode is {text!r}"
            cure = f"write one of {', '.join(known)}; OPERATION:WORD says it of one operation"
            raise InputError(Problem("--set", 0, what, cure))
        if name:
            own[name] = known[word]
        else:
            every = word
    return known[every], own


def number_setting(settings: Mapping[str, str], key: str) -> float | None:
    """A setting that is a number; None where nobody set it.

    Raises
    ------
    InputError
        If it is none, or beyond what makes sense.
    """
    text = settings.get(key)
    if text is None:
        return None
    low, high, cure = _NUMBERS[key]
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not low <= value <= high:
        raise InputError(Problem("--set", 0, f"{key} is {text!r}", f"write {cure}"))
    return value


def apply_setup(machine: Machine, settings: Mapping[str, str]) -> Machine:
    """The machine with its workpiece and its tool where the settings say so."""
    if "zero" in settings:
        machine = replace(machine, workpiece_zero=point_setting(settings["zero"]))
    length = number_setting(settings, "tool_length")
    return machine if length is None else replace(machine, tool_length=length)


def parse_plan_options(settings: Mapping[str, str], control: Control, explain: bool = False) -> PlanOptions:
    """What the settings, checked by ``check_settings``, say to the planner."""
    tcp = settings.get("tcp", "on" if control.tcp else "off") == "on"
    if tcp and not control.tcp:
        raise InputError(Problem("--set", 0, "tcp is on, and the machine's control has none", "write tcp=off"))
    mode, mode_by_operation = _mode_setting(settings.get("mode", "auto"), tcp)
    numbers = {key: number_setting(settings, key) for key in ("pole_angle", "tip_tolerance", "axis_tolerance")}
    known: dict[str, Any] = {key: value for key, value in numbers.items() if value is not None}
    if "clearance" in settings:
        known["clearance"] = _parse_clearance(settings["clearance"])
    return PlanOptions(
        allow_rewinds=settings.get("rewind", "insert") == "insert",
        explain=explain,
        mode=mode,
        mode_by_operation=mode_by_operation,
        pole_strategy=PoleStrategy(settings.get("pole", "off")),
        absolute_frame=settings.get("frame", "first") == "absolute",
        lower_feed=settings.get("lower_feed", "no") == "yes",
        tcp=tcp,
        holes_as_motion=settings.get("cycles", "on") == "off",
        **known,
    )


def program_division(
    settings: Mapping[str, str], control: Control, target: str, output_files: OutputFiles
) -> SubprogramOutput | None:
    """How the program of ``target`` is divided into files, which are made as ``output_files``; None: it is one file.

    Raises
    ------
    InputError
        If the control or the target cannot have several, or if the settings make no sense together.
    """
    size = number_setting(settings, "split")
    if settings.get("programs", "one") == "one":
        if size is not None:
            cure = "write programs=operations too"
            raise InputError(Problem("--set", 0, "split divides subprograms, and there are none", cure))
        return None
    if control.subprograms is None:
        what = f"programs is operations, and {control.name} has no words for subprograms here"
        raise InputError(Problem("--set", 0, what, "leave it out"))
    if target == "-":
        raise InputError(Problem("--output", 0, "stdout takes one file", "name a file or a folder, or programs=one"))
    return SubprogramOutput(Path(target).stem, output_files.add_file, None if size is None else int(size))


def point_setting(text: str) -> tuple[float, float, float]:
    """The setting ``zero``, mm."""
    try:
        x, y, z = (float(part) for part in text.split(","))
    except ValueError:
        raise InputError(
            Problem("--set", 0, f"zero is {text!r}", "write zero=X,Y,Z: the workpiece zero on the machine, mm")
        ) from None
    return x, y, z
