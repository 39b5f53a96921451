"""Roughing of a channel: layers from shroud to hub, on each of them passes along the blades.

In:     a channel, a ball, step-over and step-down.
Out:    a ``PassFamily``; a ball of it is nowhere nearer to blades and hub than the allowances.
Units:  mm.
"""

from dataclasses import replace

from trunnion.impeller.paths.channel import Channel
from trunnion.impeller.paths.channel_layers import layers_of
from trunnion.impeller.paths.channel_passes import passes_on
from trunnion.impeller.paths.channel_sheets import Ball
from trunnion.impeller.paths.passes import Pass, PassFamily, Stepover, Way
from trunnion.impeller.progress import Progress, silent


def channel_roughing(
    channel: Channel,
    radius: float,
    stepover: Stepover,
    step_down: float,
    *,
    tolerance: float,
    blade_allowance: float = 0.0,
    hub_allowance: float = 0.0,
    progress: Progress = silent,
) -> PassFamily:
    """Return passes of a ball that clears a channel.

    channel                         one of ``channels_of``
    radius                          of the ball, mm
    stepover                        between neighbouring passes of a layer, mm, between the ball's centres
    step_down                       between layers at most, mm, above 0
    tolerance                       how far chords may be off the path, mm
    blade_allowance, hub_allowance  what is left, mm
    progress                        accompanies the work

    Raises ``InputError`` if the ball is smaller than the fillet, does not get out of the stock, or does not fit between
    the blades; the place is named then, and the largest ball that fits.
    """
    ball = Ball(radius, blade_allowance, hub_allowance, tolerance)
    layers = layers_of(channel, ball, step_down, progress)[::-1]
    along = min(layer.u[0] for layer in layers), max(layer.u[-1] for layer in layers)
    passes: list[Pass] = []
    for number, layer in enumerate(layers):
        passes += [replace(one, layer=number) for one in passes_on(layer, radius, stepover, tolerance, along, 0.0)]
    return PassFamily(tuple(passes), radius, Way.BOTH_WAYS)
