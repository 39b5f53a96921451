"""The builder: a page in which a shop fills in what it knows of its machine, and sees what comes of it.

In:     a definition, or a machine to start from.
Out:    a definition that is saved where the user says so. Fields and text are two views of the same TOML
        (``document``); each change is judged (``draft``), and a sample program is posted and proven (``sample``).
"""
