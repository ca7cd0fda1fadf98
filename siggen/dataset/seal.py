"""JSON that carries the SHA-256 of itself: the manifest, the sidecars and run.json of a set."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from typing import Any

from siggen.errors import VerificationError

DIGEST = "digest"

TEXTS_PER_PIECE = 10_000


def json_bytes(content: Mapping[str, object]) -> bytes:
    """Return the one way in which a set's JSON files are written; any sequence is a list."""
    return b"".join(_pieces(content))


def sealed(content: Mapping[str, Any]) -> bytes:
    """Return JSON that carries the SHA-256 of itself, so that any changed byte shows."""
    digest = hashlib.sha256()
    for piece in _pieces(content):
        digest.update(piece)
    return json_bytes({**content, DIGEST: digest.hexdigest()})


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
        If it is not JSON, carries another digest than its own, or is written otherwise than `sealed` writes it.
    """
    try:
        found = dict(json.loads(content))
    except (ValueError, TypeError, RecursionError) as error:
        raise VerificationError(f"{name} is not readable as JSON ({error})") from error
    digest = found.pop(DIGEST, None)
    if sealed(found) != content:
        raise VerificationError(f"{name} was changed: its content does not match its own digest {digest}")
    return found
