"""Parts of the text of a program."""

import re


def motion_part(program: bytes) -> list[str]:
    """From the first motion to the end of the path, without block numbers."""
    lines = [re.sub(r"^N\d+ ", "", line) for line in program.decode().splitlines()]
    return lines[lines.index(";Initial Move") : lines.index(";End of Path") + 1]
