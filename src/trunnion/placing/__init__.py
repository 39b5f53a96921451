"""Placing: where on the table a part may sit, so that no axis leaves its travel.

In:     the rows of a path (``PathRows``), a machine, turns of the part about Z.
Out:    for each turn the places of the workpiece zero at which every slide keeps its limits, and the best of them.
Units:  mm and degrees. Frame: places in the machine frame, all axes at zero, as ``Machine.workpiece_zero`` has them.

With the rotary positions of a row fixed, its slides are linear in the workpiece zero z:

    s = A(q) (tip + z) + d(q)

A limit of a slide is a half-space of z, so the feasible places of one turn, with one choice of branches, are a convex
polyhedron, and the place with the largest margin is a linear program. Of millions of half-spaces few matter: they are
found one by one, as the most violated at the solution without them (cutting planes). What is found is exact, as the
last solution violates none.
"""
