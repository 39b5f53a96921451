"""The inverse map: axis values for a tool position, in one closed form for every chain with two rotary axes.

In:     a ``Machine``, tool tips and tool axes in workpiece coordinates.
Out:    displayed axis values, two branches for each row. The planner chooses between them, and between turns.
Units:  mm and degrees; rotary values in (-180, 180].

The form. Let w1 and w2 be the directions of the two rotary axes (w1 next to the workpiece) and s the spindle, all axes
at zero. The tool axis is u = R1 R2 s, so the vector v = R2 s has the same angle to w2 as s, and the same angle to w1 as
u: it is the third corner of a spherical triangle with three known sides,

    A = angle(w1, u)      B = angle(w2, s)      G = angle(w1, w2)

and the half-angle formula gives its corner at w2,

    tan^2(phi/2) = sin(S-B) sin(S-G) / (sin S sin(S-A)),    S = (A + B + G)/2,

on both sides of the great circle through w1 and w2: two branches. Near the pole the formula loses no digits, as an arc
cosine would. The first angle then turns v onto u about w1. With both angles known, the slides solve a 3x3 linear system
whose columns are their directions, each turned by the rotary axes between the slide and the workpiece.

This is the second of the classic subproblems of Paden and Kahan (Murray, Li, Sastry: A Mathematical Introduction to
Robotic Manipulation, 3.3.2) in the form of spherical trigonometry. It shares nothing with
``trunnion.machines.forward``.

Kernels do not raise; they return status bits:

    0                 two solutions, which coincide on the edge of what the rotary axes reach
    UNREACHABLE       no rotary angles give this tool axis; the row is NaN
    POLE              the tool axis is parallel to the first rotary axis; the angle of that axis is free, and 0 here.
                      ``solve_slides`` takes any other angle
    SLIDES_DEPENDENT  the slides are linearly dependent at these angles, and NaN. That is possible only with a rotary
                      axis between slides, such as a quill at 90 degrees
"""

from trunnion.machines.inverse.parameters import (
    REACH_TOLERANCE,
    FlatArray,
    KinematicParameters,
    Pair,
    kinematic_parameters,
)
from trunnion.machines.inverse.rotary import (
    POLE,
    POLE_TOLERANCE,
    UNREACHABLE,
    branch_angles,
    solve_tilt,
)
from trunnion.machines.inverse.slides import SLIDES_DEPENDENT, rotate_about, solve_slides, solve_slides_cos_sin
from trunnion.machines.inverse.solutions import InverseSolutions, inverse, slide_positions, solve_point

__all__ = [
    "POLE",
    "POLE_TOLERANCE",
    "REACH_TOLERANCE",
    "SLIDES_DEPENDENT",
    "UNREACHABLE",
    "FlatArray",
    "InverseSolutions",
    "KinematicParameters",
    "Pair",
    "branch_angles",
    "inverse",
    "kinematic_parameters",
    "rotate_about",
    "slide_positions",
    "solve_point",
    "solve_slides",
    "solve_slides_cos_sin",
    "solve_tilt",
]
