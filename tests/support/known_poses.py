"""Where the shipped machines put their tools, and what their axes are, as plain literal numbers.

The poses were worked out by hand from what is published of each machine, apart from the definitions and their loader:
a sense or a sign that changes anywhere between the file and the maps is noticed, also where everything that writes and
proves a program shares the mistake.
"""

from typing import Final

import numpy as np

from trunnion.machines import Machine, forward
from trunnion.machines.jog_table import rotary_pose

#: Positions of the slides in all poses, and the length of the tool, mm.
SLIDES: Final = {"X": 10.0, "Y": 20.0, "Z": 30.0}
LENGTH: Final = 100.0

#: Half of the last digit of the poses.
_CLOSE: Final = 6e-6

Vector = tuple[float, float, float]

#: Rotary axes in degrees; tip in mm and tool axis in workpiece coordinates.
POSES: Final[dict[str, list[tuple[dict[str, float], Vector, Vector]]]] = {
    # u = Rz(C) Rx(A) z; the third is a published PLANE SPATIAL pose
    "dmu65": [
        ({"A": -30, "C": 0}, (10.0, -17.67949, -70.62178), (0.0, 0.5, 0.86603)),
        ({"A": -30, "C": 90}, (17.67949, 10.0, -70.62178), (-0.5, 0.0, 0.86603)),
        ({"A": -54.736, "C": -135}, (-39.32089, 25.17876, -56.74414), (0.57735, -0.57735, 0.57734)),
    ],
    # a pivot 250 mm above the nose
    "generic_head_head_ca": [
        ({"A": 30, "C": 0}, (10.0, 195.0, -23.10889), (0.0, -0.5, 0.86603)),
        ({"A": 30, "C": 90}, (-165.0, 20.0, -23.10889), (0.5, 0.0, 0.86603)),
        ({"A": -45, "C": -120}, (-204.33035, 143.74369, 32.51263), (0.61237, -0.35355, 0.70711)),
    ],
    # a pivot 180 mm above the nose
    "generic_head_table_bc": [
        ({"B": 30, "C": 0}, (-130.0, 20.0, -32.48711), (0.5, 0.0, 0.86603)),
        ({"B": 30, "C": 90}, (-20.0, -130.0, -32.48711), (0.0, 0.5, 0.86603)),
        ({"B": 90, "C": 200}, (260.55741, 73.55159, 210.0), (-0.93969, -0.34202, 0.0)),
    ],
    # B 180 lays the spindle along -Y
    "generic_nutated_b45_c": [
        ({"B": 180, "C": 0}, (10.0, 270.0, 180.0), (0.0, -1.0, 0.0)),
        ({"B": 90, "C": 0}, (186.7767, 145.0, 55.0), (-0.70711, -0.5, 0.5)),
        ({"B": 90, "C": 60}, (-32.18534, 234.25336, 55.0), (0.07946, -0.86237, 0.5)),
    ],
    # the example of G234 in the manual: u = (sinB cosC, sinB sinC, cosB); the third is its first pose
    "haas_umc750": [
        ({"B": 30, "C": 0}, (-26.33975, 20.0, -65.62178), (0.5, 0.0, 0.86603)),
        ({"B": 30, "C": 90}, (-20.0, -26.33975, -65.62178), (0.0, 0.5, 0.86603)),
        ({"B": 47.137, "C": 116.354}, (1.83568, -48.759, -54.94716), (-0.32538, 0.6568, 0.68025)),
    ],
    # published: u = Rz(C) Rx(A) z
    "hs664rt": [
        ({"A": 30, "C": 0}, (10.0, 52.32051, -50.62178), (0.0, -0.5, 0.86603)),
        ({"A": 30, "C": 90}, (-52.32051, 10.0, -50.62178), (0.5, 0.0, 0.86603)),
        ({"A": 90, "C": 216}, (33.0548, -62.50904, 20.0), (-0.58779, 0.80902, 0.0)),
    ],
    # the kinematics module: B tilts the spindle towards -X
    "linuxcnc_5axis": [
        ({"B": 30, "C": 0}, (185.0, 20.0, -23.10889), (-0.5, 0.0, 0.86603)),
        ({"B": 30, "C": 90}, (10.0, 195.0, -23.10889), (0.0, -0.5, 0.86603)),
        ({"B": -60, "C": -135}, (224.33035, 234.33035, 105.0), (-0.61237, -0.61237, 0.5)),
    ],
    # A negative turns the face of the table to the operator
    "matsuura_mx330": [
        ({"A": -30, "C": 0}, (227.5, 518.67141, 393.36524), (0.0, 0.5, 0.86603)),
        ({"A": -30, "C": 90}, (-518.67141, 227.5, 393.36524), (-0.5, 0.0, 0.86603)),
        ({"A": -90, "C": 200}, (-8.56799, -641.62516, -252.5), (0.34202, -0.93969, 0.0)),
    ],
    # published: u = (sinB cosC, sinB sinC, cosB)
    "mikron_600u": [
        ({"B": 30, "C": 0}, (-26.33975, 20.0, -65.62178), (0.5, 0.0, 0.86603)),
        ({"B": 30, "C": 90}, (-20.0, -26.33975, -65.62178), (0.0, 0.5, 0.86603)),
        ({"B": -90, "C": 200}, (-58.93808, -42.73526, 10.0), (0.93969, 0.34202, 0.0)),
    ],
    # published: u = (sinA sinC, sinA cosC, cosA)
    "ucp800": [
        ({"A": 30, "C": 0}, (10.0, -17.67949, -70.62178), (0.0, 0.5, 0.86603)),
        ({"A": 30, "C": 90}, (-17.67949, -10.0, -70.62178), (0.5, 0.0, 0.86603)),
        ({"A": 90, "C": 200}, (14.54448, 69.19868, -20.0), (-0.34202, -0.93969, 0.0)),
    ],
    # the kinematics module with its offsets
    "xyzac_trt": [
        ({"A": 30, "C": 0}, (10.0, -20.0, -59.28203), (0.0, 0.5, 0.86603)),
        ({"A": 30, "C": 90}, (-20.0, -10.0, -59.28203), (0.5, 0.0, 0.86603)),
        ({"A": -90, "C": 200}, (-43.59894, -90.54906, 10.0), (0.34202, 0.93969, 0.0)),
    ],
    # the kinematics module with its offsets
    "xyzbc_trt": [
        ({"B": 30, "C": 0}, (33.48076, 20.0, -47.6314), (-0.5, 0.0, 0.86603)),
        ({"B": 30, "C": 90}, (20.0, -33.48076, -47.6314), (0.0, 0.5, 0.86603)),
        ({"B": -90, "C": 200}, (63.63654, -44.44536, -45.0), (-0.93969, 0.34202, 0.0)),
    ],
    # published: u = (sinB cosC, sinB sinC, cosB); the third is a block of its published program
    "yl569": [
        ({"B": 30, "C": 0}, (-26.33975, 20.0, -65.62178), (0.5, 0.0, 0.86603)),
        ({"B": 30, "C": 90}, (-20.0, -26.33975, -65.62178), (0.0, 0.5, 0.86603)),
        ({"B": 58.88196, "C": 36.26454}, (-55.98239, -16.26501, -44.73725), (0.69027, 0.5064, 0.5168)),
    ],
}

