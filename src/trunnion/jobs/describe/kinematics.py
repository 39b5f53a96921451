"""The formulas of a machine, with the set-up that is given."""

from typing import Unpack

from trunnion.formulas.description import Kinematics, kinematics_of
from trunnion.formulas.symbols import sympy
from trunnion.jobs.arguments import KinematicsArguments, taken
from trunnion.jobs.inputs.reading import MachineLike, as_machine
from trunnion.jobs.inputs.stated_setup import check_one_zero, length_of_tool_missing, set_up_machine
from trunnion.messages import Wording


def kinematics(machine: MachineLike, **given: Unpack[KinematicsArguments]) -> Kinematics:
    """Return the formulas of a machine: its frames, forward and inverse map, words without TCP, and poles.

    Parameters
    ----------
    machine
        The name of a shipped machine, the path of a ``.toml`` file, or a ``Machine``.
    zero : (3,) float, mm
        Workpiece zero on the machine; without one it is an unknown symbol of the formulas.
    tool_length
        From the gauge point of the spindle to the tip, mm; without one it is an unknown symbol.

    Returns
    -------
    Kinematics
        Each formula as text, which Python understands as well, and as LaTeX; what its symbols are; and how far the
        formulas are from ``machines.forward`` and ``machines.inverse`` at random poses.

    Raises
    ------
    InputError
        When the definition or an argument cannot be used.
    MissingExtraError
        When SymPy is not installed.

    Notes
    -----
    Formulas are derived from the definition each time, and not taken from a list of types of machine.

    Examples
    --------
    >>> import trunnion
    >>> found = trunnion.kinematics("yl569")
    >>> [f"{each.name} = {each.text}" for each in found.solutions[0].rotary]
    ['B = acos(k)', 'C = atan2(j, i)']
    >>> found.passed
    True
    """
    stated = taken(KinematicsArguments, "kinematics", given)
    sympy()
    loaded = set_up_machine(as_machine(machine), stated["zero"], stated["tool_length"])
    check_one_zero(loaded, Wording("ARG220", "zero_of_no_offset"))
    if loaded.tool_lengths:
        raise length_of_tool_missing("")
    return kinematics_of(loaded)
