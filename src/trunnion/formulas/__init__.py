"""The formulas of a machine: its chain as matrices, and its forward and inverse map, as symbols.

In:     a ``Machine``.
Out:    formulas as text and as LaTeX, a table of their parameters, and how far they are from the maps of
        ``trunnion.machines`` at random poses.
Units:  mm and degrees: ``cos`` takes degrees, and ``atan2`` gives them.

The forward formulas are the product of the chain's matrices, the inverse ones are solved by geometry. Both are written
down from the definition, and share nothing with the kernels that they are compared with. The second subproblem of Paden
and Kahan gives the rotary axes (Murray, Li, Sastry: A Mathematical Introduction to Robotic Manipulation, 3.3.2).
"""
