"""The page from a server on this machine alone, which adds the record that is looked at, with every sample."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any
from urllib.parse import parse_qs, urlsplit

import numpy as np

from siggen.dataset.reading import Dataset

LOOPBACK = "127.0.0.1"
WAVE, DETAIL, LIFE = "/wave", "/detail", "/life"


def page_server(
    page: str, dataset: Dataset, records: np.ndarray, answers: Mapping[str, Callable[[int], Any]], port: int = 0
) -> ThreadingHTTPServer:
    """Return a server of a page and of the signals behind it; nobody but this machine reaches it.

    Parameters
    ----------
    page : str
    dataset : siggen Dataset
    records : (n,) int
        Records that it may give.
    answers : mapping of str to callable
        What the page asks for by a number below that of the records, such as `/detail?number=3`, and what JSON holds.
    port : int
        0 takes a free one; `server_address` says which.
    """
    allowed = {int(record) for record in records}
    columns = {channel.name: channel.column for channel in dataset.channels}

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            place = urlsplit(self.path)
            if self.headers.get("Host") not in hosts(self.server):
                # a page from elsewhere that gave this machine its own name must not read the set
                self.send_error(HTTPStatus.FORBIDDEN)
            elif place.path == "/":
                self._send(page.encode("utf-8"), "text/html; charset=utf-8")
            elif place.path == WAVE:
                self._wave(parse_qs(place.query))
            elif place.path in answers:
                self._answer(answers[place.path], parse_qs(place.query).get("number", [""])[0])
            else:
                self.send_error(HTTPStatus.NOT_FOUND)

        def _wave(self, query: dict[str, list[str]]) -> None:
            record, channel = (query.get(name, [""])[0] for name in ("record", "channel"))
            if not record.isdecimal() or int(record) not in allowed or channel not in columns:
                self.send_error(HTTPStatus.NOT_FOUND)
                return
            signal = np.asarray(dataset.record(int(record))[columns[channel]], dtype="<f4")
            self._send(signal.tobytes(), "application/octet-stream")

        def _answer(self, of: Callable[[int], Any], number: str) -> None:
            if not number.isdecimal() or int(number) >= len(records):
                self.send_error(HTTPStatus.NOT_FOUND)
                return
            self._send(json.dumps(of(int(number)), allow_nan=False).encode("utf-8"), "application/json")

        def _send(self, body: bytes, kind: str) -> None:
            self.send_response(HTTPStatus.OK)
            self.send_header("Content-Type", kind)
            self.send_header("Content-Length", str(len(body)))
            self.send_header("X-Content-Type-Options", "nosniff")
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, *_: Any) -> None:
            """Stay silent: the terminal belongs to the command."""

    return ThreadingHTTPServer((LOOPBACK, port), Handler)


def hosts(server: Any) -> tuple[str, str]:
    """Return the names under which the server is asked for."""
    return f"{LOOPBACK}:{server.server_port}", f"localhost:{server.server_port}"
