"""Many files posted, converted, verified or simulated: on this computer, or on a cluster.

``run_batch`` is the front door. What a worker does is a function of bytes (``work``), what is kept is decided by
checksums (``keys``, ``records``), and who works is exchangeable (``local``, ``cluster``).
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from trunnion.batch.batch_run import run_batch as run_batch
    from trunnion.batch.cluster import Tls as Tls
    from trunnion.batch.running import BatchResult as BatchResult
    from trunnion.batch.worker_task import Status as Status

#: Public name -> its module.
_MODULES: Final = {"BatchResult": "running", "Status": "worker_task", "Tls": "cluster", "run_batch": "batch_run"}

__all__ = ["BatchResult", "Status", "Tls", "run_batch"]


if not TYPE_CHECKING:  # type checkers would take any name for known

    def __getattr__(name: str) -> Any:
        """Import a public name when it is first used: a worker process needs few of the modules."""
        if name not in _MODULES:
            raise AttributeError(f"module 'trunnion.batch' has no attribute {name!r}")
        return getattr(import_module(f"trunnion.batch.{_MODULES[name]}"), name)
