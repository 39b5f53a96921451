"""Controls: the language of each as data, and the interface for what data cannot express.

In:     TOML (``controls/library`` and the ``[control]`` table of a machine).
Out:    ``Control``, read and checked.
"""

from trunnion.controls.definition import Control
from trunnion.controls.loading import control_library, load_control, shipped_controls

__all__ = ["Control", "control_library", "load_control", "shipped_controls"]
