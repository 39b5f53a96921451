"""The check lines that ``trunnion post`` prints for every program."""

import re

_PASSED = re.compile(
    r"^(?:[a-z]+ +(?:ok|not checked) +|Passed(?: in part)?: |[a-z, ]+: not measured: ).*\n", re.MULTILINE
)
_UNSTATED = re.compile(r"^\w+: warning: (?:travel|home) of [XYZABC, ]+ is (?:not stated|assumed).*\n", re.MULTILINE)
_OF_BUILDER = re.compile(r"^.* belongs to the machine: what it does is not known; .*\n", re.MULTILINE)


_ENTERED = re.compile(
    r"^.*radius compensation(?: of tool .*: enter |: the path is read as programmed, and the tool centre ).*\n",
    re.MULTILINE,
)


def unproven(err: str) -> str:
    """The stderr of ``trunnion post`` without the lines of checks that found nothing, of which there must be some.

    Warnings about what the machine's definition leaves open, or does not declare, are left out too, and what to enter
    for radius compensation, beside whose path the tool centre goes.
    """
    left, count = _PASSED.subn("", _ENTERED.sub("", err))
    assert count >= 10, err
    return _OF_BUILDER.sub("", _UNSTATED.sub("", left))
