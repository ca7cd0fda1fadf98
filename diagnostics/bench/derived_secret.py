"""Everything that only the maker of a benchmark knows, derived from one secret: seeds, order, salt.

HMAC-SHA-256 of the secret over words: who knows one result learns nothing of another one, or of the secret. The same
secret makes the same benchmark again.
"""

from __future__ import annotations

import hashlib
import hmac
import secrets
from collections.abc import Iterable
from pathlib import Path

from siggen.errors import UsageError
from siggen.file_writing import write_file

FEWEST_BYTES = 32


def read_secret(file: Path) -> bytes:
    """Return the secret of a file; one that is not there is made, readable by its owner alone.

    Raises
    ------
    UsageError
        If it is shorter than 32 bytes, which could be guessed.
    """
    if not file.exists():
        file.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        write_file(file, _draw)
    found = file.read_bytes().strip()
    if len(found) < FEWEST_BYTES:
        raise UsageError(
            f"{file}: received a secret of {len(found)} bytes; allowed: {FEWEST_BYTES} or more, drawn at random; "
            "remove the file and one is drawn"
        )
    return found


def _draw(draft: Path) -> None:
    draft.touch(mode=0o600)
    draft.write_text(secrets.token_hex(FEWEST_BYTES) + "\n", encoding="ascii")


def derived(secret: bytes, *words: object) -> bytes:
    """Return 32 bytes that follow from the secret and some words."""
    return hmac.new(secret, "/".join(map(str, words)).encode(), hashlib.sha256).digest()


def seed_of(secret: bytes, part: str) -> int:
    """Return the seed of a part, 128 bits: more than can be tried until a draw fits what is published."""
    return int.from_bytes(derived(secret, "seed", part)[:16], "big")


def shuffled(secret: bytes, what: str, ids: Iterable[int]) -> list[int]:
    """Return ids in an order that only the secret tells."""
    return sorted(ids, key=lambda one: derived(secret, what, one))
