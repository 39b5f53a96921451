"""What a machine displays of an axis that turns without end."""

import numpy as np
import pytest

from trunnion.machines import AngleOutput, Axis
from trunnion.machines.machine import AxisKind, Mount


def axis(output: str, endless: bool = True) -> Axis:
    low, high = (-np.inf, np.inf) if endless else (-720.0, 720.0)
    direction = (0.0, 0.0, 1.0)
    return Axis(
        "C", AxisKind.ROTARY, Mount.PART, direction, low=low, high=high, endless=endless, output=AngleOutput(output)
    )


@pytest.mark.parametrize(
    ("output", "values", "shown"),
    [
        ("0..360", [-120.0, -720.0, 359.99999, 400.0, -0.0], [240.0, 0.0, 0.0, 40.0, 0.0]),
        ("-180..180", [190.0, -180.0, 180.0, -540.5], [-170.0, -180.0, -180.0, 179.5]),
        ("none", [-120.0, 725.25], [-120.0, 725.25]),
    ],
)
def test_positions_are_within_the_turn_that_is_displayed(output: str, values: list[float], shown: list[float]) -> None:
    assert axis(output).displayed(np.array(values), 3).tolist() == shown
    assert axis(output, endless=False).displayed(np.array(values), 6).tolist() == values


@pytest.mark.parametrize(
    ("output", "low", "high", "shown"),
    [
        ("0..360", -120.0, -120.0, (240.0, 240.0)), ("0..360", -130.0, -120.0, (230.0, 240.0)),
        ("0..360", -10.0, 10.0, (350.0, 10.0)), ("0..360", -720.0, -120.0, (0.0, 360.0)),
        ("0..360", 0.0, 360.0, (0.0, 360.0)), ("-180..180", 170.0, 190.0, (170.0, -170.0)),
        ("-180..180", 350.0, 370.0, (-10.0, 10.0)), ("none", -720.0, -120.0, (-720.0, -120.0)),
    ],
)  # fmt: skip
def test_a_range_is_that_along_the_way_and_a_turn_is_all_of_it(
    output: str, low: float, high: float, shown: tuple[float, float]
) -> None:
    assert axis(output).displayed_range(low, high, 3) == shown
    assert axis(output, endless=False).displayed_range(low, high, 3) == (low, high)
