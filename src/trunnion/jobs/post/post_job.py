"""A post before its first CL file is read: machine, control and options, made of its settings."""

import math
import os
import re
from collections.abc import Mapping
from dataclasses import field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Self

from trunnion.controls import Control, load_control
from trunnion.controls.inches import in_units
from trunnion.controls.setting_rules import SettingRule
from trunnion.controls.vocabulary import MM, PROGRAM_CHOICES
from trunnion.errors import InputError, argument_problem, setting_problem
from trunnion.files import OutputFiles
from trunnion.jobs.inputs.run_settings import RUN_SETTINGS
from trunnion.jobs.inputs.settings import (
    Settings,
    as_texts,
    check_settings,
    number_setting,
    split_by_operation,
    with_limit_margin,
)
from trunnion.jobs.inputs.stated_cycles import stated_cycles
from trunnion.jobs.inputs.stated_setup import apply_setup
from trunnion.jobs.result_output import PaperFiles
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.clamping import Clamping
from trunnion.model.motion import Decision, MachiningMode, PoleStrategy
from trunnion.output.capabilities import control_capabilities
from trunnion.output.program import OperationKey
from trunnion.output.subprograms import SubprogramOutput
from trunnion.planning import Clearance, ClearanceSurface, ControlCapabilities, PlanOptions
from trunnion.readers import check_reading
from trunnion.records import dataclass

if TYPE_CHECKING:  # imported where a program is simulated
    from trunnion.jobs.inputs.bodies import KnownTools
    from trunnion.jobs.inputs.simulation_input import SimulationInput
    from trunnion.simulation.meshes import TriangleMesh

#: Values of the setting ``mode``.
_MODES: Final = {
    "auto": None,
    "three-axis": MachiningMode.THREE_AXIS,
    "tilted": MachiningMode.TILTED,
    "tcp": MachiningMode.TCP,
}

#: The setting that makes a program of several files, and its value, as they are written.
_DIVIDING: Final = "programs=operations"
_DIVIDED: Final = "operations"


@dataclass(frozen=True, slots=True, eq=False)
class PostJob:
    """How a program is posted.

    machine       with its workpiece zero and tool length
    control       with or without block numbers
    capabilities  of the control with the settings
    options       of the planner
    settings      all of them, as text
    own_settings  those of single operations, by their names
    force         write a program that must not run, with notices in its head
    papers        where its papers go
    columns       work out the columns of the verification
    beside        files of subprograms that exist already and that templates call
    simulation    stock and all else that the program is simulated with; None: it is not; and the files of that
    sheet_tools   tools that the sheet names without a simulation; None: those of the CL files alone
    notices       comments for the head of the program
    clamping      how the part is clamped
    decisions     what was decided before planning, for reports
    can_force     whether ``force`` can be asked for, which refusals then say
    stock         of the part as it is drawn, where a simulation, a project or a CL file states it
    stock_from    the CL file that states it
    blank         corners of its box as the part is clamped, for the setting ``blank``; empty: not known
    setups        the machine with the tool and the work offset of single operations
    strict        a basis of the proof that is missing is an error
    """

    machine: Machine
    control: Control
    capabilities: ControlCapabilities
    options: PlanOptions
    settings: Mapping[str, str]
    force: bool = False
    papers: PaperFiles = field(default_factory=PaperFiles)
    columns: bool = False
    own_settings: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    beside: tuple[Path, ...] = ()
    simulation: "SimulationInput | None" = None
    simulation_files: tuple[str | os.PathLike[str], ...] = ()
    sheet_tools: "KnownTools | None" = None
    notices: tuple[str, ...] = ()
    clamping: Clamping = field(default_factory=Clamping)
    decisions: tuple[Decision, ...] = ()
    can_force: bool = True
    strict: bool = False
    stock: "str | Path | TriangleMesh | None" = None
    stock_from: str = ""
    blank: str = ""
    setups: Mapping[OperationKey, Machine] = field(default_factory=dict)

    @property
    def printed(self) -> dict[str, str]:
        """The settings that templates print."""
        found = {key: text for key, text in self.settings.items() if key not in RUN_SETTINGS or key in PROGRAM_CHOICES}
        return {**found, "blank": self.blank} if self.blank else found

    @property
    def encoding(self) -> str:
        """What names and texts of the program are written in."""
        return self.settings.get("encoding") or self.control.settings.get("encoding") or "utf-8"

    @property
    def planned_machine(self) -> Machine:
        """The machine with the margin to its limits that the planner keeps."""
        return self.with_margin(self.machine)

    def with_margin(self, machine: Machine) -> Machine:
        """Return a machine with the margin to its limits that the planner keeps."""
        return with_limit_margin(machine, self.settings)

    @property
    def has_normals(self) -> bool:
        """Whether the program states surface normals."""
        return {**self.control.settings, **self.settings}.get("normals") == "contact"

    def named_after(self, path: Path | None) -> Self:
        """Return the job of a program that has the number or name of its file, where the settings say so.

        Raises ``InputError`` if there is no file, or its name has no such number.
        """
        if {**self.control.settings, **self.settings}.get("program_from") != "file":
            return self
        if path is None:
            raise InputError(setting_problem("program_from", Wording("ARG250", "no_file_to_name")))
        rule = self.control.setting_rules.get("program", SettingRule())
        numbers = re.findall("[0-9]+", path.stem) if rule.is_number else [path.stem]
        if len(numbers) != 1 or not rule.allows(numbers[0]):
            wording = Wording("ARG250", "file_without_number", file=path.name, allowed=rule.allowed())
            raise InputError(setting_problem("program_from", wording))
        return replace(self, settings={**self.settings, "program": numbers[0]})

    def subprograms(self, files: OutputFiles, path: Path | None) -> SubprogramOutput | None:
        """How the program is divided into files; None: it is a single file.

        files  takes the subprograms
        path   of the main program; None: it is not written to a file

        Raises ``InputError`` if the control has no subprograms, there is no folder for them, or the settings contradict
        each other.
        """
        size = number_setting(self.settings, "split")
        if self.settings.get("programs", "one") == "one":
            if size is not None:
                raise InputError(
                    setting_problem("split", Wording("ARG240", "split_without_subprograms", dividing=_DIVIDING))
                )
            return None
        if self.control.subprograms is None:
            raise InputError(
                setting_problem(
                    "programs", Wording("ARG250", "no_subprograms", divided=_DIVIDED, control=self.control.name)
                )
            )
        if path is None:
            raise InputError(argument_problem("output", Wording("FIL210", "no_place_for_several_files")))
        numbered = self.control.subprograms.first_number is not None
        open_file = partial(files.add_file, is_numbered=True) if numbered else files.add_file
        return SubprogramOutput(path.stem, open_file, None if size is None else int(size))


