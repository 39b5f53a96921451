"""The shipped machines against what was published of them."""

import numpy as np
import pytest

from tests.support.machines import five_axis_machines
from trunnion.machines import AngleOutput, Mount, forward, inverse, load_machine

#: B, C, i, j, k as printed; the vectors are cut to four decimals, not rounded. The fourth row is left out of them: it
#: repeats the vector of the first, and only to 1.5e-4 belongs to its own angles.
REPEATED = (58.8065, 32.3751, 0.7225, 0.4579, 0.5179)
YL569 = [
    (58.8083, 32.3689, 0.7225, 0.4579, 0.5179),
    (58.8069, 32.3731, 0.7224, 0.4580, 0.5179),
    (58.8066, 32.3756, 0.7224, 0.4580, 0.5179),
    (58.8054, 32.3752, 0.7224, 0.4580, 0.5179),
]


def in_order(key: str, **values: float) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    """One row of axis values by name; the others are zero."""
    return np.array([[values.get(name, 0.0) for name in load_machine(key).names]])


@pytest.mark.parametrize(("b", "c", "i", "j", "k"), YL569)
def test_the_yl569_points_its_tool_as_in_the_published_table(b: float, c: float, i: float, j: float, k: float) -> None:
    _, axis = forward(load_machine("yl569"), in_order("yl569", B=b, C=c))
    assert (np.floor(axis[0] * 1e4) / 1e4).tolist() == [i, j, k]


@pytest.mark.parametrize(("b", "c", "i", "j", "k"), [*YL569, REPEATED])
def test_the_yl569_takes_the_angles_of_the_published_table(b: float, c: float, i: float, j: float, k: float) -> None:
    machine = load_machine("yl569")
    found = inverse(machine, np.zeros((1, 3)), np.array([[i, j, k]])).joints[0, 0]
    # A vector cut to four decimals leaves so much of an angle open.
    open_deg = np.degrees(1.5e-4)
    assert found[machine.column("B")] == pytest.approx(b, abs=open_deg)
    assert found[machine.column("C")] == pytest.approx(c, abs=open_deg / np.sin(np.radians(b)))


def test_the_umc750_points_its_tool_as_in_the_example_of_its_manual() -> None:
    # The example of G234 approaches along the tool at B47.137 C116.354; its points have four decimals of an inch.
    start, end = np.array([-0.9762, 1.9704, 1.0907]), np.array([-0.5688, 1.1481, 0.2391])
    _, axis = forward(load_machine("haas_umc750"), in_order("haas_umc750", B=47.137, C=116.354))
    np.testing.assert_allclose(axis[0], (start - end) / np.linalg.norm(start - end), rtol=0, atol=1e-4)


@pytest.mark.parametrize("seed", range(5))
def test_the_ucp800_moves_its_slides_by_the_published_equations(seed: int) -> None:
    random = np.random.default_rng(seed)
    m = random.uniform(-300, 300, 3)
    joined = {"axis": [{"name": name, "point_mm": m.tolist()} for name in "AC"]}
    machine = load_machine("ucp800", joined)
    p = random.uniform(-200, 200, 3)
    a, c = random.uniform(0, 120), random.uniform(-180, 180)
    A, C = np.radians([a, c])
    u = np.array([np.sin(A) * np.sin(C), np.sin(A) * np.cos(C), np.cos(A)])
    dx, dy, dz = p - m
    slides = {
        "X": dx * np.cos(C) - dy * np.sin(C) + m[0],
        "Y": dx * np.cos(A) * np.sin(C) + dy * np.cos(A) * np.cos(C) - dz * np.sin(A) + m[1],
        "Z": dx * np.sin(A) * np.sin(C) + dy * np.sin(A) * np.cos(C) + dz * np.cos(A) + m[2],
    }
    found = inverse(machine, p[None], u[None]).joints[0, 0]
    expected = {"A": a, "C": c, **slides}
    np.testing.assert_allclose(found, [expected[name] for name in machine.names], rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    ("spa", "spc", "axis"),
    [(-54.736, -135.0, (0.57735, -0.57735, 0.57735)), (-45.0, -90.0, (0.70711, 0.0, 0.70711))],
)
def test_the_dmu65_turns_to_the_published_plane_spatial_poses(
    spa: float, spc: float, axis: tuple[float, float, float]
) -> None:
    machine = load_machine("dmu65")
    found = inverse(machine, np.zeros((1, 3)), np.array([axis]))
    # SEQ- takes the negative A, which is branch 1, and the only one inside the travel.
    assert found.joints[1, 0, machine.column("A")] == pytest.approx(spa, abs=1e-3)
    assert found.joints[1, 0, machine.column("C")] == pytest.approx(spc, abs=1e-3)
    a = machine.axis("A")
    assert a.low <= found.joints[1, 0, machine.column("A")] <= a.high
    assert not a.low <= found.joints[0, 0, machine.column("A")] <= a.high


