"""The page of all data is what the records say."""

from tests.support.data_page import PAGE, page


def test_the_page_is_made_of_the_records() -> None:
    assert PAGE.read_text(encoding="utf-8") == page(), "python -m tests.support.data_page writes it"
