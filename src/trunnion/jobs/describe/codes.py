"""What a code of a message or a check means: the front door to the explanations."""

from trunnion.definitions.messages import did_you_mean
from trunnion.errors import InputError, argument_problem
from trunnion.explanations import Explanation, explanations


def explain(code: str) -> Explanation:
    """Return what a code of a message, or a check, means.

    Parameters
    ----------
    code
        As messages end with it, with or without brackets, such as ``CL110``; or the name of a check, such as ``tip``.

    Returns
    -------
    Explanation
        In sentences.

    Raises
    ------
    InputError
        If there is none.

    Examples
    --------
    >>> import trunnion
    >>> trunnion.explain("ARG110").title
    'There is no such code'
    """
    known = explanations()
    wanted = str(code).strip().strip("[]")
    found = known.get(wanted) or known.get(wanted.upper()) or known.get(wanted.lower())
    if found is not None:
        return found
    near = did_you_mean(wanted.upper() if any(letter.isdigit() for letter in wanted) else wanted, list(known))
    cure = f"{near + ' ' if near else ''}write a code as messages end with it, or the name of a check"
    raise InputError(argument_problem("code", f"there is no code {wanted!r}", cure, code="ARG110"))


def all_explanations() -> tuple[Explanation, ...]:
    """Return every code and check with its explanation, by subject."""
    return tuple(explanations().values())
