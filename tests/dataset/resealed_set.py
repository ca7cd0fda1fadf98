"""A set that a test changed, with sizes, hashes and checksums that fit again: what no accident does."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq

from siggen.dataset.checked_file import checksums
from siggen.dataset.object_name import CHECKSUMS
from siggen.dataset.seal import sealed, unsealed


def reseal(folder: Path) -> None:
    """Write sidecars, index and manifest again for the files that are there now."""
    for file in sorted((folder / "shards").glob("*.json")):
        sidecar = unsealed(file.name, file.read_bytes())
        for kind in {"data", "internals"} & set(sidecar):
            sidecar[kind] |= facts(folder, sidecar[kind]["name"], blocks=True)
        file.write_bytes(sealed(sidecar))
    retabled(folder, CHECKSUMS, lambda row: row | _promised(folder, row["shard"]))


def retabled(folder: Path, name: str, change: Callable[[dict[str, Any]], dict[str, Any]]) -> None:
    """Change the rows of a table of shards, and seal the manifest over what is there then."""
    table = pq.read_table(folder / name)
    changed = type(table).from_pylist([change(row) for row in table.to_pylist()], schema=table.schema)
    pq.write_table(changed, folder / name, row_group_size=256)
    reseal_manifest(folder)


def reseal_manifest(folder: Path) -> None:
    """Write the manifest again for the files that it names."""
    manifest = unsealed("manifest.json", (folder / "manifest.json").read_bytes())
    for name, promised in manifest["files"].items():
        if (folder / name).is_file():
            manifest["files"][name] = facts(folder, name, blocks="crc32_per_64_kib" in promised)
    (folder / "manifest.json").write_bytes(sealed(manifest))


def _promised(folder: Path, shard: str) -> dict[str, object]:
    promised: dict[str, object] = {}
    for kind, name in (("data", f"data/{shard}.parquet"), ("internals", f"internals/{shard}.parquet")):
        if (folder / name).is_file():
            found = facts(folder, name, blocks=True)
            promised |= {f"{kind}_{k}": bytes.fromhex(v) if isinstance(v, str) else v for k, v in found.items()}
    own = facts(folder, f"shards/{shard}.json", blocks=False)
    return promised | {"sidecar_bytes": own["bytes"], "sidecar_sha256": bytes.fromhex(str(own["sha256"]))}


def facts(folder: Path, name: str, *, blocks: bool) -> dict[str, object]:
    """Return what manifest and sidecars promise of a file."""
    with (folder / name).open("rb") as file:
        found = checksums(file)
    plain = {"bytes": (folder / name).stat().st_size, "sha256": found.sha256}
    return {**plain, "crc32_per_64_kib": found.crc32_per_64_kib} if blocks else plain
