"""A simulation in shares, each of some tiles of the stock: cut one by one, wherever that is, and put together.

In:     a program, and arguments of ``trunnion.simulate`` by their names, the same for all shares.
Out:    a share as bytes; of all of them the result that ``trunnion.simulate`` gives.
"""

from collections.abc import Mapping, Sequence
from typing import Any, Final

from trunnion.jobs.inputs.reading import FilePath
from trunnion.jobs.inputs.simulation_input import SimulationInput
from trunnion.jobs.observer import Observer
from trunnion.jobs.simulate.result import SimulationResult
from trunnion.jobs.simulate.simulating import as_simulation_input
from trunnion.jobs.simulate.steps import cut_setup_share, simulate_setups
from trunnion.simulation.cutting.shares import JoinedShares, Share

#: Arguments of all set-ups together.
_WHOLE: Final = ("stock", "cell", "accuracy", "near", "stop_at", "threads")


def simulate_share(nc: FilePath, share: Share, arguments: Mapping[str, Any], observer: Observer) -> bytes:
    """Cut the tiles of a share with a program.

    Raises
    ------
    InputError
        As ``trunnion.simulate``; and if the simulation has several set-ups, or ends at the first finding.
    """
    return cut_setup_share(_input(nc, arguments), share, observer)


def join_shares(
    nc: FilePath, shares: Sequence[bytes], arguments: Mapping[str, Any], observer: Observer
) -> SimulationResult:
    """Put all shares of a simulation together.

    Raises
    ------
    InputError
        As ``simulate_share``.
    DamagedShareError
        If the shares are not as they were made.
    """
    return simulate_setups(_input(nc, arguments), observer, JoinedShares(shares))


def _input(nc: FilePath, arguments: Mapping[str, Any]) -> SimulationInput:
    whole = {name: arguments.get(name) for name in _WHOLE}
    return as_simulation_input(nc, whole, {name: arguments[name] for name in arguments if name not in _WHOLE})
