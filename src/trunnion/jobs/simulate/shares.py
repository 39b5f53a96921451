"""A simulation in shares, each of some tiles of the stock: cut one by one, wherever that is, and put together.

In:     a program, and arguments of ``trunnion.simulate`` by their names, the same for all shares.
Out:    a share as bytes; of all of them the result that ``trunnion.simulate`` gives.
"""

from collections.abc import Sequence

from trunnion.jobs.arguments import SimulateArguments
from trunnion.jobs.inputs.reading import FilePath
from trunnion.jobs.observer import Observer
from trunnion.jobs.simulate.result import SimulationResult
from trunnion.jobs.simulate.simulating import as_simulation_input
from trunnion.jobs.simulate.steps import cut_setup_share, simulate_setups
from trunnion.simulation.cutting.shares import JoinedShares, Share


def simulate_share(nc: FilePath, share: Share, arguments: SimulateArguments, observer: Observer) -> bytes:
    """Cut the tiles of a share with a program.

    Raises ``InputError`` as ``trunnion.simulate``; and if the simulation has several set-ups, or ends at the first
    finding.
    """
    return cut_setup_share(as_simulation_input(nc, arguments), share, observer)


def join_shares(
    nc: FilePath, shares: Sequence[bytes], arguments: SimulateArguments, observer: Observer
) -> SimulationResult:
    """Put all shares of a simulation together.

    Raises ``InputError`` as ``simulate_share``.

    Raises ``DamagedShareError`` if the shares are not as they were made.
    """
    return simulate_setups(as_simulation_input(nc, arguments), observer, JoinedShares(shares))
