"""Whether two runs are the same."""

from collections.abc import Iterator
from dataclasses import fields
from typing import Any

import numpy as np

from trunnion.machines import Machine
from trunnion.model.run import Run


def facts(value: Any) -> Iterator[Any]:
    """Everything in a run, so that it can be compared."""
    for field in fields(value):
        one = getattr(value, field.name)
        if isinstance(one, np.ndarray):
            yield field.name, one.dtype, one.tobytes()
        elif hasattr(one, "__dataclass_fields__") and not isinstance(one, Machine):
            yield from facts(one)
        else:
            yield field.name, one


COLUMNS = (
    "line",
    "block_number",
    "kind",
    "programmed",
    "tip",
    "axis",
    "joints",
    "feed",
    "work_offset",
    "tcp",
    "spindle",
    "file",
)


def same(one: Run, two: Run) -> None:
    """Two runs are the same, except in last bits of positions, which depend on how many rows are computed together."""
    for name in COLUMNS:
        a, b = getattr(one, name), getattr(two, name)
        if a.dtype == np.float64:
            np.testing.assert_allclose(a, b, rtol=1e-14, atol=1e-12, err_msg=name)
        else:
            np.testing.assert_array_equal(a, b, err_msg=name)
    for name in ("row", "full_turns", "centre", "normal", "radius"):
        a, b = getattr(one.arcs, name), getattr(two.arcs, name)
        np.testing.assert_allclose(a, b, rtol=1e-12, atol=1e-9 if name == "centre" else 1e-12, err_msg=f"arcs: {name}")
    assert one.comments == two.comments
    assert one.events == two.events
    assert one.diagnostics == two.diagnostics
