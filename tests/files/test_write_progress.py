"""A thread that reads a file while it is written is told when there is no more, and when there never will be."""

import threading

import pytest

from trunnion.files import WriteProgress, WritingStoppedError


def test_whoever_waits_is_told_that_the_writing_has_stopped() -> None:
    progress = WriteProgress()
    told: list[type[BaseException]] = []

    def wait() -> None:
        try:
            progress.wait_for(10)
        except WritingStoppedError as stopped:
            told.append(type(stopped))

    reader = threading.Thread(target=wait)
    reader.start()
    progress.advance(5)
    progress.stop()
    reader.join()
    assert told == [WritingStoppedError]
    with pytest.raises(WritingStoppedError):
        progress.wait_for(1)
    with pytest.raises(WritingStoppedError):
        progress.wait_until_finished()


def test_a_file_that_is_finished_has_no_more() -> None:
    progress = WriteProgress()
    progress.advance(5, 9)
    assert progress.wait_for(5)
    assert progress.expected_size == 9
    progress.finish()
    assert not progress.wait_for(10)
    progress.wait_until_finished()
