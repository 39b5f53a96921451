"""No word of a help text, and none of a message of wrong arguments, changes unseen."""

import json

from tests.support.usage_table import HELPS, MESSAGES, helps, messages


def test_help_texts_are_as_they_were() -> None:
    assert helps() == HELPS.read_text(encoding="utf-8"), "on purpose: python -m tests.support.usage_table"


def test_messages_of_wrong_arguments_are_as_they_were() -> None:
    frozen, now = json.loads(MESSAGES.read_text(encoding="utf-8")), messages()
    changed = {line: (frozen.get(line), now.get(line)) for line in {*frozen, *now} if frozen.get(line) != now.get(line)}
    assert not changed, "on purpose: python -m tests.support.usage_table"
