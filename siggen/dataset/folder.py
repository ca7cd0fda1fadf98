"""What a folder already holds: nothing, part of this very set, the finished set, or something to stay away from."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import yaml

from siggen.dataset.gate import manifest_facts
from siggen.dataset.manifest import CONFIG, MANIFEST
from siggen.dataset.object_name import CHECKSUMS
from siggen.dataset.shard_index import promised_files
from siggen.dataset.storage import Storage
from siggen.errors import ConfigError, DatasetError, VerificationError
from siggen.gearbox.design import SetDesign, design_of

NAMED_DIFFERENCES = 5


def is_finished(storage: Storage, design: SetDesign) -> bool:
    """Tell whether a folder holds the whole set already; False if it is empty or holds a part of this set.

    Only sizes are compared: `siggen verify` reads every byte.

    Raises
    ------
    DatasetError
        If the folder holds another set, a finished one of another schema version, or files that are not a set.
        Nothing is ever deleted to make room.
    """
    if not storage.exists(CONFIG):
        _refuse_strangers(storage)
        return False
    _refuse_other_set(storage, design)
    return storage.exists(MANIFEST) and _has_every_file(storage)


def _has_every_file(storage: Storage) -> bool:
    sizes = storage.sizes()
    try:
        facts = manifest_facts(MANIFEST, storage.get(MANIFEST))
    except VerificationError:
        return False
    if any(sizes.get(name) != file.bytes for name, file in facts.files.items()):
        return False
    try:
        return all(sizes.get(name) == file.bytes for name, file in promised_files(storage, facts.files[CHECKSUMS]))
    except DatasetError:
        return False


def _refuse_strangers(storage: Storage) -> None:
    strangers = storage.names()
    if strangers:
        some = ", ".join(strangers[:3])
        raise DatasetError(
            f"{storage.location} is not empty ({some}{', ...' if len(strangers) > 3 else ''}) "
            "and not a siggen data set; name a new or empty folder (nothing is deleted)"
        )


def _refuse_other_set(storage: Storage, design: SetDesign) -> None:
    stored = storage.get(CONFIG)
    if stored == design.text.encode():
        return
    try:
        found = yaml.safe_load(stored)
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise DatasetError(f"{storage.location}/{CONFIG} cannot be read ({error}); name a new folder") from error
    if _is_same_set(found, design):
        return
    differences = list(_differences("", found, design.canonical()))
    if [path for path, _, _ in differences] == ["specimens"]:
        before, now = differences[0][1:]
        raise DatasetError(
            f"{storage.location} holds this set with {before} specimens, asked for are {now}; "
            f"`siggen extend {storage.location} --specimens {now}` adds to a finished set; fewer need a new folder "
            f"(its first {min(before, now)} specimens will be the same)"
        )
    listed = [f"  {path}: {before} there, {now} asked for" for path, before, now in differences[:NAMED_DIFFERENCES]]
    more = len(differences) - NAMED_DIFFERENCES
    listed += [f"  and {more} more"] if more > 0 else []
    listed = listed or ["  written in another form; was it edited?"]
    raise DatasetError("\n".join([f"{storage.location} holds another data set; name a new folder", *listed]))


def _is_same_set(found: Any, design: SetDesign) -> bool:
    """Tell whether a stored configuration describes this set in another form."""
    try:
        stored = design_of(found if isinstance(found, Mapping) else {}, CONFIG)
    except ConfigError:
        return False
    return (stored.identity, stored.specimens) == (design.identity, design.specimens)


def _differences(path: str, before: Any, now: Any) -> list[tuple[str, Any, Any]]:
    if isinstance(before, Mapping) and isinstance(now, Mapping):
        keys = [*before, *(key for key in now if key not in before)]
        pairs = [(key, before.get(key, "nothing"), now.get(key, "nothing")) for key in keys]
    elif isinstance(before, list) and isinstance(now, list) and len(before) == len(now):
        pairs = [(index, a, b) for index, (a, b) in enumerate(zip(before, now, strict=True))]
    else:
        return [] if before == now else [(path, before, now)]
    found = [_differences(f"{path}.{key}" if path else str(key), a, b) for key, a, b in pairs]
    return [difference for differences in found for difference in differences]