#: What else the definitions say: each axis from the workpiece to the tool, then the spindle.
FACTS: Final[dict[str, list[str]]] = {
    "dmu65": [
        "C rotary part endless home 0 either none",
        "A rotary part -90..0 home 0 either none",
        "X linear tool -367.5..367.5 home 0 either none",
        "Y linear tool -325..325 home 0 either none",
        "Z linear tool 0..560 home 560 either none",
        "primary A, secondary C, zero None, at most None rpm",
    ],
    "generic_head_head_ca": [
        "X linear part -1500..1500 home 0 either none",
        "Y linear tool -1000..1000 home 0 either none",
        "Z linear tool -600..600 home 0 either none",
        "C rotary tool -360..360 home 0 either none",
        "A rotary tool -110..110 home 0 either none",
        "primary C, secondary A, zero None, at most 24000.0 rpm",
    ],
    "generic_head_table_bc": [
        "C rotary part endless home 0 either none",
        "X linear tool -500..500 home 0 either none",
        "Y linear tool -400..400 home 0 either none",
        "Z linear tool -200..600 home 0 either none",
        "B rotary tool -30..110 home 0 either none",
        "primary B, secondary C, zero None, at most 18000.0 rpm",
    ],
    "generic_nutated_b45_c": [
        "C rotary part endless home 0 either none",
        "X linear tool -500..500 home 0 either none",
        "Y linear tool -400..400 home 0 either none",
        "Z linear tool -200..600 home 0 either none",
        "B rotary tool 0..200 home 0 either none",
        "primary B, secondary C, zero None, at most 18000.0 rpm",
    ],
    "haas_umc750": [
        "C rotary part endless home 0 either none",
        "B rotary part -35..120 home 0 positive none",
        "X linear tool -762..0 home 0 either none",
        "Y linear tool -508..0 home 0 either none",
        "Z linear tool -508..0 home 0 either none",
        "primary B, secondary C, zero None, at most 8100.0 rpm",
    ],
    "hs664rt": [
        "C rotary part endless home 0 either 0..360",
        "A rotary part -110..110 home 0 either none",
        "X linear tool -inf..inf home 0 either none",
        "Y linear tool -inf..inf home 0 either none",
        "Z linear tool -inf..inf home 0 either none",
        "primary A, secondary C, zero None, at most None rpm",
    ],
    "linuxcnc_5axis": [
        "X linear tool -500..500 home 0 either none",
        "Y linear tool -500..500 home 0 either none",
        "Z linear tool -500..100 home 0 either none",
        "C rotary tool endless home 0 either none",
        "B rotary tool -120..120 home 0 either none",
        "primary C, secondary B, zero None, at most None rpm",
    ],
    "matsuura_mx330": [
        "C rotary part endless home 0 either 0..360",
        "A rotary part -125..10 home 0 negative none",
        "X linear tool -435..0 home 0 either none",
        "Y linear tool -465..0 home 0 either none",
        "Z linear tool -560..0 home 0 either none",
        "primary A, secondary C, zero None, at most 15000.0 rpm",
    ],
    "mikron_600u": [
        "C rotary part endless home 0 either none",
        "B rotary part -110..30 home 0 either none",
        "X linear tool -300..300 home 0 either none",
        "Y linear tool -225..225 home 0 either none",
        "Z linear tool 0..450 home 450 either none",
        "primary B, secondary C, zero None, at most 20000.0 rpm",
    ],
    "ucp800": [
        "C rotary part endless home 0 either 0..360",
        "A rotary part -100..120 home 0 either none",
        "X linear tool -inf..inf home 0 either none",
        "Y linear tool -inf..inf home 0 either none",
        "Z linear tool -inf..inf home 0 either none",
        "primary A, secondary C, zero None, at most None rpm",
    ],
    "xyzac_trt": [
        "C rotary part endless home 0 either none",
        "A rotary part -100..50 home 0 either none",
        "X linear part -200..200 home 0 either none",
        "Y linear part -100..100 home 0 either none",
        "Z linear tool -120..120 home 0 either none",
        "primary A, secondary C, zero None, at most None rpm",
    ],
    "xyzbc_trt": [
        "C rotary part endless home 0 either none",
        "B rotary part -110..110 home 0 either none",
        "X linear part -200..200 home 0 either none",
        "Y linear part -100..100 home 0 either none",
        "Z linear tool -120..120 home 0 either none",
        "primary B, secondary C, zero None, at most None rpm",
    ],
    "yl569": [
        "C rotary part endless home 0 either 0..360",
        "B rotary part -11..100 home 0 either none",
        "X linear part -250..250 home 0 either none",
        "Y linear part -150..150 home 0 either none",
        "Z linear tool -250..250 home 0 either none",
        "primary B, secondary C, zero None, at most 9000.0 rpm",
    ],
}


