"""What a program says against itself, and what it leaves open, where no CL file says what is right.

Most faults are none to who has the program alone. These can be known: cuts without a tool length among cuts with one,
the length of another tool, feeds that no tool stands. What no block says is left open: the check is not made wholly.

In:     a program that was run.
Out:    places of what is wrong, and wordings of what is left open.
"""
