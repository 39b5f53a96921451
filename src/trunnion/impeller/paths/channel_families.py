"""Passes of a ball in a channel: roughing in layers from shroud to hub, and finishing of the hub; along the blades.

In:     a channel, a ball, step-over and step-down.
Out:    a ``PassFamily``; a ball of it is nowhere nearer to blades and hub than the allowances. That of a finished hub
        touches it, and at either side of the channel the blade, but for them.
Units:  mm.

Each raises ``InputError`` if the ball is smaller than the fillet, does not get out of the stock, or does not fit
between the blades; the place is named then, and the largest ball that fits.
"""

from dataclasses import replace

from trunnion.impeller.paths.channel import Channel
from trunnion.impeller.paths.channel_layers import layers_of
from trunnion.impeller.paths.channel_passes import passes_on
from trunnion.impeller.paths.channel_sheets import Ball
from trunnion.impeller.paths.passes import Pass, PassFamily, Stepover, Way
from trunnion.impeller.progress import Progress, silent


def channel_roughing(
    channel: Channel, ball: Ball, stepover: Stepover, step_down: float, progress: Progress = silent
) -> PassFamily:
    """Return passes that clear a channel, one of ``channels_of``.

    stepover   between neighbouring passes of a layer, mm, between the ball's centres
    step_down  between layers at most, mm, above 0
    """
    layers = layers_of(channel, ball, step_down, progress)[::-1]
    along = min(layer.u[0] for layer in layers), max(layer.u[-1] for layer in layers)
    passes: list[Pass] = []
    for number, layer in enumerate(layers):
        own = passes_on(layer, ball.radius, stepover, ball.tolerance, along, 0.0)
        passes += [replace(one, layer=number) for one in own]
    return PassFamily(tuple(passes), ball.radius, Way.BOTH_WAYS)


def hub_finish(channel: Channel, ball: Ball, stepover: Stepover, progress: Progress = silent) -> PassFamily:
    """Return passes on the hub of a channel, one of ``channels_of``; ``stepover`` counts on the hub, mm."""
    (layer,) = layers_of(channel, ball, None, progress)
    along = float(layer.u[0]), float(layer.u[-1])
    passes = passes_on(layer, ball.radius, stepover, ball.tolerance, along, ball.radius)
    return PassFamily(tuple(passes), ball.radius, Way.BOTH_WAYS)