@pytest.mark.parametrize(("a", "c"), [(30.0, 40.0), (-75.0, 200.0), (110.0, -10.0)])
def test_the_tool_axis_of_the_hs664rt_is_turned_by_a_and_then_by_c(a: float, c: float) -> None:
    A, C = np.radians([a, c])
    _, axis = forward(load_machine("hs664rt"), in_order("hs664rt", A=a, C=c))
    np.testing.assert_allclose(axis[0], [np.sin(C) * np.sin(A), -np.cos(C) * np.sin(A), np.cos(A)], atol=1e-15)


@pytest.mark.parametrize(("b", "c"), [(30.0, 40.0), (-11.0, 200.0), (100.0, -10.0)])
def test_the_offset_of_the_mikron_600_shifts_the_slides_as_worked_by_hand(b: float, c: float) -> None:
    dx, dz = -25.0, -60.0
    machine = load_machine("mikron_600u", {"axis": [{"name": "B", "point_mm": [dx, 0, dz]}]})
    p = np.array([40.0, -15.0, 30.0])
    B, C = np.radians([b, c])
    u = np.array([np.sin(B) * np.cos(C), np.sin(B) * np.sin(C), np.cos(B)])
    # Turn the part back by C about its own centre line, then by B about the line through (dx, dz).
    x, y, z = p[0] * np.cos(C) + p[1] * np.sin(C), -p[0] * np.sin(C) + p[1] * np.cos(C), p[2]
    slides = {
        "X": (x - dx) * np.cos(B) - (z - dz) * np.sin(B) + dx,
        "Y": y,
        "Z": (x - dx) * np.sin(B) + (z - dz) * np.cos(B) + dz,
    }
    found = inverse(machine, p[None], u[None]).joints[:, 0]
    branch = found[0 if b > 0 else 1]
    for name, value in slides.items():
        assert branch[machine.column(name)] == pytest.approx(value, abs=1e-9)


def test_a_fork_head_swings_its_tip_about_the_pivot() -> None:
    machine = load_machine("generic_head_head_ca")
    tip, axis = forward(machine, in_order("generic_head_head_ca", A=90.0), tool_length=100.0)
    # The pivot stays at 250 above zero; nose and tool, 350 long, now lie along +Y.
    np.testing.assert_allclose(axis[0], [0.0, -1.0, 0.0], atol=1e-15)
    np.testing.assert_allclose(tip[0], [0.0, 350.0, 250.0], atol=1e-12)


def test_a_nutated_head_lies_down_after_half_a_turn() -> None:
    machine = load_machine("generic_nutated_b45_c")
    _, axis = forward(machine, in_order("generic_nutated_b45_c", B=180.0))
    np.testing.assert_allclose(axis[0], [0.0, -1.0, 0.0], atol=1e-15)


def test_the_yl569_has_its_published_travel_and_speeds() -> None:
    machine = load_machine("yl569")
    assert machine.names == ("C", "B", "X", "Y", "Z")
    assert [axis.mount for axis in machine.axes] == [Mount.PART] * 4 + [Mount.TOOL]
    limits = dict(zip(machine.names, machine.limits.tolist(), strict=True))
    assert limits["B"] == [-11.0, 100.0]
    assert [limits[name] for name in "XYZ"] == [[-250.0, 250.0], [-150.0, 150.0], [-250.0, 250.0]]
    assert machine.axis("C").endless
    assert machine.axis("C").output is AngleOutput.POSITIVE
    assert [machine.axis(name).rapid for name in "XYZBC"] == [5000.0, 5000.0, 5000.0, 5760.0, 9720.0]
    assert machine.spindle_max_rpm == 9000.0
    assert machine.facts.tool_holder == "BT40"


@pytest.mark.parametrize("key", five_axis_machines())
def test_every_shipped_machine_says_what_it_is_and_names_its_control(key: str) -> None:
    machine = load_machine(key)
    assert machine.key == key
    assert machine.name
    assert machine.description
    assert machine.control.keys()


def test_all_the_machines_of_the_published_work_are_shipped() -> None:
    assert {"yl569", "ucp800", "mikron_600u", "hs664rt", "dmu65"} <= set(five_axis_machines())


def test_the_workpiece_zero_moves_coordinates_and_nothing_else() -> None:
    plain, moved = load_machine("yl569"), load_machine("yl569", {"workpiece": {"zero_mm": [10, -20, 35.5]}})
    assert plain.workpiece_zero is None
    values = in_order("yl569", B=20.0, C=70.0, X=5.0)
    tip, axis = forward(plain, values)
    tip_moved, axis_moved = forward(moved, values)
    np.testing.assert_allclose(tip_moved, tip - [10.0, -20.0, 35.5])
    np.testing.assert_array_equal(axis_moved, axis)


def test_the_primary_rotary_axis_is_the_one_that_carries_the_other_or_the_head() -> None:
    named = {key: load_machine(key) for key in five_axis_machines()}
    primary = {key: machine.names[machine.primary] for key, machine in named.items()}
    secondary = {key: machine.names[machine.secondary] for key, machine in named.items()}
    assert (primary["yl569"], secondary["yl569"]) == ("B", "C")
    assert (primary["generic_head_head_ca"], secondary["generic_head_head_ca"]) == ("C", "A")
    assert (primary["generic_head_table_bc"], secondary["generic_head_table_bc"]) == ("B", "C")
