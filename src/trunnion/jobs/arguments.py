"""Arguments of the library's functions by their names, as the commands declare them; and what is taken of them.

A test holds names and types to the declarations in ``jobs.registry``: a new option is one line here, beside its
declaration. Functions say in their docstrings what each means; here it stands under the names of groups.
"""

import os
import warnings
from collections.abc import Iterable, Mapping, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final, Literal, TypedDict, TypeVar, cast

from trunnion.errors import InputError, argument_problem
from trunnion.jobs.inputs.arguments import is_output, no_mapping, wrong_argument
from trunnion.jobs.inputs.reading import FilePath, MachineLike, ToolpathLike
from trunnion.jobs.inputs.settings import Settings, reported_as_arguments
from trunnion.jobs.inputs.stated_setup import LengthLike, ZeroLike
from trunnion.jobs.registry import JOBS
from trunnion.jobs.result_output import OutputLike
from trunnion.messages import Wording, phrase
from trunnion.options.kinds import Choice, FileOut, Number, Setting, Switch, WrongValueError
from trunnion.options.option import SEVERAL, Option
from trunnion.wording import nearest_word

if TYPE_CHECKING:  # modules that few of the functions need
    from trunnion.model.recording import Recording
    from trunnion.simulation.meshes import TriangleMesh
    from trunnion.simulation.tools.profile import ToolShape

_Given = TypeVar("_Given")


class ReadingArguments(TypedDict, total=False):
    """How CL files are read."""

    units: Literal["mm", "inch"] | None
    dialect: str | None
    strict: bool


class SetUpArguments(TypedDict, total=False):
    """Where the part sits, and how long the tool is."""

    zero: ZeroLike | None
    tool_length: LengthLike | None


class StatedArguments(TypedDict, total=False):
    """What is stated of a program besides the definition."""

    settings: Settings | None
    assume: Mapping[str, str] | None


class ClampingArguments(TypedDict, total=False):
    """How the part is clamped, degrees."""

    turn: float | None
    tilt: float | None


class BodyArguments(TypedDict, total=False):
    """Stock, part, fixtures and tools."""

    stock: "str | Path | TriangleMesh | None"
    part: "str | Path | TriangleMesh | None"
    fixtures: "str | Path | TriangleMesh | Iterable[str | Path | TriangleMesh]"
    tools: "str | ToolShape | Iterable[str | ToolShape]"
    tool_libraries: Sequence[FilePath]
    unit: Literal["mm", "inch"] | None


class CuttingArguments(TypedDict, total=False):
    """How fine a simulation is, mm."""

    near: float | None
    cell: float | None
    accuracy: float | None


class PostArguments(ReadingArguments, SetUpArguments, ClampingArguments, total=False):
    """Arguments of ``trunnion.post``."""

    output: OutputLike
    settings: Settings | None
    subprograms: Sequence[FilePath]
    hooks: Sequence[FilePath]
    feed: Literal["programmed", "fastest"] | None
    max_tilt: float | None
    edited: Literal["refuse", "keep", "replace"] | None
    force: bool
    explain: bool
    report: FilePath | None
    sheet: FilePath | None
    listing: FilePath | None
    manifest: FilePath | None
    columns: bool
    simulation: Mapping[str, Any] | FilePath | None
    sheet_tools: Mapping[str, Any] | None


class ConvertArguments(ReadingArguments, SetUpArguments, StatedArguments, total=False):
    """Arguments of ``trunnion.convert``."""

    machine: MachineLike | None
    to_machine: MachineLike | None
    to_cl: bool
    to_dialect: str | None
    positions: Literal["tip", "gauge_line"] | None
    registers: Mapping[str, str] | None
    output: OutputLike
    subprograms: Sequence[FilePath]
    force: bool


