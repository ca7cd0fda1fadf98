"""The connection to an S3 server: credentials from the environment, retries, and its refusals in words."""

from __future__ import annotations

import importlib.util
import os
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any

from siggen.errors import DatasetError, UsageError, how_to_install

ATTEMPTS = 6
"""With waits that double from about 1 s, by chance shortened (`standard` of botocore): half a minute at most."""

CONNECT_S, READ_S = 10, 60

HINTS = {
    "NoSuchBucket": "there is no such bucket; make it first, siggen makes none",
    "404": "there is no such bucket or object",
    "403": "these credentials may not",
    "AccessDenied": "these credentials may not",
    "InvalidAccessKeyId": "AWS_ACCESS_KEY_ID is not one of this server",
    "SignatureDoesNotMatch": "AWS_SECRET_ACCESS_KEY does not belong to AWS_ACCESS_KEY_ID",
    "ExpiredToken": "the credentials have expired",
    "NoCredentialsError": "no credentials found; set AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY, or a profile",
    "NotImplemented": "the server knows no conditional writes (If-None-Match), by which a second writer is kept out",
}


def s3_client() -> Any:
    """Return a client of boto3, which reads AWS_* (also AWS_ENDPOINT_URL, AWS_MAX_ATTEMPTS) and ~/.aws.

    Raises
    ------
    UsageError
        If boto3 is not installed.
    """
    if importlib.util.find_spec("boto3") is None:
        raise UsageError(f"s3:// needs boto3: {how_to_install('s3')}")
    # what a client is made of; a forked process makes its own
    return _client(os.getpid(), tuple(sorted(item for item in os.environ.items() if item[0].startswith("AWS_"))))


@cache
def _client(process: int, variables: tuple[tuple[str, str], ...]) -> Any:  # noqa: ARG001 - they tell clients apart
    """Return one client for all objects and threads, which may share it; to make it takes a quarter of a second."""
    import boto3
    from botocore.config import Config

    retries = {} if "AWS_MAX_ATTEMPTS" in os.environ else {"total_max_attempts": ATTEMPTS}
    waits = {"connect_timeout": CONNECT_S, "read_timeout": READ_S}
    # a session of its own: the default one is shared between threads without a lock
    return boto3.session.Session().client("s3", config=Config(retries={"mode": "standard", **retries}, **waits))


def error_code(error: Exception) -> str:
    """Return the server's code of an error, such as NoSuchKey, or the name of an error that came from no server."""
    response = getattr(error, "response", None) or {}
    return str(response.get("Error", {}).get("Code", type(error).__name__))


@contextmanager
def in_words(what: str, done: str) -> Iterator[None]:
    """Turn errors of the connection and of the server into words.

    Raises
    ------
    DatasetError
        Naming the object, what was to be done with it, and why it could not be.
    """
    from botocore.exceptions import BotoCoreError, ClientError

    try:
        yield
    except (BotoCoreError, ClientError) as error:
        why = HINTS.get(error_code(error), str(error))
        raise DatasetError(
            f"{what} cannot be {done}: {why}; finished shards stay, and the same command continues once that is mended"
        ) from error
