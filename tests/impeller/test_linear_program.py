"""Linear programs that have no end, no solution, or are stopped."""

import numpy as np

from trunnion.extras import import_extra
from trunnion.impeller.linear_program import INTERIOR_POINT, SIMPLEX, solve_linear_program

csr_matrix = import_extra("scipy.sparse", "impeller").csr_matrix

#: A cube's corner, cut off: the least of −x − y − z is at −2.5.
ROWS = csr_matrix(np.array([[1.0, 1.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]))
LIMITS = np.array([2.5, 1.0, 1.0, 1.0])
COST = -np.ones(3)
FREE: list[tuple[float | None, float | None]] = [(None, None)] * 3

#: An attempt that is over before it has begun.
STOPPED = ("highs-ds", {"maxiter": 0, "presolve": False})


def test_the_least_is_found() -> None:
    for attempts in (INTERIOR_POINT, SIMPLEX):
        found = solve_linear_program(COST, ROWS, LIMITS, FREE, attempts)
        assert found is not None
        assert abs(found.sum() - 2.5) < 1e-6


def test_an_attempt_that_comes_to_its_limit_is_followed_by_the_next() -> None:
    assert solve_linear_program(COST, ROWS, LIMITS, FREE, [STOPPED]) is None
    found = solve_linear_program(COST, ROWS, LIMITS, FREE, [STOPPED, *INTERIOR_POINT])
    assert found is not None


def test_every_attempt_has_a_limit() -> None:
    assert all(options["maxiter"] > 0 for _, options in (*INTERIOR_POINT, *SIMPLEX))


def test_a_program_without_solution_has_none() -> None:
    rows, limits = csr_matrix([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]), np.array([-1.0, -1.0])
    assert solve_linear_program(COST, rows, limits, FREE, INTERIOR_POINT) is None