class VerifyArguments(ReadingArguments, ClampingArguments, SetUpArguments, StatedArguments, total=False):
    """Arguments of ``trunnion.verify``."""

    cl: ToolpathLike | Iterable[ToolpathLike]
    subprograms: Sequence[FilePath]
    hooks: Sequence[FilePath]
    tolerance: float
    span: float | None
    span_tip: float | None
    tool: str | int
    work_offset: str | None
    edge: int | str | None
    frame: Literal["first", "absolute"]
    feed: Literal["programmed", "fastest"]
    feed_limit: float | None
    radius_register: Literal["unknown", "difference", "radius"] | None
    cutcom: Literal["centreline", "contour"] | None
    tool_libraries: Sequence[FilePath]
    unit: Literal["mm", "inch"] | None
    recorded: "FilePath | Recording | None"
    recorded_tolerance: float
    columns: bool


class DiffArguments(SetUpArguments, StatedArguments, total=False):
    """Arguments of ``trunnion.diff``."""

    to_machine: MachineLike | None
    subprograms: Sequence[FilePath]
    to_subprograms: Sequence[FilePath]
    tolerance: float
    path: bool


class SimulateArguments(
    ReadingArguments, BodyArguments, CuttingArguments, SetUpArguments, ClampingArguments, StatedArguments, total=False
):
    """Arguments of ``trunnion.simulate``."""

    hooks: Sequence[FilePath]
    machine: MachineLike | None
    cl: ToolpathLike | Iterable[ToolpathLike]
    subprograms: Sequence[FilePath]
    radius_register: Literal["unknown", "difference", "radius"] | None
    stop_at: Literal["none", "first"] | None
    until: str | int | None
    threads: int | None


class PlaceArguments(ReadingArguments, BodyArguments, SetUpArguments, total=False):
    """Arguments of ``trunnion.place``."""

    hooks: Sequence[FilePath]
    goal: str
    turns: float | Sequence[float] | None
    tilts: float | Sequence[float]
    radius_register: Literal["unknown", "difference", "radius"] | None
    settings: Settings | None
    subprograms: Sequence[FilePath]


class PlacedArguments(TypedDict, total=False):
    """Arguments of ``trunnion.post_placed``."""

    output: OutputLike
    settings: Settings | None
    sheet: FilePath | None
    hooks: Sequence[FilePath]


class ReachArguments(ReadingArguments, SetUpArguments, total=False):
    """Arguments of ``trunnion.reach``."""

    settings: Settings | None
    hooks: Sequence[FilePath]
    cl: ToolpathLike | Iterable[ToolpathLike]
    part: FilePath | None
    lean: float
    step: float


class FitArguments(ReadingArguments, SetUpArguments, total=False):
    """Arguments of ``trunnion.fit``."""

    settings: Settings | None
    hooks: Sequence[FilePath]
    machines: str | Iterable[MachineLike]
    machine: MachineLike | None
    subprograms: Sequence[FilePath]
    turns: float | Sequence[float] | None


class KinematicsArguments(SetUpArguments, total=False):
    """Arguments of ``trunnion.kinematics``."""


class SensitivityArguments(SetUpArguments, total=False):
    """Arguments of ``trunnion.sensitivity``."""

    subprograms: Sequence[FilePath]
    length: float
    angle: float
    zero_at: str | Mapping[str, float] | None


class ViewArguments(ReadingArguments, BodyArguments, CuttingArguments, SetUpArguments, StatedArguments, total=False):
    """Arguments of ``trunnion.write_view``."""

    hooks: Sequence[FilePath]
    machine: MachineLike | None
    against: FilePath | Sequence[FilePath] | None
    against_machine: MachineLike | None
    setup: str | None
    radius_register: Literal["unknown", "difference", "radius"] | None
    cl: ToolpathLike | Iterable[ToolpathLike]
    subprograms: Sequence[FilePath]


class LiveArguments(TypedDict, total=False):
    """How a machine is connected to."""

    nodes: FilePath
    rate: float
    secure: bool
    trust: str
    user: str
    password: str


