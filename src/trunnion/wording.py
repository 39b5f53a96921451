"""Parts of sentences that messages of all layers share."""


def counted(count: int, thing: str) -> str:
    """Return a number of things in words; ``thing`` is the singular of a noun with a regular plural.

    >>> counted(1, "check"), counted(3, "check")
    ('1 check', '3 checks')
    """
    return f"{count} {thing}" + ("" if count == 1 else "s")
