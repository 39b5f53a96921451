"""Curves through measured points, mm.

In:     points in their order (``read_point_table`` reads them from a file).
Out:    a cubic ``BSplineCurve``, rational where weights are given, and how far it is off at the points and between.

SciPy (extra ``geometry``) evaluates and solves; what is here says which knots, parameters and ends a curve gets.
"""
