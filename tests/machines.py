"""Shipped machines as tests want them."""

from dataclasses import replace

from trunnion.machines import Machine, load_machine


def at_zero(name: str) -> Machine:
    """A shipped machine whose slides begin at zero, and are at home there."""
    machine = load_machine(name)
    axes = tuple(axis if axis.is_rotary else replace(axis, home=0.0) for axis in machine.axes)
    return replace(machine, axes=axes)
