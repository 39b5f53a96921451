"""The published schemas of MTConnect, in their variants for XSD 1.0 (their licence is beside them)."""

import lzma
import re
from functools import cache
from typing import Any

from lxml import etree

from tests.support.locations import TESTS

SCHEMAS = TESTS / "data" / "mtconnect"


@cache
def schema(name: str) -> Any:
    """Return a schema: ``Streams_2.0``, for instance."""
    text = lzma.decompress((SCHEMAS / f"MTConnect{name}_1.0.xsd.xz").read_bytes())
    return etree.XMLSchema(etree.fromstring(text, base_url=str(SCHEMAS / "schema.xsd")))


def schema_faults(document: bytes) -> list[str]:
    """Return what the schema of a document, which its namespace names, has against it."""
    root = etree.fromstring(document)
    named = re.fullmatch(r"\{urn:mtconnect\.org:MTConnect(\w+):([\d.]+)\}MTConnect\1", root.tag)
    assert named is not None
    judge = schema(f"{named[1]}_{named[2]}")
    return [] if judge.validate(root) else [f"{each.line}: {each.message}" for each in judge.error_log]
