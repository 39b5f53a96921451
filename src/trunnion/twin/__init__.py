"""The twin of a machine: a program that runs in time, served as its control would serve it.

``playback`` is its clock, ``snapshots`` what the machine shows at any time; ``opcua`` and ``mtconnect`` tell it to
clients, ``running`` drives them.
"""
