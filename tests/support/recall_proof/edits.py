"""Edits that harm a program, one at a time, each by a rule that reads the text alone.

The rules know what a program says before the place of the edit: coordinates, feed, spindle and coolant that are in
force. They leave out an edit that would change nothing there, such as the other sign of 0, and never ask a reader.
"""

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

from tests.support.recall_proof.languages import LANGUAGES, Language
from tests.support.recall_proof.straight_rapids import is_on_rapid_way, is_said_again, returns_on_the_way
from tests.support.recall_proof.straight_ways import is_near_straight_way, is_on_straight_way

_AXES = "XYZABC"
_WORD = re.compile(r"(?<![A-Z_$=(,.\d\"])([XYZABC])([-+]?\d*\.?\d+|[-+]?\d+\.)(?![\w.(])")
_NUMBER = re.compile(r"^(N?\d+)( )")

#: Insertions that show only where an arc follows.
_BEFORE_ARCS = {"another plane of arcs"}
#: Words that stay in force, so that only a program without any of them lacks them.
_THROUGHOUT = {"no work offset", "no length"}
#: Insertions that show only where numbers are not 0, or differ from where the axis is.
_SCALING = {"inches in the cut", "a mirror in the cut", "a scale in the cut"}


@dataclass(frozen=True)
class Edit:
    """A kind of edit, the line of the block it is at (from 1), and what makes the text with it."""

    kind: str
    line: int
    content: str | Callable[[], str]  # few of all edits are judged

    @property
    def text(self) -> str:
        """The program with it."""
        return self.content if isinstance(self.content, str) else self.content()


@dataclass
class Block:
    """A line, its code, and what is in force before it.

    cuts           it moves at feed
    rapids         it moves at rapid
    way            sense of the arcs in force in it: 1 counter-clockwise, -1 clockwise, 0 none
    line_in_force  G1 was said before it, and nothing else since; ``arc_in_force`` G2 or G3
    compensated    the radius of the tool is, before it
    """

    line: str
    code: str
    before: dict[str, float] = field(default_factory=dict)
    cuts: bool = False
    rapids: bool = False
    spindle: bool = False
    coolant: bool = False
    feed: str = ""
    cycle: bool = False
    tcp: bool = False
    plane: bool = False
    way: int = 0
    line_in_force: bool = False
    arc_in_force: bool = False
    compensated: bool = False

    @property
    def words(self) -> list[re.Match[str]]:
        """Its coordinates."""
        return list(_WORD.finditer(self.code))


def blocks_of(text: str, language: Language) -> list[Block]:
    """The lines of a program with what is in force before each of them."""
    found, at, moving, feed, spindle, coolant = list[Block](), dict[str, float](), "", "", False, False
    tcp = plane = cycle = compensated = incremental = False
    verb = ""
    for line in text.splitlines():
        code = re.sub(language.comment, lambda match: " " * len(match[0]), line)
        incremental = (re.findall(r"\bG9([01])(?![\d.])", code) or ["1" if incremental else "0"])[-1] == "1"
        if incremental:
            at.clear()  # a coordinate is no place then
        block = Block(line, code, dict(at), spindle=spindle, coolant=coolant, feed=feed, tcp=tcp, plane=plane)
        block.line_in_force, block.arc_in_force, block.compensated = verb == "1", verb in ("2", "3"), compensated
        verb = (re.findall(r"\bG0?([0123])(?![\d.])", code) or [verb])[-1]
        block.way = {"2": -1, "3": 1}.get(verb, 0)
        for side in re.findall(r"\bG4([012])\b|\bR([0LR])\b", code):
            compensated = "".join(side) != "0"
        if re.search(r"\bG8[1-9]\b|\bG73\b|\bG74\b", code):
            cycle = True
        elif re.search(r"\bG80\b", code):
            cycle = False
        block.cycle = cycle
        tcp = (tcp or bool(re.search(language.tcp, code))) and not re.search(language.no_tcp, code)
        plane = (plane or bool(re.search(language.plane, code))) and not re.search(language.no_plane, code)
        away = re.search(language.away, code) is not None or re.search(language.pole, code) is not None
        if re.search(language.feed, code):
            moving = "feed"
        if re.search(language.rapid, code):
            moving = "rapid"
        linear = [word for word in block.words if word[1] in "XYZ"]
        if linear and not away:
            block.cuts, block.rapids = moving == "feed", moving == "rapid"
        for word in block.words if not re.search(language.pole, code) else ():
            if away:
                at.pop(word[1], None)
            else:
                at[word[1]] = float(word[2])
        if incremental or re.search(r"\bCP\b", code):
            at.clear()  # polar positions go elsewhere
        for letter in re.findall(r"\bI([XYZABC])[-+]?\d", code):
            at.pop(letter, None)
        if (feeds := re.findall(r"\bF(\d+\.?\d*)", code)) and not re.search(r"\bG0?4\b", code):
            feed = feeds[-1]
        for word in re.findall(r"\bM0?([345789])(?!\d)", code):
            spindle = word in "34" if word in "345" else spindle
            coolant = word in "78" if word in "789" else coolant
        found.append(block)
    return found


