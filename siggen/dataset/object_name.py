"""The name of an object of a set: relative, below the set's folder, the same on every system.

A set may come from anybody, so a name in its manifest is no path until it has passed here.
"""

from __future__ import annotations

import re

from siggen.errors import DatasetError

MOST_CHARACTERS = 500
LABELS, DAMAGE = "labels.parquet", "damage.parquet"
"""Every record without its signals, and every single damage, in the order of the shards."""

DATA_FOLDER, INTERNALS_FOLDER, LIFE_FOLDER = "data", "internals", "life"
SPLITS = ("train", "validation", "test")

PART = r"[A-Za-z0-9_](?:[A-Za-z0-9_.+=@-]{0,218}[A-Za-z0-9_+=@-])?"
"""Between two slashes. A point at the beginning would hide a file, or lead upwards."""
NAME = re.compile(f"{PART}(?:/{PART})*")
ALLOWED = "allowed: names below the set's folder such as data/train-00000.parquet"


def object_name(text: str) -> str:
    """Return the name.

    Raises
    ------
    ValueError
        If it could lead out of the set's folder, or is not written as siggen writes names.
    """
    if len(text) > MOST_CHARACTERS or not NAME.fullmatch(text):
        raise ValueError(ALLOWED)
    return text


def check_below(name: str, location: str) -> None:
    """Refuse a name that leads upwards, whoever asks for it: the last check before a path is made of it.

    Raises
    ------
    DatasetError
        If it does.
    """
    if "\0" in name or "\\" in name or any(part in {"", ".", ".."} for part in name.split("/")):
        raise DatasetError(f"{location}: received the object name {name[:80]!r}; {ALLOWED}")


def data_name(shard: str) -> str:
    """Return the object name of a shard's rows."""
    return f"{DATA_FOLDER}/{shard}.parquet"


def internals_name(shard: str) -> str:
    """Return the object name of a shard's internal quantities."""
    return f"{INTERNALS_FOLDER}/{shard}.parquet"


def life_name(table: str) -> str:
    """Return the object name of a table of lives."""
    return f"{LIFE_FOLDER}/{table}.parquet"