def prepare(
    machine: Machine,
    settings: Settings | None = None,
    *,
    force: bool = False,
    explain: bool = False,
    papers: PaperFiles | None = None,
    columns: bool = False,
) -> PostJob:
    """Check the settings of a post, and make the job of it.

    Raises ``InputError`` with every setting that the control does not have or that makes no sense.
    """
    control = load_control(machine.control).with_rotary_axes(len(machine.own_rotary))
    check_reading(machine)
    texts = as_texts(settings)
    control = in_units(control, texts.get("units") or control.settings.get("units", MM))
    texts, own = split_by_operation(texts, control, machine)
    check_settings(texts, control, machine)
    stated_cycles(texts)  # before the CL files are read by it
    control = _with_numbers(control, texts.get("numbers"))
    control = _with_first_number(_with_first_block(control, texts), texts)
    machine = apply_setup(machine, texts)
    papers = papers or PaperFiles()
    options = parse_plan_options(texts, control, explain or papers.report is not None)
    capabilities = control_capabilities(control, texts)
    return PostJob(machine, control, capabilities, options, texts, force, papers, columns or papers.need_columns, own)


def _with_numbers(control: Control, asked: str | None) -> Control:
    """Return the control with the setting ``numbers``; None: as its definition says.

    Raises ``InputError`` if operations alone are to have numbers, and the control needs one before each block.
    """
    numbers = control.block_numbers
    if asked == "operations" and not numbers.letter:
        raise InputError(
            setting_problem("numbers", Wording("ARG250", "no_numbers_of_operations", control=control.name))
        )
    if asked is None or (asked == "on" and not numbers.letter):
        return control
    every = numbers.every if asked == "off" else 1
    changed = replace(numbers, numbered=asked != "off", every=every, at_operations=asked == "operations")
    return replace(control, block_numbers=changed)


