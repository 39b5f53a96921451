"""Toolpaths as a user's hooks change them, for commands that post or prove nothing with them themselves."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from trunnion.errors import InputError, argument_problem
from trunnion.jobs.inputs.arguments import check_paths
from trunnion.jobs.inputs.control_settings import written_control
from trunnion.jobs.inputs.reading import FilePath
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.toolpath import Toolpath


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
    from trunnion.hooks.calling import Hooks
    from trunnion.hooks.files import load_hooks  # few commands have hooks

    control = written_control(machine)
    return Hooks(load_hooks(files), machine.name, control.name if control else "", settings or {}).change(toolpaths)


def no_cl_files() -> InputError:
    """Return the error of hooks where there is nothing that they could change."""
    return InputError(argument_problem("hooks", Wording("ARG130", "hooks_without_cl")))
