"""Finishing of the hub between two blades.

In:     a channel, a ball and a step-over.
Out:    a ``PassFamily`` whose ball touches the hub, and at either side of the channel the blade, but for allowances.
Units:  mm.
"""

from trunnion.impeller.paths.channel import Channel
from trunnion.impeller.paths.channel_layers import layers_of
from trunnion.impeller.paths.channel_passes import passes_on
from trunnion.impeller.paths.channel_sheets import Ball
from trunnion.impeller.paths.passes import PassFamily, Stepover, Way
from trunnion.impeller.progress import Progress, silent


def hub_finish(
    channel: Channel,
    radius: float,
    stepover: Stepover,
    *,
    tolerance: float,
    blade_allowance: float = 0.0,
    hub_allowance: float = 0.0,
    progress: Progress = silent,
) -> PassFamily:
    """Return passes of a ball on the hub of a channel, along the blades.

    channel                         one of ``channels_of``
    radius                          of the ball, mm
    stepover                        between neighbouring passes, mm, on the hub
    tolerance                       how far chords may be off the path, mm
    blade_allowance, hub_allowance  what is left, mm
    progress                        accompanies the work

    Raises ``InputError`` if the ball is smaller than the fillet, does not get out of the stock, or does not fit between
    the blades; the place is named then, and the largest ball that fits.
    """
    (layer,) = layers_of(channel, Ball(radius, blade_allowance, hub_allowance, tolerance), None, progress)
    along = float(layer.u[0]), float(layer.u[-1])
    return PassFamily(tuple(passes_on(layer, radius, stepover, tolerance, along, radius)), radius, Way.BOTH_WAYS)
