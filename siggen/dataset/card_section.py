"""A measured section in the card of a finished set, with the manifest sealed again over the new card."""

from __future__ import annotations

import hashlib
from pathlib import Path

from siggen.dataset.manifest import CARD, MANIFEST, read_manifest
from siggen.dataset.seal import sealed
from siggen.dataset.storage import sha256
from siggen.dataset.storage_at import storage_at
from siggen.errors import VerificationError

BEGIN = "<!-- measured section: begin -->"
END = "<!-- measured section: end -->"
BEFORE = "\n## Columns of `data/`"
"""Where the section goes: behind what the card says about the set's limits."""


def write_card_section(path: Path | str, section: str) -> None:
    """Put a Markdown section into README.md of a set in place of an earlier one, and seal the manifest again.

    Only the card and its hash in the manifest change. A crash between the two leaves a card that `siggen verify` names
    and that the set's own `siggen generate` command makes again.

    Parameters
    ----------
    path : path
        A finished set.
    section : str
        Markdown without the marks around it.

    Raises
    ------
    DatasetError
        If there is no finished set, or another process writes it.
    VerificationError
        If the card is not the one that the manifest promises: sealing it would hide a change.
    """
    storage = storage_at(path)
    read_manifest(storage)  # a folder without a set must not be created by the lock
    with storage.writing():
        manifest = read_manifest(storage)
        promised = manifest.files.get(CARD)
        if promised is None or not storage.exists(CARD) or sha256(storage, CARD) != promised.sha256:
            raise VerificationError(
                f"{storage.location}/{CARD} is not the one that {MANIFEST} promises; "
                "the set's own `siggen generate` command makes it again once the file is deleted"
            )
        card = with_section(storage.get(CARD).decode(), section).encode()
        files = {**manifest.content["files"], CARD: {"bytes": len(card), "sha256": hashlib.sha256(card).hexdigest()}}
        storage.put(CARD, card)
        storage.put(MANIFEST, sealed({**manifest.content, "files": files}))


def with_section(card: str, section: str) -> str:
    """Return the card with the section in place of an earlier one, before the columns, or at its end."""
    start, end = card.find(BEGIN), card.find(END)
    if 0 <= start < end:
        card = card[:start] + card[end + len(END) :].removeprefix("\n\n")
    marked = f"{BEGIN}\n{section.rstrip()}\n{END}\n\n"
    place = card.find(BEFORE)
    if place < 0:
        return f"{card.rstrip()}\n\n{marked}"
    return card[: place + 1] + marked + card[place + 1 :]
