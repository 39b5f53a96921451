"""What the fixtures for small CL files return."""

from collections.abc import Callable

from trunnion.errors import Problem
from trunnion.model.toolpath import Operation, Toolpath

Read = Callable[..., Toolpath]
Body = Callable[..., Operation]
Fail = Callable[..., tuple[Problem, ...]]
