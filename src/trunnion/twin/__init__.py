"""The twin of a machine: a program that runs in time, served as its control would serve it.

``playback`` is its clock, ``snapshots`` what the machine shows at any time; ``opcua`` and ``mtconnect`` tell it to
clients, ``running`` drives them.
"""

from trunnion.twin.playback import Playback, PlayState, Stretch
from trunnion.twin.snapshots import Snapshots, TwinProgram

__all__ = ["PlayState", "Playback", "Snapshots", "Stretch", "TwinProgram"]
