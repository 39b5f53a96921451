"""The post that one writes in an afternoon: ``python benchmarks/naive_post.py FILE.cls FILE.mpf``.

Line by line, no NumPy, nothing clever and nothing clumsy. It writes the motion blocks of the YL569 with TCP on, in the
number style of its control, words that do not change left out; no head and no foot, no limits, no checks.
"""

import math
import sys
from pathlib import Path
from typing import TextIO


def number(value: float) -> str:
    """Five decimals, trailing zeros and a leading zero dropped, the point kept: ``-.31289``, ``20.``, ``0.0``."""
    text = f"{value:.5f}".rstrip("0")
    if text in ("0.", "-0."):
        return "0.0"
    if text.startswith("0."):
        return text[1:]
    if text.startswith("-0."):
        return "-" + text[2:]
    return text


class Post:
    """Writes blocks, and remembers what each word last printed."""

    def __init__(self, out: TextIO) -> None:
        self.out = out
        self.block_number = 0
        self.last: dict[str, str] = {}

    def block(self, words: dict[str, str]) -> None:
        """Write the words that differ from what they last were, as one block."""
        changed = []
        for letter, text in words.items():
            if self.last.get(letter) != text:
                self.last[letter] = text
                changed.append(letter + text)
        if changed:
            self.block_number += 10
            self.out.write(f"N{self.block_number} {' '.join(changed)}\n")

    def run(self, lines: TextIO) -> None:
        """Post a whole CL file."""
        i, j, k = 0.0, 0.0, 1.0
        feed = ""
        rapid = False
        first = True
        for line in lines:
            if line.startswith("GOTO/"):
                values = [float(field) for field in line[5:].split(",")]
                x, y, z = values[:3]
                if len(values) == 6:
                    i, j, k = values[3:]
                b = number(math.degrees(math.acos(k)))
                angle = math.degrees(math.atan2(j, i))
                c = number(angle + 360.0 if angle < 0.0 else angle)
                if c == "360.":
                    c = "0.0"
                if first:  # the rotary axes go to their place before TCP comes on
                    self.block({"G": "0", "B": b, "C": c})
                    del self.last["G"]
                    first = False
                words = {"G": "0" if rapid else "1", "X": number(x), "Y": number(y), "Z": number(z), "B": b, "C": c}
                if not rapid:
                    words["F"] = feed
                self.block(words)
                rapid = False
            elif line.startswith("RAPID"):
                rapid = True
            elif line.startswith("FEDRAT/"):
                feed = number(float(line[7:].split(",")[-1]))


def main() -> int:
    """Run from the command line."""
    if len(sys.argv) != 3:
        print("usage: naive_post.py FILE.cls FILE.mpf", file=sys.stderr)
        return 2
    source, target = map(Path, sys.argv[1:])
    with source.open(encoding="utf-8") as lines, target.open("w", encoding="utf-8", newline="\n") as out:
        Post(out).run(lines)
    return 0


if __name__ == "__main__":
    sys.exit(main())