def harmful(text: str, family: str, tolerance: float = 0.0) -> Iterator[Edit]:
    """Yield every edit that harms a program; ``tolerance`` is that of the work, mm."""
    language = LANGUAGES[family]
    blocks = blocks_of(text, language)
    yield from _orders(blocks, language, tolerance)
    for maker in (_numbers, _inserted, _replaced, _cut_words, _dropped, _skipped):
        yield from maker(blocks, language)


def with_lines(blocks: list[Block], at: int, *lines: str, end: int | None = None) -> Callable[[], str]:
    """What makes the text with other lines in place of one, or of those before ``end``."""
    after = at + 1 if end is None else end
    return lambda: "\n".join([*(b.line for b in blocks[:at]), *lines, *(b.line for b in blocks[after:])]) + "\n"


def _changed(block: Block, word: re.Match[str], text: str) -> str:
    return block.line[: word.start()] + text + block.line[word.end() :]


def _numbers(blocks: list[Block], language: Language) -> Iterator[Edit]:
    for k, block in enumerate(blocks):
        if not (block.cuts or block.rapids):
            continue
        for word in block.words:
            letter, number = word[1], word[2]
            value = float(number)
            changed = {
                "a sign": f"{-value:.3f}" if value else "",
                "a tenth more": f"{value + 0.1:.3f}",
                # Three places behind the point are what a control that counts increments reads without it.
                "a decimal point": number.replace(".", "") if re.search(r"\.\d(?!\d\d$)", number) else "",
                "a digit": re.sub(r"\d", "", number, count=1) if len(number.strip("+-.").split(".")[0]) > 1 else "",
            }
            for what, new in changed.items():
                if (
                    new
                    and abs(float(new) - value) > 0.01
                    and not (letter == "C" and abs(float(new) - value) % 360 == 0)
                    and not (is_on_straight_way(blocks, k, {}) and is_on_straight_way(blocks, k, {letter: float(new)}))
                    and not (letter == "Z" and is_on_rapid_way(blocks, k, language, float(new)))
                    and not is_said_again(blocks, k, letter)
                ):
                    sign = "+" if number[0] in "+-" and new[0] not in "+-" else ""
                    yield Edit(
                        f"{letter}: {what}", k + 1, with_lines(blocks, k, _changed(block, word, letter + sign + new))
                    )
            known = block.before.get(letter)
            moves = known is not None and abs(known - value) > 0.01 and not re.search(language.arc, block.code)
            if moves and not _is_passed(blocks, k, language, {letter: known or 0.0}):
                yield Edit(f"{letter}: left out", k + 1, with_lines(blocks, k, _changed(block, word, "")))
        x, y = (next((w for w in block.words if w[1] == letter), None) for letter in "XY")
        if x and y and abs(float(x[2]) - float(y[2])) > 0.01 and x.end() < y.start():
            line = block.line[: x.start()] + "X" + y[2] + block.line[x.end() : y.start()] + "Y" + x[2]
            yield Edit("X and Y exchanged", k + 1, with_lines(blocks, k, line + block.line[y.end() :]))
        for word in re.finditer(r"\b([IJ])([-+]?\d+\.?\d*)", block.code):
            if block.cuts and re.search(language.arc, block.code):
                new = f"{word[1]}{float(word[2]) + 1.0:.3f}"
                yield Edit("the centre of an arc", k + 1, with_lines(blocks, k, _changed(block, word, new)))


def _is_passed(blocks: list[Block], k: int, language: Language, start: dict[str, float]) -> bool:
    """Whether the way to the next point leads through that of a block, which then need not be said."""
    if "Z" in start and is_on_rapid_way(blocks, k, language):
        return True
    return is_on_straight_way(blocks, k, {}) and is_on_straight_way(blocks, k, start)


