"""What can be said to a command, once for the command line, the library, projects and batches.

In:     nothing: what is here is data, and imports no more than messages.
Out:    options with their kinds of values, and the groups of them that commands share.
"""
