"""The messages that have a cure.

A message is its code and variant. A code stands alone for those of its messages that only its explanation cures.
"""

from trunnion.explanations import explanations
from trunnion.messages import CATALOGUES, CHECKS, catalogue


def _texts() -> dict[tuple[str, str], bool]:
    """Codes and variants of all messages, and whether they have a cure."""
    return {
        (code, variant): "cure" in parts
        for name in (*CATALOGUES.values(), CHECKS)
        for code, variants in catalogue("en", name).items()
        for variant, parts in variants.items()
    }


def all_messages() -> set[tuple[str, str]]:
    """Codes and variants of all messages, and the codes alone of those with an explanation."""
    return {*_texts(), *((each.code, "") for each in explanations().values())}


def all_cures() -> set[tuple[str, str]]:
    """Codes and variants of all messages with a cure; without a variant of codes of which an explanation cures some."""
    texts = _texts()
    cured = {code for code, _ in texts} - {code for (code, _), has_cure in texts.items() if not has_cure}
    explained = {each.code for each in explanations().values() if each.cure}
    return {text for text, has_cure in texts.items() if has_cure} | {(code, "") for code in explained - cured}
