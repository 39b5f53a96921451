"""Placing by collisions: where bodies of the spindle's side stay farthest from those of the table's side.

In:     a path, the half-spaces of places that fit, and bodies as hulls.
Out:    the place with the largest least distance, and a bound that no place is above.
Units:  mm and degrees. Places as in ``trunnion.placing``.

With the rotary positions of a moment fixed, a change of the zero only shifts one body against the other, and the
distance of two hulls is a convex function of a shift. So above a cell of places each pair at each moment has a plane
that it stays below (``ceilings``), and a linear program of few of these planes bounds the least distance of all pairs
and moments (``search``). Cells are halved until no bound is above what has been found. What is found at a place is
asked of the whole path (``nearest_moment``).
"""
