"""What a folder already holds: nothing, part of this very set, the finished set, or something to stay away from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import yaml

from siggen.dataset.environment import environment, fingerprint, version_text
from siggen.dataset.gate import manifest_facts
from siggen.dataset.inventory import Inventory
from siggen.dataset.manifest import CARD, CONFIG, MANIFEST
from siggen.dataset.object_name import DAMAGE, DATA_FOLDER, INTERNALS_FOLDER, LABELS, LIFE_FOLDER, SPLITS
from siggen.dataset.shard import about_of, unpacked
from siggen.dataset.storage import Storage
from siggen.errors import ConfigError, DatasetError, VerificationError
from siggen.gearbox.design import SetDesign, design_of

NAMED_DIFFERENCES = 5
OF_EVERY_SET = (CONFIG, CARD, LABELS, DAMAGE)


@dataclass(frozen=True, slots=True)
class FolderContent:
    """What a folder holds of a set.

    Attributes
    ----------
    earlier
        Numbers of gearboxes at which the set was finished before: its shards never reach over one.
    finished
        The manifest of the whole set, with every file that it names.
    published
        Files and folders that its manifest names and no run makes.
    """

    earlier: tuple[int, ...] = ()
    finished: Inventory | None = None
    published: tuple[str, ...] = ()


def content_of(storage: Storage, design: SetDesign) -> FolderContent:
    """Return what a folder holds already of a set: nothing, a part of it, or all.

    Only sizes are compared: `siggen verify` reads every byte.

    Raises
    ------
    DatasetError
        If the folder holds another set, a finished one of another version, one with more gearboxes, or files that are
        not a set. Nothing is ever deleted to make room.
    """
    manifest = _manifest(storage)
    if manifest is None or manifest.identity != design.identity:
        names = storage.names()  # before what another part may write meanwhile
        if not storage.exists(CONFIG):
            if manifest is not None:
                raise DatasetError(
                    f"{storage.location} holds a set of another configuration, says its {MANIFEST}; allowed: the one "
                    "that it was made of, with all that was changed in it then"
                )
            _refuse_strangers(storage, names)
            return FolderContent()
        there = _refuse_other_set(storage, design)
        if there != design.specimens:
            raise _other_count(storage, there, design.specimens, "begun and not finished")
        return FolderContent(_earlier_of_shards(storage, design))
    # a manifest that its own digest holds says what the set is, even where config.yaml is lost
    if manifest.specimens > design.specimens:
        raise _other_count(storage, manifest.specimens, design.specimens, "finished")
    if manifest.specimens == design.specimens and _has_every_file(storage, manifest):
        return FolderContent(manifest.extensions[:-1], manifest)
    here = environment()
    if fingerprint(manifest.environment) != fingerprint(here):
        raise DatasetError(
            f"{storage.location} was made by {version_text(manifest.environment)}, this is {version_text(here)}: "
            "shards of two versions are never mixed. Go on with the version and the kind of processor that made it, or "
            f"make a new set: siggen generate {storage.location}/{CONFIG} --set specimens={design.specimens} --out NEW"
        )
    folders = {name.split("/")[0] for name in manifest.files} - {DATA_FOLDER, INTERNALS_FOLDER, LIFE_FOLDER}
    published = tuple(sorted(folders - {*OF_EVERY_SET}))
    return FolderContent(tuple(count for count in manifest.extensions if count < design.specimens), None, published)


def _manifest(storage: Storage) -> Inventory | None:
    """Return the manifest; None where there is none, or it was changed.

    Raises
    ------
    DatasetError
        If a version of siggen with other files wrote it.
    """
    if not storage.exists(MANIFEST):
        return None
    try:
        return manifest_facts(MANIFEST, storage.get(MANIFEST))
    except VerificationError:
        return None
    except DatasetError as error:
        raise DatasetError(f"{storage.location}/{error}") from error


def _has_every_file(storage: Storage, manifest: Inventory) -> bool:
    sizes = storage.sizes()
    return all(sizes.get(name) == file.bytes for name, file in manifest.files.items())


def _earlier_of_shards(storage: Storage, design: SetDesign) -> tuple[int, ...]:
    """Return at which numbers a set without its manifest was finished: its latest shards say so."""
    found: tuple[int, ...] = ()
    names = storage.names(DATA_FOLDER)
    for split in SPLITS:
        last = max((name for name in names if name.startswith(f"{DATA_FOLDER}/{split}-")), default=None)
        if last is None:
            continue
        try:
            about = about_of(unpacked(storage.get(last), ["record_id"]))
            counts = tuple(int(count) for count in about["earlier"])
        except (VerificationError, DatasetError, KeyError, TypeError, ValueError):
            continue
        if about.get("identity") == design.identity and all(0 < count < design.specimens for count in counts):
            found = max(found, tuple(sorted(set(counts))), key=len)
    return found


def _other_count(storage: Storage, there: int, now: int, state: str) -> DatasetError:
    return DatasetError(
        f"{storage.location} holds this set with {there} gearboxes, {state}; asked for are {now}: a finished set grows "
        f"to more; fewer need a new folder (its first {min(there, now)} gearboxes will be the same)"
    )


def _refuse_strangers(storage: Storage, strangers: Sequence[str]) -> None:
    if strangers:
        some = ", ".join(strangers[:3])
        raise DatasetError(
            f"{storage.location} is not empty ({some}{', ...' if len(strangers) > 3 else ''}) "
            "and not a siggen data set; name a new or empty folder (nothing is deleted)"
        )


def _refuse_other_set(storage: Storage, design: SetDesign) -> int:
    """Return for how many gearboxes the configuration asks that a folder holds."""
    stored = storage.get(CONFIG)
    if stored == design.text.encode():
        return design.specimens
    try:
        found = yaml.safe_load(stored)
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise DatasetError(f"{storage.location}/{CONFIG} cannot be read ({error}); name a new folder") from error
    if (specimens := _of_same_set(found, design)) is not None:
        return specimens
    differences = list(_differences("", found, design.canonical()))
    listed = [f"  {path}: {before} there, {now} asked for" for path, before, now in differences[:NAMED_DIFFERENCES]]
    more = len(differences) - NAMED_DIFFERENCES
    listed += [f"  and {more} more"] if more > 0 else []
    listed = listed or ["  written in another form; was it edited?"]
    raise DatasetError("\n".join([f"{storage.location} holds another data set; name a new folder", *listed]))


def _of_same_set(found: Any, design: SetDesign) -> int | None:
    """Return the gearboxes of a stored configuration, which may have another form; None for another set."""
    try:
        stored = design_of(found if isinstance(found, Mapping) else {}, CONFIG)
    except ConfigError:
        return None
    return stored.specimens if stored.identity == design.identity else None


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
