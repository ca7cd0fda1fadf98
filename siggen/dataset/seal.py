"""JSON that carries the SHA-256 of itself: the manifest, the sidecars and run.json of a set."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import Any

from siggen.errors import VerificationError

DIGEST = "digest"


def json_bytes(content: Mapping[str, object]) -> bytes:
    """Return the one way in which a set's JSON files are written."""
    return (json.dumps(content, indent=1, sort_keys=True, ensure_ascii=False) + "\n").encode()


def sealed(content: Mapping[str, Any]) -> bytes:
    """Return JSON that carries the SHA-256 of itself, so that any changed byte shows."""
    return json_bytes({**content, DIGEST: hashlib.sha256(json_bytes(content)).hexdigest()})


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
