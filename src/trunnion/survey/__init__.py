"""A folder of files tried: what Trunnion makes of each CL file and program, and what stands in the way of most.

``take_survey`` is the front door. ``found_files`` says what each file is, ``trying`` tries one on one machine in a
worker, ``result`` counts.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from trunnion.survey.result import Survey as Survey
    from trunnion.survey.taking import take_survey as take_survey

#: Public name -> its module.
_MODULES: Final = {"Survey": "result", "take_survey": "taking"}

__all__ = ["Survey", "take_survey"]


if not TYPE_CHECKING:  # type checkers would take any name for known

    def __getattr__(name: str) -> Any:
        """Import a public name when it is first used: a worker process needs few of the modules."""
        if name not in _MODULES:
            raise AttributeError(f"module 'trunnion.survey' has no attribute {name!r}")
        return getattr(import_module(f"trunnion.survey.{_MODULES[name]}"), name)
