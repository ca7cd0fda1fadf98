"""An S3 server on loopback, which a test starts and can stop; buckets live in this process."""

from __future__ import annotations

import hashlib
import logging
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partialmethod
from pathlib import PurePath

import pytest

from siggen.dataset.storage_at import storage_at

BUCKET = "sets"


@contextmanager
def s3_server(monkeypatch: pytest.MonkeyPatch, port: int = 0) -> Iterator[str]:
    """Serve one empty bucket; give the address, which is in the environment with credentials."""
    from werkzeug.serving import BaseWSGIServer

    server_module = pytest.importorskip("moto.server")
    serve = BaseWSGIServer.serve_forever
    monkeypatch.setattr(
        BaseWSGIServer, "serve_forever", partialmethod(serve, poll_interval=0.01)
    )  # else stops wait 0.5 s
    server = server_module.ThreadedMotoServer(ip_address="127.0.0.1", port=port, verbose=False)
    logging.getLogger("werkzeug").setLevel(logging.ERROR)
    server.start()
    host, found = server.get_host_and_port()
    facts = {"ACCESS_KEY_ID": "test", "SECRET_ACCESS_KEY": "test", "DEFAULT_REGION": "us-east-1"}
    facts |= {"ENDPOINT_URL": f"http://{host}:{found}", "EC2_METADATA_DISABLED": "true", "MAX_ATTEMPTS": "2"}
    for name, value in facts.items():
        monkeypatch.setenv(f"AWS_{name}", value)
    # stores of this process outlive a server
    for path, method in (("moto-api/reset", "POST"), (BUCKET, "PUT")):
        urllib.request.urlopen(urllib.request.Request(f"{facts['ENDPOINT_URL']}/{path}", method=method)).close()
    try:
        yield facts["ENDPOINT_URL"]
    finally:
        server.stop()


def object_bytes(place: PurePath | str) -> dict[str, bytes]:
    """Return every object of a set, as `file_bytes` of a folder."""
    storage = storage_at(place)
    return {name: storage.get(name) for name in storage.names()}


def digests(files: dict[str, bytes]) -> dict[str, str]:
    """Return short forms of files, so that a difference can be read."""
    return {name: hashlib.sha256(content).hexdigest()[:12] for name, content in files.items()}
