"""The page of all codes, made of their explanations; run as a module, this writes it."""

from typing import Final

from tests.support.locations import DOCS
from trunnion.explanations import SUBJECTS, explanations

PAGE: Final = DOCS / "codes.md"

_HEAD: Final = """# Codes of messages

Every error and warning ends with a code, such as `[CL110]`. It stays the same when the words of the message change, and
`trunnion explain CL110` says what this page says: what it means, why it matters at the machine, and what to do. Checks
are explained by their names: `trunnion explain tip`. `trunnion explain` alone lists everything; `--json` prints it as
data.

## Messages in data

Wherever the data of a command has `remarks`, each has the same keys; `null` where there is no value:

| key | value |
| --- | --- |
| `severity` | `error` or `warning` |
| `code` | one of those below |
| `file`, `line` | where it is; the line counts from 1, and is null if the message is about the whole file |
| `text` | what is wrong |
| `cure` | how to correct it |
| `subject` | what it is about, if not a line: `kind` (`argument`, or `key` of a definition) and `name` |
| `count` | of `simulate`, `convert` and reports: how often it was said; `file` and `line` are those of the first time |
"""


def page() -> str:
    """The page of the docs."""
    text = _HEAD
    for subject, title in SUBJECTS.items():
        text += f"\n## {title}\n"
        for found in explanations().values():
            if found.subject == subject:
                text += f"\n### {found.code}\n\n**{found.title}.** {found.means}\n\n"
                text += f"*At the machine:* {found.matters}\n\n*What to do:* {found.cure}\n"
    return text


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8", newline="\n")
