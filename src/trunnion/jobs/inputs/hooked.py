"""Toolpaths as a user's hooks change them; what calls hooks is imported where there are some."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from trunnion.errors import InputError, argument_problem
from trunnion.jobs.inputs.arguments import check_paths
from trunnion.jobs.inputs.control_settings import written_control
from trunnion.jobs.inputs.reading import FilePath
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.toolpath import Toolpath

if TYPE_CHECKING:
    from trunnion.hooks.calling import Hooks


def loaded_hooks(files: Sequence[Path], machine: str, control: str, settings: Mapping[str, str]) -> "Hooks | None":
    """Return what calls the hooks of files, which see the names of machine and control, and settings; None: there are
    no files.

    Raises ``InputError`` if a file is none of hooks.
    """
    if not files:
        return None
    from trunnion.hooks.calling import Hooks
    from trunnion.hooks.files import load_hooks

    return Hooks(load_hooks(files), machine, control, settings)


def hooked_toolpaths(
    toolpaths: Sequence[Toolpath],
    machine: Machine,
    hooks: Sequence[FilePath],
    settings: Mapping[str, str] | None = None,
) -> list[Toolpath]:
    """Return what hooks make of toolpaths, which see machine, control and settings; without hooks they stay.

    Raises ``InputError`` if there are hooks and no toolpaths, or a hook fails.
    """
    files: list[Path] = check_paths("hooks", hooks)
    if not files:
        return list(toolpaths)
    if not toolpaths:
        raise no_cl_files()
    control = written_control(machine)
    calls = loaded_hooks(files, machine.name, control.name if control else "", settings or {})
    assert calls is not None
    return calls.change(toolpaths)


def no_cl_files() -> InputError:
    """Return the error of hooks where there is nothing that they could change."""
    return InputError(argument_problem("hooks", Wording("ARG130", "hooks_without_cl")))
