"""A set that a test changed, with sizes, hashes and checksums that fit again: what no accident does."""

from __future__ import annotations

from pathlib import Path

from siggen.dataset.checked_file import checksums
from siggen.dataset.seal import sealed, unsealed


def reseal(folder: Path) -> None:
    """Write sidecars and manifest again for the files that are there now."""
    manifest = unsealed("manifest.json", (folder / "manifest.json").read_bytes())
    for file in sorted((folder / "shards").glob("*.json")):
        sidecar = unsealed(file.name, file.read_bytes())
        for kind in {"data", "internals"} & set(sidecar):
            sidecar[kind] |= facts(folder, sidecar[kind]["name"], blocks=True)
        file.write_bytes(sealed(sidecar))
    for name, promised in manifest["files"].items():
        if (folder / name).is_file():
            manifest["files"][name] = facts(folder, name, blocks="crc32_per_64_kib" in promised)
    (folder / "manifest.json").write_bytes(sealed(manifest))


def facts(folder: Path, name: str, *, blocks: bool) -> dict[str, object]:
    """Return what manifest and sidecars promise of a file."""
    with (folder / name).open("rb") as file:
        found = checksums(file)
    plain = {"bytes": (folder / name).stat().st_size, "sha256": found.sha256}
    return {**plain, "crc32_per_64_kib": found.crc32_per_64_kib} if blocks else plain
