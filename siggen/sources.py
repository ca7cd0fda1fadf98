"""Version of this package, and digest of its sources: the same in a checkout and in a wheel of the same sources."""

from __future__ import annotations

from functools import cache
from hashlib import sha256
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from siggen.errors import DISTRIBUTION

PACKAGE = Path(__file__).resolve().parent
CHARACTERS = 16


@cache
def installed_version(distribution: str = DISTRIBUTION) -> str:
    """Return the version of an installed distribution, of siggen itself by default, or "not installed"."""
    try:
        return version(distribution)
    except PackageNotFoundError:
        return "not installed"


@cache
def sources_digest(patterns: tuple[str, ...]) -> str:
    """Return 16 hexadecimal digits of the names and contents of the files of the package that match."""
    digest = sha256()
    for path in sorted({path for pattern in patterns for path in PACKAGE.glob(pattern)}):
        name = path.relative_to(PACKAGE).as_posix()
        digest.update(f"{name} ".encode() + sha256(path.read_bytes()).digest())
    return digest.hexdigest()[:CHARACTERS]
