"""An S3 server on loopback that can be stopped and started again with all that it holds."""

from __future__ import annotations

import logging
import os
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager

BUCKET = "sets"


class MotoStore:
    """A server of this process; its objects outlive a stop."""

    def __init__(self) -> None:
        self._server, self._port = None, 0

    def start(self) -> None:
        """Serve, always at the same port; nothing happens if it serves already."""
        from moto.server import ThreadedMotoServer

        if self._server is None:
            self._server = ThreadedMotoServer(ip_address="127.0.0.1", port=self._port, verbose=False)
            self._server.start()
            self._port = self._server.get_host_and_port()[1]

    def stop(self) -> None:
        """Refuse connections from now on."""
        if self._server is not None:
            self._server.stop()
            self._server = None

    @property
    def address(self) -> str:
        """Of the server."""
        return f"http://127.0.0.1:{self._port}"


@contextmanager
def moto_store() -> Iterator[MotoStore]:
    """Serve one bucket, whose address and credentials are in the environment meanwhile."""
    logging.getLogger("werkzeug").setLevel(logging.ERROR)
    store = MotoStore()
    store.start()
    facts = {"ACCESS_KEY_ID": "test", "SECRET_ACCESS_KEY": "test", "DEFAULT_REGION": "us-east-1"}
    facts |= {"ENDPOINT_URL": store.address, "EC2_METADATA_DISABLED": "true", "MAX_ATTEMPTS": "2"}
    os.environ.update({f"AWS_{name}": value for name, value in facts.items()})
    urllib.request.urlopen(urllib.request.Request(f"{store.address}/{BUCKET}", method="PUT")).close()
    try:
        yield store
    finally:
        store.stop()
        for name in facts:
            del os.environ[f"AWS_{name}"]
