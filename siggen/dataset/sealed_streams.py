"""Arrow streams behind a sealed head: what a run keeps between its tasks, and no finished set has.

A file is sealed JSON, a NUL, then streams one behind the other. The head says for which set, by which code and in which
environment they were made, and carries their hash: whoever finds another one has no use for the file.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import pyarrow as pa

from siggen.columns.versions import SCHEMA_VERSION, SIMULATION_VERSION
from siggen.dataset.seal import sealed, unsealed
from siggen.dataset.storage import Storage
from siggen.errors import DatasetError, VerificationError

END_OF_HEAD = b"\0"
HEAD_BYTES = 1 << 20
"""Most that is read of a file to know what it holds."""

UNUSABLE = (DatasetError, VerificationError, LookupError, TypeError, ValueError, pa.ArrowException)
"""What reading a file raises that is missing, not whole, or made by somebody else."""


@dataclass(frozen=True, slots=True)
class Maker:
    """What makes the bytes of a row; files of another maker are of no use."""

    identity: str
    fingerprint: str
    environment: Mapping[str, str]

    def facts(self) -> dict[str, object]:
        """Return them with the versions of the files, as a head carries them."""
        versions = {"schema_version": SCHEMA_VERSION, "simulation_version": SIMULATION_VERSION}
        return {**versions, **asdict(self), "environment": dict(self.environment)}


def sealed_streams(maker: Maker, about: Mapping[str, object], streams: bytes) -> bytes:
    """Return the content of a file."""
    sha256 = hashlib.sha256(streams).hexdigest()
    return sealed({**maker.facts(), **about, "sha256": sha256}) + END_OF_HEAD + streams


def read_streams(storage: Storage, name: str, maker: Maker) -> tuple[Mapping[str, Any], bytes]:
    """Return head and streams of a file.

    Raises
    ------
    one of UNUSABLE
    """
    head, _, streams = storage.get(name).partition(END_OF_HEAD)
    facts = _of_maker(unsealed(name, head), maker)
    if hashlib.sha256(streams).hexdigest() != facts["sha256"]:
        raise ValueError(f"{name} is not whole")
    return facts, streams


def read_head(storage: Storage, name: str, maker: Maker) -> Mapping[str, Any]:
    """Return the head of a file alone.

    Raises
    ------
    one of UNUSABLE
    """
    with storage.open(name) as file:
        head, end, _ = file.read(HEAD_BYTES).partition(END_OF_HEAD)
    if not end:
        raise ValueError(f"{name} has no head")
    return _of_maker(unsealed(name, head), maker)


def _of_maker(facts: Mapping[str, Any], maker: Maker) -> Mapping[str, Any]:
    if any(facts.get(key) != value for key, value in maker.facts().items()):
        raise ValueError("of another maker")
    return facts
