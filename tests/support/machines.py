"""Shipped machines, changed as tests need them."""

from dataclasses import replace
from pathlib import Path

from trunnion.machines import Machine, load_machine, shipped_machines


def at_zero(name: str) -> Machine:
    """A shipped machine whose slides have their home at zero."""
    machine = load_machine(name)
    axes = tuple(axis if axis.is_rotary else replace(axis, home=0.0) for axis in machine.axes)
    return replace(machine, axes=axes)


def machine_without_tcp(folder: Path) -> Path:
    """The file of a YL569 whose approach lacks TRAORI."""
    file = folder / "forgetful.toml"
    file.write_text(
        'extends = "yl569"\n[control.templates]\napproach_five_axis = """\n'
        ";Initial Move\nG0 {primary_word} {secondary_word}\n{work_offset}\nORIWKS\nORIAXES\n"
        '"""\n',
        encoding="utf-8",
    )
    return file


def five_axis_machines() -> list[str]:
    """Names of the shipped machines with two rotary axes, sorted: those with fewer have tests of their own."""
    return [name for name in shipped_machines() if len(load_machine(name).own_rotary) == 2]
