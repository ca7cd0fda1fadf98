"""The gate through which every manifest comes, whoever wrote it: sealed JSON in, typed facts out.

A seal shows accidents, not intent: anybody can change a manifest and seal it again. So types, ranges and names are
checked before anything is done with them, and how they fit together. What the files hold is checked when one is read;
nothing here touches them.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from itertools import pairwise

from pydantic import TypeAdapter, ValidationError

from siggen.columns.versions import SCHEMA_VERSION
from siggen.dataset.inventory import Inventory, ListedShard
from siggen.dataset.object_name import DAMAGE, LABELS, SPLITS
from siggen.dataset.seal import DIGEST, check_seal
from siggen.errors import DatasetError, VerificationError

SHOWN_PROBLEMS = 3
SHOWN_CHARACTERS = 60
MOST_SAMPLES = 2**31


@cache
def _adapter() -> TypeAdapter[Inventory]:
    return TypeAdapter(Inventory)


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
            "wrote the set: open it with that version, or generate it again from its config.yaml into a new folder, "
            "without keys that are gone since"
        )
    facts = _typed(name, stored)
    _refuse(name, list(_unfit(facts)))
    del content[DIGEST]
    return replace(facts, content=content)


def _typed(name: str, stored: bytes) -> Inventory:
    try:
        return _adapter().validate_json(stored, strict=True)
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
    """Yield how a manifest contradicts itself."""
    needed = [LABELS, DAMAGE, *(shard.file for shard in facts.shards)]
    needed += [shard.internals for shard in facts.shards] if facts.internals else []
    missing = [name for name in needed if name not in facts.files]
    if missing:
        yield f"files: received none named {missing[0]}; every finished set has it"
    if not facts.splits or sum(split.rows for split in facts.splits.values()) != facts.rows:
        yield f"rows: received {facts.rows}; allowed: those of all splits, of which there is at least one"
    rows = dict.fromkeys(facts.splits, 0)
    for shard in facts.shards:
        rows[shard.split] = rows.get(shard.split, 0) + shard.rows
    if rows != {name: split.rows for name, split in facts.splits.items()}:
        yield "shards: received other rows than those of the splits"
    if any(one >= after for one, after in pairwise(map(_place, facts.shards))):
        yield "shards: received them in another order; allowed: train, validation, test, each by number, none twice"
    if not facts.channels or len({channel.column for channel in facts.channels}) != len(facts.channels):
        yield "channels: received none, or two of one column; allowed: every channel once"
    if facts.fs_hz * facts.duration_s > MOST_SAMPLES:
        yield f"duration_s: received {facts.duration_s:g}; allowed: at most {MOST_SAMPLES} samples"
    if not facts.extensions or any(after <= before for before, after in pairwise((0, *facts.extensions))):
        yield f"extensions: received {list(facts.extensions)[:9]}; allowed: ascending numbers of gearboxes"


def _place(shard: ListedShard) -> tuple[int, int]:
    return SPLITS.index(shard.split), int(shard.shard.rpartition("-")[2])
