"""Settings of a Fanuc: how numbers without a decimal point count."""

from dataclasses import dataclass
from typing import Final

from trunnion.machines import Machine
from trunnion.readers.program.settings import reading_of, unit_of
from trunnion.readers.rs274.block import Block, Number
from trunnion.readers.rs274.word_meanings import NO_WORDS, WordMeanings, read_word_meanings

#: Letters whose whole numbers count in least increments: lengths, and angles.
LENGTHS: Final = "XYZUVWIJKRQ"
ANGLES: Final = "ABC"

#: The least increment of inches as a ratio of that of millimetres; feeds by feed mode and inches; seconds of a dwell.
_INCH_PART: Final = 0.1
_FEEDS: Final = {(94, False): 1.0, (94, True): 0.01, (95, False): 0.01, (95, True): 0.0001}
_SECONDS: Final = 0.001


@dataclass(frozen=True, slots=True)
class Settings:
    """The settings of a control.

    calculator   numbers without a point are millimetres, inches and degrees, not least increments
    unit         mm or inch, as long as a program states none; empty: not known
    increment    the least increment, mm and degrees; a tenth of it for inches
    words        words that the control has in place of the family's
    """

    calculator: bool = False
    increment: float = 0.001
    unit: str = ""
    words: WordMeanings = NO_WORDS

    def length(self, inches: bool) -> float:
        """Return the unit of whole numbers that are lengths, in mm or inches."""
        if self.calculator:
            return 1.0
        return self.increment * _INCH_PART if inches else self.increment

    @property
    def angle(self) -> float:
        """The unit of whole numbers that are angles, degrees."""
        return 1.0 if self.calculator else self.increment

    @property
    def seconds(self) -> float:
        """The unit of whole numbers that are times, seconds."""
        return 1.0 if self.calculator else _SECONDS

    def feed(self, mode: int, inches: bool) -> float:
        """Return the unit of whole numbers that are feeds; 1 for inverse time."""
        return 1.0 if self.calculator else _FEEDS.get((mode, inches), 1.0)

    def scale(self, block: Block, mode: int, inches: bool, *, angles: str = "") -> None:
        """Scale the whole numbers of a block by their units; the letters ``angles`` are angles besides A, B and C."""
        if self.calculator:
            return
        for letter, number in block.words.items():
            if not number.whole:
                continue
            if letter in ANGLES or letter in angles:
                factor = self.angle
            elif letter in LENGTHS:
                factor = self.length(inches)
            elif letter == "F":
                factor = self.feed(mode, inches)
            else:
                continue
            block.words[letter] = Number(number.value * factor)


def settings_of(machine: Machine) -> Settings:
    """Read the settings of a machine's control; InputError if they are wrong."""
    table = reading_of(machine)
    numbers = table.text("whole_numbers", "increments", one_of=("increments", "calculator"))
    increment = table.number("least_increment_mm", 0.001, above=0.0)
    unit = unit_of(table)
    words = read_word_meanings(table)
    table.report_unread_keys()
    table.raise_problems()
    return Settings(numbers == "calculator", increment, unit, words)
