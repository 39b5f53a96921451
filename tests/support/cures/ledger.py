"""The list of messages whose cure no table carries out: ``python -m tests.support.cures.ledger`` makes it shorter.

A message is its code and variant. A code stands alone for those of its messages that only its explanation cures.
"""

from typing import Final

from tests.support.cures.cure import messages
from tests.support.cures.tables import TABLES
from tests.support.locations import TESTS
from trunnion.explanations import explanations
from trunnion.messages import CATALOGUES, CHECKS, catalogue

FILE: Final = TESTS / "data" / "cures_not_carried_out.txt"


def all_cures() -> set[tuple[str, str]]:
    """Codes and variants of all messages with a cure; without a variant of codes of which an explanation cures some."""
    texts = {
        (code, variant): "cure" in parts
        for name in (*CATALOGUES.values(), CHECKS)
        for code, variants in catalogue("en", name).items()
        for variant, parts in variants.items()
    }
    cured = {code for code, _ in texts} - {code for (code, _), has_cure in texts.items() if not has_cure}
    explained = {each.code for each in explanations().values() if each.cure}
    return {text for text, has_cure in texts.items() if has_cure} | {(code, "") for code in explained - cured}


def read() -> list[tuple[str, str]]:
    """The list as it is."""
    lines = FILE.read_text(encoding="utf-8").splitlines()
    return [(code, variant) for code, _, variant in (line.partition(" ") for line in lines)]


def main() -> None:
    """Take out what is carried out now, or is no message any more; nothing is ever added."""
    tried = {message for cures in TABLES.values() for message in messages(cures)}
    left = [each for each in read() if each in all_cures() - tried]
    text = "".join(f"{code} {variant}".rstrip() + "\n" for code, variant in left)
    FILE.write_text(text, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
