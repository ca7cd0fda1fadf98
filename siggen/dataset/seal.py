"""JSON that carries the SHA-256 of itself: the manifest of a set, its precision, what a model says of itself."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from typing import Any

from siggen.errors import VerificationError

DIGEST = "digest"

TEXTS_PER_PIECE = 10_000

LINE = re.compile(rb'\n "digest": "([0-9a-f]{64})"(,?)')
"""The entry of the digest at the top: what lies deeper is indented further, and texts have no line breaks."""


def json_bytes(content: Mapping[str, object]) -> bytes:
    """Return the one way in which a set's JSON files are written; any sequence is a list."""
    return b"".join(_pieces(content))


def sealed(content: Mapping[str, Any]) -> bytes:
    """Return JSON that carries the SHA-256 of itself, so that any changed byte shows."""
    return json_bytes({**content, DIGEST: digest_of(content)})


def digest_of(content: Mapping[str, Any]) -> str:
    """Return the digest with which a content is sealed."""
    digest = hashlib.sha256()
    for piece in _pieces(content):
        digest.update(piece)
    return digest.hexdigest()


def _pieces(content: Mapping[str, object]) -> Iterator[bytes]:
    """Yield the JSON in pieces: a manifest has one text per number, far more memory than their bytes."""
    texts = json.JSONEncoder(indent=1, sort_keys=True, ensure_ascii=False, default=_listed).iterencode(content)
    while piece := "".join(islice(texts, TEXTS_PER_PIECE)):
        yield piece.encode()
    yield b"\n"


def _listed(value: object) -> list[object]:
    if isinstance(value, Sequence):
        return list(value)
    raise TypeError(f"a {type(value).__name__} has no JSON")


def unsealed(name: str, content: bytes) -> dict[str, Any]:
    """Return the content of sealed JSON.

    Raises
    ------
    VerificationError
        If it is not JSON, or carries another digest than its own.
    """
    check_seal(name, content)
    try:
        found = dict(json.loads(content))
    except (ValueError, TypeError, RecursionError) as error:
        raise VerificationError(f"{name} is not readable as JSON ({error})") from error
    del found[DIGEST]
    return found


def check_seal(name: str, content: bytes) -> None:
    """Compare the digest that sealed JSON carries with that of all its other bytes, which are not made again for it.

    Raises
    ------
    VerificationError
        If it carries none, or another one.
    """
    line = LINE.search(content)
    if line is None:
        raise VerificationError(f"{name} is not readable as JSON that siggen sealed: it carries no digest of itself")
    before, after = content[: line.start()], content[line.end() :]
    if not line[2]:  # it was the last entry, so the one before it had no comma
        before = before.removesuffix(b",")
    if hashlib.sha256(before + after).hexdigest().encode() != line[1]:
        raise VerificationError(f"{name} was changed: its content does not match its own digest {line[1].decode()}")