def _orders(blocks: list[Block], language: Language, tolerance: float) -> Iterator[Edit]:
    for k, block in enumerate(blocks):
        moves = any(abs(float(w[2]) - block.before.get(w[1], 9e9)) > 0.01 for w in block.words)
        if block.cuts and moves:
            if not is_on_straight_way(blocks, k) and not is_near_straight_way(blocks, k, tolerance):
                yield Edit("a cut left out", k + 1, with_lines(blocks, k))
            following = blocks[k + 1] if k + 1 < len(blocks) else None
            centre = " CC " in block.code or (following is not None and " CC " in following.code)
            if following and following.cuts and not centre and _code(following) != _code(block):
                text = with_lines(blocks, k, following.line, block.line, end=k + 2)
                yield Edit("two cuts exchanged", k + 1, text)
        elif (
            block.rapids
            and moves
            and not is_on_rapid_way(blocks, k, language)
            and not is_near_straight_way(blocks, k, tolerance)
        ):
            yield Edit("a rapid left out", k + 1, with_lines(blocks, k))


def _code(block: Block) -> str:
    return _NUMBER.sub("", block.code).strip()


def numbered(block: Block, text: str) -> list[str]:
    """Lines with block numbers as the language wants them: those of the next block, which nobody jumps to."""
    number = _NUMBER.match(block.line)
    if number is None:
        return text.replace("{n} ", "").split("\n")
    name = "N1" if number[1].startswith("N") else number[1]
    first, *others = text.split("\n")
    return [f"{name} {first}", *(each.replace("{n}", name) for each in others)]


def _inserted(blocks: list[Block], language: Language) -> Iterator[Edit]:
    for k, block in enumerate(blocks):
        if not block.cuts or re.match(r"^\d+ C", block.code):
            continue
        values = {word[1]: float(word[2]) for word in block.words}
        said = [word for each in blocks[:k] for word in re.findall(r"\bG4[012]\b|\bR[0LR]\b", each.code)]
        compensated = bool(said) and said[-1] not in ("G40", "R0")
        for kind, text in language.inserted.items():
            is_arc = re.search(language.arc, block.code) is not None
            stands = any(abs(block.before.get(letter, 0.0)) > 0.01 for letter in values if letter in "XYZ")
            shows = {
                **dict.fromkeys(_BEFORE_ARCS, is_arc),
                **dict.fromkeys(_SCALING, abs(values.get("X", 0.0)) > 0.01),
                "incremental from here": stands,
                "coolant off in the cut": block.coolant,
                "a lift in the cut": "Z" not in values,
                "home in the cut": "Z" not in values and not block.cycle,
                "a jump home in the cut": "Z" not in values and not block.cycle,
                "a rotation in the cut": bool({"X", "Y"} & values.keys()),
                "another feed in the cut": not re.search(r"\bF\d", block.code),
                "another speed in the cut": not re.search(r"\bS\d", block.code),
                "compensation in the cut": not is_arc and not compensated,
                "an offset over another": "X" in values and abs(block.before.get("X", 9e9)) > 0.01,
                "a shift in the cut": "X" in values,
                "the spindle stops in the cut": block.spindle,
                "the spindle turns back in the cut": block.spindle,
                "TCP off in the cut": block.tcp,
                "the plane off in the cut": block.plane,
            }.get(kind, True)
            if shows:
                yield Edit(kind, k + 1, with_lines(blocks, k, *numbered(block, text), block.line))


def _scaled(operation: str, number: str) -> str:
    """A number that is another one: ``+1``, ``-1``, ``*2``, ``/10``."""
    value, by = float(number), float(operation[1:])
    new = {"+": value + by, "-": value - by, "*": value * by, "/": value / by}[operation[0]]
    if re.fullmatch(r"\d+", number) and new == int(new):
        return str(int(new))
    return f"{new:+.4f}" if number[0] in "+-" and number[0] == "+" else f"{new:.4f}"


def _other(match: re.Match[str], new: str) -> str:
    """What takes the place of what was found."""
    if re.fullmatch(r"[-+*/][\d.]+", new):
        groups = [each for each in match.groups() if each is not None]
        return match[0][: len(match[0]) - len(groups[-1])] + _scaled(new, groups[-1])
    if "~" in new:
        return new.replace("~", {"2": "3", "3": "2", "+": "-", "-": "+"}[match[1]])
    return match.expand(new)