def _with_first_block(control: Control, settings: Mapping[str, str]) -> Control:
    """Return the control with the setting ``first_block``.

    Raises ``InputError`` if it is no whole number or beyond half the highest, from where the numbers would soon begin
    again, or if blocks have no numbers, or have them by the control's own count.
    """
    first, numbers = number_setting(settings, "first_block"), control.block_numbers
    if first is None:
        return control
    if first != int(first):
        wording = Wording("ARG220", "no_whole_number", value=repr(settings["first_block"]))
    elif not numbers.letter:
        wording = Wording("ARG250", "first_block_of_control", control=control.name)
    elif not numbers.numbered:
        wording = Wording("ARG250", "first_block_without_numbers")
    elif first > (most := numbers.highest // 2):
        wording = Wording("ARG250", "first_block_beyond", control=control.name, highest=most)
    else:
        return replace(control, block_numbers=replace(numbers, start=int(first)))
    raise InputError(setting_problem("first_block", wording))


def _with_first_number(control: Control, settings: Mapping[str, str]) -> Control:
    """Return the control with the setting ``first_number``.

    Raises ``InputError`` if it is no whole number, or if there are no subprograms with numbers.
    """
    first = number_setting(settings, "first_number")
    if first is None:
        return control
    naming = control.subprograms
    if naming is None or naming.first_number is None or settings.get("programs") != "operations":
        raise InputError(
            setting_problem(
                "first_number",
                Wording("ARG240", "first_number_without_numbers", control=control.name)
                if naming and not naming.first_number
                else Wording("ARG240", "first_number_without_subprograms", dividing=_DIVIDING),
            )
        )
    if first != int(first):
        raise InputError(
            setting_problem("first_number", Wording("ARG220", "no_whole_number", value=repr(settings["first_number"])))
        )
    return replace(control, subprograms=replace(naming, first_number=int(first)))


def parse_plan_options(settings: Mapping[str, str], control: Control, explain: bool = False) -> PlanOptions:
    """Return the options of the planner, of settings that ``check_settings`` has checked.

    Raises ``InputError`` if a number is none or out of range, or the settings contradict the control or each other.
    """
    asked = settings.get("tcp", "on" if control.tcp else "off")
    tcp, m114 = asked == "on", asked == "m114"
    if tcp and not control.tcp:
        raise InputError(setting_problem("tcp", Wording("ARG250", "no_tcp")))
    if m114 and MachiningMode.M114 not in control.modes(settings):
        instead = ("on", "off") if control.tcp else ("off",)
        raise InputError(setting_problem("tcp", Wording("ARG250", "no_m114", control=control.name, instead=instead)))
    mode, mode_by_operation = _mode_setting(settings.get("mode", "auto"), tcp)
    numbers = {key: number_setting(settings, key) for key in ("pole_angle", "tip_tolerance", "axis_tolerance")}
    fastest, limit = settings.get("feed") == "fastest", number_setting(settings, "feed_limit")
    lower_feed = settings.get("lower_feed", "no") == "yes"
    if limit is not None and not fastest:
        raise InputError(setting_problem("feed_limit", Wording("ARG220", "only_with_fastest_feed")))
    if fastest and lower_feed:
        raise InputError(setting_problem("lower_feed", Wording("ARG220", "lower_feed_with_fastest")))
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
        lower_feed=lower_feed,
        fastest_feed=fastest,
        feed_limit=limit,
        tcp=tcp,
        m114=m114,
        holes_as_motion=settings.get("cycles", "on") == "off",
        default_axis_tolerance=control.axis_tolerance,
        **known,
    )


def _mode_setting(text: str, tcp: bool) -> tuple[MachiningMode | None, dict[str, MachiningMode | None]]:
    """Return the setting ``mode``: that of all operations, and those of some by their names, such as
    ``auto,SIDES:tcp``.
    """
    known = {word: mode for word, mode in _MODES.items() if tcp or mode is not MachiningMode.TCP}
    every, own, named = "auto", dict[str, MachiningMode | None](), set[str]()
    for entry in text.split(","):
        name, _, word = entry.rpartition(":")
        if name in named:
            raise InputError(setting_problem("mode", Wording("ARG220", "mode_twice", value=repr(text))))
        named.add(name)
        if word not in known:
            raise InputError(
                setting_problem(
                    "mode",
                    Wording("ARG220", "mode_without_tcp", known=tuple(known))
                    if word == "tcp"
                    else Wording("ARG220", "unknown_mode", value=repr(text), known=tuple(known)),
                )
            )
        if name:
            own[name] = known[word]
        else:
            every = word
    return known[every], own


def _parse_clearance(text: str) -> Clearance:
    """Return the setting ``clearance``."""
    kind, _, length = text.rpartition(":")
    try:
        surface, value = ClearanceSurface(kind or ClearanceSurface.DISTANCE), float(length)
    except ValueError:
        surface, value = ClearanceSurface.DISTANCE, math.nan
    least = -10000.0 if surface is ClearanceSurface.PLANE else 0.1
    if least <= value <= 10000.0:
        return Clearance(value, surface)
    raise InputError(setting_problem("clearance", RUN_SETTINGS["clearance"].fault("clearance", text)))