class ImpellerArguments(TypedDict, total=False):
    """Arguments of ``trunnion.cut_impeller``."""

    operations: Sequence[str]
    settings: Settings | None
    cell: float | None


#: What only the library has, and what it is where it is not given.
LIBRARY: Final[Mapping[str, Any]] = MappingProxyType(
    {
        "columns": True, "simulation": None, "sheet_tools": None, "threads": None, "ready": None, "password": "",
        "weights": None, "tls": None, "tiles": None, "recorded": None,
    }
)  # fmt: skip

#: Names of earlier versions, which are still taken with a warning: name -> the present one.
EARLIER: Final[Mapping[str, str]] = MappingProxyType({"libraries": "tool_libraries"})


def taken(kind: type[_Given], command: str, given: _Given) -> _Given:
    """Return all arguments of a function: those that are given, and of the others what the command has by default.

    Options that stand for settings are among the settings.

    Raises ``TypeError`` for a name that the function does not have.

    Raises ``InputError`` if something is given as an argument and as a setting.
    """
    known = kind.__annotations__
    stated = _known(cast(Mapping[str, Any], given), known, command)
    options = {each.name: each for each in JOBS[command].options if each.name in known}
    found = {name: LIBRARY.get(name) for name in known} | {name: each.empty for name, each in options.items()}
    found |= {name: None for name, each in options.items() if isinstance(each.kind, Setting) or each.setting}
    for name in stated.keys() & options.keys():
        _check(options[name], stated[name])
    if (settings := stated.get("settings")) is not None and not isinstance(settings, Mapping):
        raise no_mapping("settings", settings)
    found |= stated
    for name, option in options.items():
        if option.setting and found[name] is not None:
            found["settings"] = _with_setting(found["settings"], option.setting, name, found[name])
    return cast(_Given, found)


def reported_by_arguments(command: str, given: Mapping[str, Any]) -> AbstractContextManager[None]:
    """Have problems with settings that were given as arguments told as problems with these."""
    stated = [each for each in JOBS[command].options if each.setting and given.get(each.name) is not None]
    return reported_as_arguments({each.setting: each.name for each in stated})


def _check(option: Option, value: Any) -> None:
    """Refuse a value in the words of the command line; other texts and lists are up to the function."""
    kind = option.kind
    if isinstance(kind, FileOut) and not isinstance(value, str | os.PathLike | bool | None) and not is_output(value):
        raise wrong_argument(option.name, value, phrase("give_path"))
    if value is None or not isinstance(kind, Number | Choice | Switch):
        return
    if isinstance(value, list | tuple) and (option.many in SEVERAL or isinstance(kind, Number)):
        return
    if isinstance(kind, Number) and isinstance(value, str):
        return
    try:
        kind.check(value)
    except WrongValueError as error:
        raise InputError(argument_problem(option.name, error.wording)) from None


def with_present_names(given: Mapping[str, Any]) -> dict[str, Any]:
    """Return arguments under their present names; those of earlier versions are warned of."""
    found: dict[str, Any] = {}
    for name, value in given.items():
        present = EARLIER.get(name, name)
        if present != name:
            what = f"the argument {name!r} is now called {present!r}; the next version no longer knows {name!r}"
            warnings.warn(what, FutureWarning, stacklevel=4)
        found[present] = value
    return found


def _known(given: Mapping[str, Any], known: Iterable[str], command: str) -> dict[str, Any]:
    """Return arguments under their present names, all of which the function has."""
    names = [*known]
    found = with_present_names(given)
    for name in found:
        if name not in names:
            near = nearest_word(name, names)
            raise TypeError(f"{command} has no argument {name!r}{f'; did you mean {near!r}?' if near else ''}")
    return found


def _with_setting(settings: Settings | None, key: str, name: str, value: Any) -> Settings:
    """Return settings with one that is given as an argument."""
    if settings is not None and key in settings:
        raise InputError(argument_problem(name, Wording("ARG130", "setting_too", key=key)))
    return {**(settings or {}), key: value}
