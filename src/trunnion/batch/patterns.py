"""Patterns of names: ``*`` and ``?`` within a folder or a file's name, ``**`` for any number of folders, at the end
with all files in them."""

from fnmatch import fnmatchcase

from trunnion.messages import Wording, phrase

#: Characters of a pattern.
_MOST = 1000


def pattern_fault(pattern: str) -> Wording | None:
    """Return what is wrong with a pattern; None if it can be used.

    >>> str(pattern_fault("../*.cls")), pattern_fault("parts/**/*.cls")
    ('leads out of the folder', None)
    """
    parts = pattern.split("/")
    if not pattern or len(pattern) > _MOST:
        return phrase("empty") if not pattern else phrase("too_long")
    if pattern.startswith("/") or ".." in parts or "\\" in pattern or ":" in parts[0]:
        return phrase("leads_out_of_folder")
    return phrase("two_side_side") if "" in parts else None


def matches(name: str, pattern: str) -> bool:
    """Whether the name of a file, with ``/``, is one of a pattern. Takes a time that grows with both lengths.

    >>> matches("a/b/x.cls", "**/*.cls"), matches("x.cls", "**/*.cls"), matches("a/x.cls", "*.cls")
    (True, True, False)
    """
    parts = name.split("/")
    reached = {0}
    sought = pattern.removeprefix("./").split("/")
    for each in [*sought, "*"] if sought[-1] == "**" else sought:
        if each == "**":
            reached = set(range(min(reached, default=len(parts)), len(parts)))
        else:
            reached = {k + 1 for k in reached if k < len(parts) and fnmatchcase(parts[k], each)}
    return len(parts) in reached
