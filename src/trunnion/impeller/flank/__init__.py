"""Flank milling: a blade is cut with the side of the tool, by one sweep of its axis along two B-spline curves.

In:     points and normals of a flank, and a cutter.
Out:    ``FlankPath``, whose swept envelope deviates least from the flank, and by how much it does.
Units:  mm.

``start`` lays the axis, ``fit`` improves it, ``deviations`` says how far what is cut is from the flank, and
``measure`` says the same by other arithmetic.
"""
