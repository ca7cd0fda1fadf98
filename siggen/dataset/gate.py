"""The gate through which every manifest and sidecar comes, whoever wrote it: sealed JSON in, typed facts out.

A seal shows accidents, not intent: anybody can change a manifest and seal it again. So types, ranges and names are
checked before anything is done with them, and how they fit together. What the files hold is checked when one is read;
nothing here touches them.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import cache, partial
from typing import Any, TypeVar

from pydantic import TypeAdapter, ValidationError

from siggen.columns.versions import SCHEMA_VERSION
from siggen.dataset.inventory import Inventory, SidecarFacts
from siggen.dataset.object_name import CHECKSUMS, INDEX, data_name, internals_name, sidecar_name
from siggen.dataset.seal import DIGEST, check_seal
from siggen.errors import DatasetError, VerificationError

SHOWN_PROBLEMS = 3
SHOWN_CHARACTERS = 60
MOST_SAMPLES = 2**31

Facts = TypeVar("Facts", Inventory, SidecarFacts)
ADAPTERS: Mapping[type, Callable[[], TypeAdapter[Any]]] = {
    kind: cache(partial(TypeAdapter, kind)) for kind in (Inventory, SidecarFacts)
}
"""Each is built when the first of its files is read."""


def manifest_facts(name: str, stored: bytes) -> Inventory:
    """Return what a manifest says.

    Raises
    ------
    DatasetError
        If a version of siggen with other files wrote it.
    VerificationError
        If it was changed after it was sealed, or says what no set can be.
    """
    check_seal(name, stored)
    try:
        content = json.loads(stored)
    except (ValueError, RecursionError) as error:
        raise VerificationError(f"{name} is not readable as JSON ({error})") from error
    version = content.get("schema_version")
    if isinstance(version, str) and version != SCHEMA_VERSION:
        raise DatasetError(
            f"{name}: received schema version {version[:20]}; allowed is {SCHEMA_VERSION}. Another version of siggen "
            "wrote the set: open it with that version, or generate it again from its config.yaml into a new folder"
        )
    facts = _typed(Inventory, name, stored)
    _refuse(name, list(_unfit(facts)))
    del content[DIGEST]
    return replace(facts, content=content)


def sidecar_facts(name: str, stored: bytes) -> SidecarFacts:
    """Return what the sidecar of this object name says.

    Raises
    ------
    VerificationError
        If it was changed after it was sealed, or says what no shard can be.
    """
    check_seal(name, stored)
    facts = _typed(SidecarFacts, name, stored)
    internals = "" if facts.internals is None else facts.internals.name
    _refuse(name, list(_unfit_shard(facts.shard, facts.split, facts.data.name, internals)))
    if sidecar_name(facts.shard) != name:
        raise VerificationError(f"{name}: shard: received {facts.shard}; allowed: the shard that the file is named by")
    return facts


def _typed(kind: type[Facts], name: str, stored: bytes) -> Facts:
    try:
        typed: Facts = ADAPTERS[kind]().validate_json(stored, strict=True)
        return typed
    except ValidationError as error:
        problems = [
            f"{'.'.join(str(part)[:SHOWN_CHARACTERS] for part in one['loc']) or 'the whole'}: received "
            f"{repr(one['input'])[:SHOWN_CHARACTERS]}; {_allowed(one['msg'])}"
            for one in error.errors(include_url=False)
        ]
    _refuse(name, problems)
    raise AssertionError("pydantic names at least one problem")


def _allowed(message: str) -> str:
    """Return what pydantic says in the words of siggen."""
    own, should_be = message.removeprefix("Value error, "), "Input should be "
    return f"allowed: {own.removeprefix(should_be)}" if own.startswith(should_be) else own


def _refuse(name: str, problems: list[str]) -> None:
    if problems:
        more = f"; and {len(problems) - SHOWN_PROBLEMS} more" if len(problems) > SHOWN_PROBLEMS else ""
        raise VerificationError(f"{name}: {'; '.join(problems[:SHOWN_PROBLEMS])}{more}")


def _unfit(facts: Inventory) -> Iterator[str]:
    """Yield how a manifest contradicts itself; `shard_index` compares it with the shards."""
    for name in (INDEX, CHECKSUMS):
        if name not in facts.files or facts.files[name].crc32_per_64_kib is None:
            yield f"files: received none named {name} with checksums of its blocks; every finished set has it"
    if not facts.splits or sum(split.rows for split in facts.splits.values()) != facts.rows:
        yield f"rows: received {facts.rows}; allowed: those of all splits, of which there is at least one"
    if not facts.channels or len({channel.column for channel in facts.channels}) != len(facts.channels):
        yield "channels: received none, or two of one column; allowed: every channel once"
    if facts.fs_hz * facts.duration_s > MOST_SAMPLES:
        yield f"duration_s: received {facts.duration_s:g}; allowed: at most {MOST_SAMPLES} samples"


def _unfit_shard(shard: str, split: str, data: str, internals: str) -> Iterator[str]:
    """Yield how the files of a shard are not where its name says."""
    if shard.rpartition("-")[0] != split:
        yield f"{shard}: split: received {split}; allowed: the one in its name"
    if data != data_name(shard):
        yield f"{shard}: received the file {data[:SHOWN_CHARACTERS]}; allowed: {data_name(shard)}"
    if internals and internals != internals_name(shard):
        yield f"{shard}: received the file {internals[:SHOWN_CHARACTERS]}; allowed: {internals_name(shard)}"
