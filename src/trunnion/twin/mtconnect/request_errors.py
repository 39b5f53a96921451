"""What an agent refuses, as its document of errors says it."""

from http import HTTPStatus


class RequestError(Exception):
    """A request that is not answered as it was meant: code of the standard, a sentence, and the status of HTTP."""

    def __init__(self, code: str, text: str, status: HTTPStatus = HTTPStatus.BAD_REQUEST) -> None:
        super().__init__(text)
        self.code, self.text, self.status = code, text, status


def out_of_range(text: str) -> RequestError:
    """Return the refusal of a number beyond what is kept."""
    return RequestError("OUT_OF_RANGE", text, HTTPStatus.NOT_FOUND)


def invalid(text: str) -> RequestError:
    """Return the refusal of a request that cannot be understood."""
    return RequestError("INVALID_REQUEST", text)
