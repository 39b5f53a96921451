"""What a code of a message or a check means: the front door to the explanations."""

from trunnion.definitions.messages import meant_word
from trunnion.errors import InputError, argument_problem
from trunnion.explanations import Explanation, explanations
from trunnion.messages import Wording


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
    near = meant_word(wanted.upper() if any(letter.isdigit() for letter in wanted) else wanted, list(known))
    raise InputError(
        argument_problem(
            "code",
            Wording("ARG110", "no_such_code_but_near", code=repr(wanted), near=near)
            if near
            else Wording("ARG110", "no_such_code", code=repr(wanted)),
        )
    )


def all_explanations() -> tuple[Explanation, ...]:
    """Return every code and check with its explanation, by subject."""
    return tuple(explanations().values())
