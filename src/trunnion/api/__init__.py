"""The public API: post, prove, verify, convert and compare from a script or a notebook.

What ``import trunnion`` offers is implemented here. Functions return records and arrays, raise ``TrunnionError`` with
every problem found, print nothing, end no process, and leave the environment as it is. The command line is a front end
of the same functions.
"""
