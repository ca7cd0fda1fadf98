"""The lock of a set in an object store: an object, made only where there is none, and renewed while its writer lives.

S3 has no lock that dies with its process. So a writer renews its lock every `RENEW_S`; one that nobody has renewed for
`STALE_S` of the server's own clock may be taken over, at once where its process is known to be dead. Making, renewing
and taking over are conditional writes (If-None-Match, If-Match): of two writers at a time the server refuses one.

An answer may be lost on its way. The client then repeats a write that was done, and the server refuses the repetition:
so a refusal counts only where the lock is another writer's, by its token.
"""

from __future__ import annotations

import json
import secrets
import threading
from collections.abc import Mapping
from datetime import datetime
from email.utils import parsedate_to_datetime
from typing import Any

from siggen.dataset.s3_client import error_code, in_words
from siggen.errors import DatasetError
from siggen.live_process import is_gone, this_process

RENEW_S = 20.0
STALE_S = 120.0
REFUSED = {"PreconditionFailed", "ConditionalRequestConflict", "412", "409"}
ABSENT = {"NoSuchKey", "404"}


class WriterLock:
    """A lock that is held from `acquire` to `release`.

    Parameters
    ----------
    client
        Of boto3.
    place : mapping
        Bucket and Key of the lock.
    location : str
        Of the set, for messages.
    """

    def __init__(self, client: Any, place: Mapping[str, str], location: str) -> None:
        self._client, self._place, self._location = client, dict(place), location
        self._facts = {**this_process(), "token": secrets.token_hex(8)}
        self._tag = ""
        self._released = threading.Event()
        self._lost = False

    def acquire(self) -> None:
        """Take the lock and begin to renew it.

        Raises
        ------
        DatasetError
            If a living writer holds it, or the server knows no conditional writes.
        """
        with in_words(self._location, "written"):
            self._tag = self._put(IfNoneMatch="*") or self._take_over()
            if self._holder() != self._facts:  # a server that does not know the condition writes all the same
                raise self._busy(self._holder())
        threading.Thread(target=self._renew, daemon=True).start()

    def check(self) -> None:
        """Raise DatasetError if another writer took the lock over: this one was silent for too long."""
        if self._lost:
            raise DatasetError(
                f"{self._location} is being written by another siggen process, since this one could not renew its lock "
                f"for {STALE_S:g} s; finished shards stay"
            )

    def release(self) -> None:
        """Give the lock back if it is still held; a store that cannot be reached is left to the time."""
        self._released.set()
        from botocore.exceptions import BotoCoreError, ClientError

        try:
            if not self._lost and self._holder() == self._facts:
                self._client.delete_object(**self._place)
        except (BotoCoreError, ClientError):
            return

    def _put(self, **condition: str) -> str:
        """Write the lock on a condition and return its tag, or an empty text where another writer has it."""
        from botocore.exceptions import ClientError

        try:
            answer = self._client.put_object(Body=json.dumps(self._facts).encode(), **self._place, **condition)
        except ClientError as error:
            if error_code(error) in REFUSED | ABSENT:
                return self._own_tag()
            raise
        return str(answer["ETag"])

    def _own_tag(self) -> str:
        """Return the tag of a lock that this writer made without hearing of it, or an empty text."""
        found = self._found()
        return str(found["ETag"]) if found and _facts(found["Body"].read()) == self._facts else ""

    def _found(self) -> dict[str, Any]:
        """Return the server's answer to a read of the lock; empty where there is none."""
        from botocore.exceptions import ClientError

        try:
            return dict(self._client.get_object(**self._place))
        except ClientError as error:
            if error_code(error) in ABSENT:
                return {}
            raise

    def _take_over(self) -> str:
        """Return the tag of the lock if a dead writer had it."""
        found = self._found()
        if not found:  # released a moment ago
            return self._put(IfNoneMatch="*") or self._refuse({})
        holder = _facts(found["Body"].read())
        now = parsedate_to_datetime(found["ResponseMetadata"]["HTTPHeaders"]["date"])
        silent_s = (now - _aware(found["LastModified"])).total_seconds()
        if silent_s < STALE_S and not is_gone(holder):
            self._refuse(holder)
        return self._put(IfMatch=found["ETag"]) or self._refuse(holder)

    def _holder(self) -> dict[str, Any]:
        found = self._found()
        return _facts(found["Body"].read()) if found else {}

    def _refuse(self, holder: dict[str, Any]) -> str:
        raise self._busy(holder)

    def _busy(self, holder: dict[str, Any]) -> DatasetError:
        who = f" (process {holder['pid']} on {holder['host']})" if {"pid", "host"} <= set(holder) else ""
        return DatasetError(
            f"{self._location} is being written by another siggen process{who}; wait for it or name another. If that "
            f"process was killed, its lock ends {STALE_S:g} s after its last sign of life"
        )

    def _renew(self) -> None:
        from botocore.exceptions import BotoCoreError, ClientError

        while not self._released.wait(RENEW_S):
            try:
                tag = self._put(IfMatch=self._tag)
            except (BotoCoreError, ClientError):
                continue  # the store may be back before the lock is stale
            if self._released.is_set():
                return
            self._lost, self._tag = not tag, tag
            if self._lost:
                return


def _facts(content: bytes) -> dict[str, Any]:
    try:
        return dict(json.loads(content))
    except (ValueError, TypeError):
        return {}


def _aware(time: datetime) -> datetime:
    return time.astimezone()
