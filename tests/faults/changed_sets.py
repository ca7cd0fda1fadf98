"""A set as a stranger may change it: other values, names, links and files, sealed again so that all hashes fit."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import shutil
from pathlib import Path
from random import Random
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from siggen.dataset.seal import sealed, unsealed
from tests.faults.mutated_configurations import VALUES

SECRET = b"canary: nobody has read this\n" * 40
NAMES = (
    *("../canary/secret.txt", "data/../../canary/secret.txt", "./config.yaml", "data//x", "/etc/passwd", "..", "", "."),
    *(
        "data/train-00000.parquet/..",
        "..\\canary\\secret.txt",
        "C:/secret.txt",
        "data/\0",
        "x" * 300,
        "a/" * 2000 + "x",
    ),
    *("data/train-00000.parquet", "config.yaml", "README.md", "manifest.json", "labels.parquet", ".bashrc", "data"),
    *("\ud800", "\u202etxt", "data/train-00000.json", "life/units.parquet", "internals/train-00000.parquet"),
)


def change(folder: Path, chance: Random) -> None:
    """Change a set in one to three places, and seal it again."""
    manifest = unsealed("manifest.json", (folder / "manifest.json").read_bytes())
    for _ in range(chance.randint(1, 3)):
        kind = chance.random()
        if kind < 0.45:
            _other_value(manifest, chance)
        elif kind < 0.75:
            _other_table(folder, chance)
        elif kind < 0.88:
            _other_name(manifest, chance)
        else:
            _other_file(folder, chance)
    _seal(folder, manifest, fitting=chance.random() < 0.8)


def _other_value(tree: Any, chance: Random) -> None:
    """Change one value or key somewhere in a tree."""
    while True:
        keys = list(tree) if isinstance(tree, dict) else list(range(len(tree)))
        if not keys:
            return
        key = chance.choice(keys)
        if isinstance(tree[key], (dict, list)) and tree[key] and chance.random() < 0.8:
            tree = tree[key]
            continue
        break
    match chance.randrange(5):
        case 0:
            del tree[key]
        case 1 if isinstance(tree, dict):
            tree[chance.choice(NAMES) if chance.random() < 0.5 else f"{key}_"] = tree.pop(key)
        case 2 if isinstance(tree[key], (int, float)):
            tree[key] = tree[key] * chance.choice((-1, 0, 0.5, 2, 1e300)) + chance.choice((0, 1, -1))
        case 3 if isinstance(tree[key], str):
            tree[key] = chance.choice(NAMES)
        case _:
            tree[key] = chance.choice(VALUES)


def _other_table(folder: Path, chance: Random) -> None:
    """Change a cell of a table, or leave out, rename or retype a column, or give it no rows or some twice."""
    files = [folder / "labels.parquet", folder / "damage.parquet", *sorted((folder / "data").glob("*.parquet"))]
    file = chance.choice(files)
    if (folder / "data").is_symlink() or file.is_symlink() or not file.is_file():
        return
    with contextlib.suppress(pa.ArrowException, OSError, ValueError, TypeError, NotImplementedError):
        pq.write_table(_lying(pq.read_table(file), chance), file)


def _lying(table: pa.Table, chance: Random) -> pa.Table:
    name = chance.choice(table.column_names)
    place = table.schema.get_field_index(name)
    match chance.randrange(6):
        case 0:
            return table.drop_columns([name])
        case 1:
            others = [chance.choice(("x", "", "state")) if one == name else one for one in table.column_names]
            return table.rename_columns(others)
        case 2:
            return table.set_column(place, name, table[name].cast(chance.choice((pa.string(), pa.float32()))))
        case 3:
            return table.set_column(place, name, pa.nulls(table.num_rows, table[name].type))
        case 4:
            return table.slice(0, chance.randrange(table.num_rows + 1))
    return pa.concat_tables([table, table.slice(0, 1)])


def _other_name(manifest: dict[str, Any], chance: Random) -> None:
    """Add a file with the hash of the canary."""
    name = chance.choice(NAMES)
    if isinstance(manifest.get("files"), dict):
        manifest["files"][name] = {"bytes": len(SECRET), "sha256": hashlib.sha256(SECRET).hexdigest()}


def _other_file(folder: Path, chance: Random) -> None:
    """Put a link, a pipe or a folder in the place of a file or folder."""
    places = [path for path in sorted(folder.rglob("*")) if path.name != "manifest.json"]
    path = chance.choice(places)
    if not path.exists() or path.is_symlink():
        return
    kind = chance.randrange(6)
    if path.is_dir():
        shutil.rmtree(path)
        path.symlink_to(folder.parent / "canary")
        return
    path.unlink()
    match kind:
        case 0 | 1:
            path.symlink_to(Path(os.path.relpath(folder.parent / "canary" / "secret.txt", path.parent)))
        case 2:
            path.symlink_to(path.name)
        case 3:
            os.mkfifo(path)
        case 4:
            path.mkdir()
        case _:
            path.symlink_to("/dev/zero")


def _seal(folder: Path, manifest: dict[str, Any], *, fitting: bool) -> None:
    """Write the manifest, with sizes and hashes of what is there now if they are to fit."""
    files = manifest.get("files")
    for name in list(files) if fitting and isinstance(files, dict) else ():
        path = folder / name if "\0" not in name and len(name) < 200 else folder / "nothing"
        with contextlib.suppress(OSError, ValueError):
            if path.is_file() and isinstance(files[name], dict):
                content = path.read_bytes()
                files[name] |= {"bytes": len(content), "sha256": hashlib.sha256(content).hexdigest()}
    (folder / "manifest.json").write_bytes(_sealed(manifest))


def _sealed(content: dict[str, Any]) -> bytes:
    """Seal what a stranger wrote, lone surrogates and all."""
    try:
        return sealed(content)
    except (UnicodeEncodeError, TypeError):
        return json.dumps(content).encode()
