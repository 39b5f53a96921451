"""The jobs behind ``import trunnion`` and the command line: a room for each subject.

Functions return records and arrays, raise ``TrunnionError`` with every problem found, print nothing, end no process,
and leave the environment as it is.
"""
