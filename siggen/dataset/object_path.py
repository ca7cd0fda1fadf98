"""The place of a set in an object store, such as s3://bucket/sets/bench, with the names of a path."""

from __future__ import annotations

import re
from pathlib import PurePath, PurePosixPath

from siggen.errors import UsageError

# pathlib, through which the command line goes, makes one slash of two
FORM = re.compile(r"s3:/{0,2}([^/]*)/?(.*)", re.DOTALL)


class ObjectPath(PurePosixPath):
    """A path that is written s3://bucket/key; it is no path of this machine, so nothing can be opened by it."""

    __slots__ = ()

    def __str__(self) -> str:
        return super().__str__().replace("s3:/", "s3://", 1)

    @property
    def bucket(self) -> str:
        """Name of the bucket."""
        return self.parts[1]

    @property
    def key(self) -> str:
        """Key below the bucket, without slashes around it; empty for the bucket itself."""
        return "/".join(self.parts[2:])


def object_path(location: PurePath | str) -> ObjectPath | None:
    """Return the place in an object store that a location names; None for a folder.

    Raises
    ------
    UsageError
        If no bucket is named, or it is a store of another kind.
    """
    text = str(location)
    form = FORM.fullmatch(text)
    if form is None:
        if found := re.match(r"([a-z0-9]{2,10}):/{1,2}\S", text):
            raise UsageError(f"{text}: received a location of kind '{found[1]}'; allowed: a folder, or s3://bucket/set")
        return None
    bucket, key = form[1], form[2].strip("/")
    if not bucket or not key:
        raise UsageError(f"{text}: received no bucket or no set in it; allowed: s3://bucket/set")
    if any(part in {".", ".."} for part in key.split("/")):
        raise UsageError(f"{text}: received '.' or '..' in a key, which means nothing there; allowed: s3://bucket/set")
    return ObjectPath("s3:", bucket, *key.split("/"))