def _substituted(block: Block, pattern: str, new: str) -> Iterator[str]:
    for match in re.finditer(pattern, block.code):
        text = _other(match, new)
        if text != match[0]:
            yield block.line[: match.start()] + text + block.line[match.end() :]


def _replaced(blocks: list[Block], language: Language) -> Iterator[Edit]:
    for kind, (pattern, new) in language.replaced.items():
        for k, block in enumerate(blocks):
            if kind == "rapid at feed" and not block.rapids:
                continue
            if kind == "feed by time" and not any(re.search(r"\bF\d", each.code) for each in blocks):
                continue  # threads alone have their feed by their pitch
            if kind == "feed by time" and not any(
                each.cuts or each.cycle or "CYCLE" in each.code for each in blocks[k + 1 :]
            ):
                continue  # nothing is cut by it, and the end of the program lifts it
            if kind == "back to another height" and returns_on_the_way(blocks, k):
                continue
            if kind in ("a tenth of the feed", "ten times the feed") and _is_before_own_feed(blocks, k):
                continue
            for line in _substituted(block, pattern, new):
                yield Edit(kind, k + 1, with_lines(blocks, k, line))


def _is_before_own_feed(blocks: list[Block], k: int) -> bool:
    """Whether a feed stands alone before a cycle that has its own."""
    return not blocks[k].words and any(re.search(r"CYCLE8[45]\(", block.code) for block in blocks[k : k + 2])


def _cut_words(blocks: list[Block], language: Language) -> Iterator[Edit]:
    for kind, (pattern, new) in language.cut_word.items():
        for k, block in enumerate(blocks):
            if not block.cuts and not re.search(language.arc, block.code):
                continue
            if kind == "a coordinate counts from here" and all(
                abs(block.before.get(w[1], 0.0)) < 0.01 for w in block.words[:1]
            ):
                continue
            for line in list(_substituted(block, pattern, new))[:1]:
                yield Edit(kind, k + 1, with_lines(blocks, k, line))


def _dropped(blocks: list[Block], language: Language) -> Iterator[Edit]:
    text = "\n".join(block.line for block in blocks) + "\n"
    for kind, pattern in language.dropped.items():
        if kind in _THROUGHOUT:
            without = re.sub(pattern, "", text, flags=re.MULTILINE)
            if without != text:
                yield Edit(kind, 1, without)
            continue
        pole = ""
        for k, block in enumerate(blocks):
            match = re.search(pattern, block.code, re.MULTILINE)
            if match is None or (kind == "no start of the spindle" and block.spindle):
                continue
            if kind == "no coolant" and block.coolant:
                continue
            following = next((b.code for b in blocks[k + 1 :] if b.words), "")
            next_line = blocks[k + 1].code if k + 1 < len(blocks) else ""
            if kind == "no end of the cycle" and re.search(
                r"\bG0?[01]\b|\bG[78]\d\b|\bMCALL\b", f"{following} {next_line}"
            ):
                continue
            if kind == "no centre" and match[0].split(" ", 1)[1] == pole:
                continue
            pole = match[0].split(" ", 1)[1] if kind == "no centre" else pole
            line = block.line[: match.start()] + block.line[match.end() :]
            yield Edit(kind, k + 1, with_lines(blocks, k, line) if line.strip() else with_lines(blocks, k))


def _skipped(blocks: list[Block], language: Language) -> Iterator[Edit]:
    for k, block in enumerate(blocks):
        kinds = {
            "a cut that may be skipped": block.cuts and not is_on_straight_way(blocks, k),
            "a rapid that may be skipped": block.rapids and not is_on_rapid_way(blocks, k, language),
            "a start of the spindle that may be skipped": not block.spindle and re.search(r"\bM0?3\b", block.code),
            "coolant that may be skipped": not block.coolant and re.search(r"\bM0?[78]\b", block.code),
            "a tool change that may be skipped": re.search(r"\bM0?6\b|\bTOOL CALL \d|\bM306\b", block.code),
            "a length that may be skipped": re.search(r"\bG43\b|\bG43\.4\b|\bG234\b", block.code),
            "an end of the spindle that may be skipped": block.spindle and re.search(r"\bM0?5\b", block.code),
        }
        for kind, is_so in kinds.items():
            if is_so:
                yield Edit(kind, k + 1, with_lines(blocks, k, language.skip + block.line))