def facts(machine: Machine) -> list[str]:
    """What a definition says besides the geometry of poses, a line for each axis and one for the spindle."""
    lines = [
        f"{axis.name} {axis.kind} {axis.mount} {'endless' if axis.endless else f'{axis.low:g}..{axis.high:g}'} "
        f"home {axis.home:g} {axis.prefer} {axis.output}"
        for axis in machine.axes
    ]
    roles = f"primary {machine.axes[machine.primary].name}, secondary {machine.axes[machine.secondary].name}"
    return [*lines, f"{roles}, zero {machine.workpiece_zero}, at most {machine.spindle_max_rpm} rpm"]


def check_known_poses(machine: Machine) -> None:
    """Fail unless both maps put the tool of a shipped machine where it is known to be."""
    for rotary, tip, axis in POSES[machine.key]:
        values = {**SLIDES, **rotary}
        found_tip, found_axis = forward(machine, np.array([[values[name] for name in machine.names]]), LENGTH)
        pose = rotary_pose(machine, values)
        np.testing.assert_allclose(found_tip[0], tip, rtol=0, atol=_CLOSE)
        np.testing.assert_allclose(found_axis[0], axis, rtol=0, atol=_CLOSE)
        own_tip = np.array(pose.gauge_point) - LENGTH * np.array(pose.tool_axis)
        np.testing.assert_allclose(own_tip, tip, rtol=0, atol=_CLOSE)
        np.testing.assert_allclose(pose.tool_axis, axis, rtol=0, atol=_CLOSE)


def check_facts(machine: Machine) -> None:
    """Fail unless a shipped definition says what it is known to say."""
    assert facts(machine) == FACTS[machine.key]
