"""What the definition of a machine means, for a person beside the machine."""

from operator import attrgetter
from pathlib import Path
from typing import Annotated

from trunnion.controls import load_control
from trunnion.definitions import load_table
from trunnion.errors import Problem
from trunnion.jobs.describe.assumptions import assumptions
from trunnion.jobs.describe.controls import TemplateDescription, main_texts
from trunnion.jobs.describe.template_motions import motions_in_branches
from trunnion.jobs.inputs.reading import MachineLike, as_machine
from trunnion.machines import Machine
from trunnion.machines.jog_table import JogTable, jog_table
from trunnion.machines.loading import machine_library
from trunnion.messages import Wording
from trunnion.records import dataclass
from trunnion.results import Figure


@dataclass(frozen=True, slots=True)
class MachineDescription:
    """What a machine's definition means.

    machine  as the definition has it
    jogs     where tool and table go when its axes are jogged, and where the tool points
    control  name of its control
    texts    those of its control that a program with one tool has, in their order
    taken    what its definition leaves open, marks as not measured, or has from another machine; ``assumed`` are the
             sentences
    remarks  warnings of what the proof of a program may not see
    """

    machine: Annotated[
        Machine,
        Figure("key", take=attrgetter("key")),
        Figure("name", take=attrgetter("name")),
        Figure("description", take=attrgetter("description")),
        Figure("spindle_direction", take=attrgetter("spindle_direction")),
        Figure("spindle_point", unit="mm", take=attrgetter("spindle_point")),
        Figure("workpiece_zero", unit="mm", take=attrgetter("workpiece_zero")),
    ]
    jogs: JogTable
    control: Annotated[str, Figure(after="assumed")]
    texts: Annotated[tuple[TemplateDescription, ...], Figure(after="control")]
    taken: Annotated[tuple[Wording, ...], Figure("assumed", take=lambda found: tuple(map(str, found)))] = ()
    remarks: tuple[Problem, ...] = ()

    @property
    def assumed(self) -> tuple[str, ...]:
        """What its definition leaves open, marks as not measured, or has from another machine, in sentences."""
        return tuple(map(str, self.taken))


def describe_machine(machine: MachineLike) -> MachineDescription:
    """Describe what the definition of a machine means, to be compared with the machine itself.

    Parameters
    ----------
    machine
        The name of a shipped machine, the path of a ``.toml`` file, or a ``Machine``.

    Returns
    -------
    MachineDescription
        For each axis where tool and table go as it is jogged; the tool axis at rotary positions that can be checked by
        hand; rotation centres, limits and home; the texts of its control; and what is assumed.

    Raises
    ------
    InputError
        With every mistake of the definition, each at its file and line.

    Notes
    -----
    Computed apart from what programs are written and read by.

    Examples
    --------
    >>> import trunnion
    >>> jogs = trunnion.describe_machine("dmu65").jogs
    >>> jogs.axes[1].iron
    'the table turns 10° clockwise seen from +X; its -Y edge goes to +Z, its +Y edge to -Z'
    """
    found = as_machine(machine)
    control = load_control(found.control).with_rotary_axes(len(found.own_rotary))
    table = load_table(machine, machine_library(), kind="machine") if isinstance(machine, str | Path) else None
    assumed = assumptions(found, table)
    remarks = tuple(motions_in_branches(control))
    return MachineDescription(found, jog_table(found), control.name, main_texts(control), assumed, remarks)
