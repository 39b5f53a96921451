"""The messages that have a cure.

A message is its code and variant. A code stands alone for those of its messages that only its explanation cures.
"""

from trunnion.explanations import explanations
from trunnion.messages import CATALOGUES, CHECKS, catalogue


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
