"""Linear programs, solved within a limit of iterations; Ctrl-C does not wait for them.

In:     a cost, rows A x ≤ b, bounds.
Out:    the x of least cost; None if none of some attempts finds it.

The interior point method takes some tens of iterations. What can go on for hours is the simplex method that cleans up
after it, where a basis is off by hardly more than a tolerance: then a wider one lets it stand. The limits are counts of
iterations, not times: the same program has the same solution on every computer.
"""

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.concurrency import interruptible
from trunnion.extras import import_extra

#: HiGHS, one attempt after another: its method, and options of it.
_Attempts = Sequence[tuple[str, Mapping[str, float]]]

INTERIOR_POINT: Final[_Attempts] = (
    ("highs-ipm", {"maxiter": 500}),
    ("highs-ipm", {"maxiter": 500, "dual_feasibility_tolerance": 1e-5}),
    ("highs-ds", {"maxiter": 5_000}),
)
SIMPLEX: Final[_Attempts] = (
    ("highs", {"maxiter": 20_000}),
    ("highs-ipm", {"maxiter": 500, "dual_feasibility_tolerance": 1e-5}),
)


def solve_linear_program(
    cost: Floats, rows: Any, limits: Floats, bounds: Sequence[tuple[float | None, float | None]], attempts: _Attempts
) -> Floats | None:
    """Return the x of least cost · x, with rows · x ≤ limits and within bounds; None if no attempt finds it."""
    solve = import_extra("scipy.optimize", "impeller").linprog

    for method, options in attempts:

        def attempt(method: str = method, options: Mapping[str, float] = options) -> Any:
            return solve(cost, A_ub=rows, b_ub=limits, bounds=bounds, method=method, options=dict(options))

        found = interruptible(attempt)
        if found.x is not None and np.isfinite(found.x).all():
            return np.asarray(found.x)
    return None
