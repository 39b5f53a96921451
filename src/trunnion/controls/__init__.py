"""Controls: the language of each as data, and what a family of controls must be able to say.

In:     TOML (``controls/library`` and the ``[control]`` table of a machine).
Out:    ``Control``, read and checked.
"""

from trunnion.controls.definition import Control, load_control

__all__ = ["Control", "load_control"]
