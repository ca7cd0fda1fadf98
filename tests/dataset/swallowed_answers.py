"""A way to a server on which answers are lost: the request arrives and is carried out, the client never hears of it."""

from __future__ import annotations

import http.client
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from urllib.parse import urlsplit

HOP_BY_HOP = {"connection", "transfer-encoding", "content-length"}


class _Swallowing(ThreadingHTTPServer):
    daemon_threads = True
    behind: str
    ending: str
    methods: set[str]
    swallowed: list[str]


class _Forward(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    server: _Swallowing

    def handle_one(self) -> None:
        server = self.server
        body = self.rfile.read(int(self.headers.get("Content-Length", 0)))
        connection = http.client.HTTPConnection(server.behind)
        connection.request(self.command, self.path, body, dict(self.headers))
        answer = connection.getresponse()
        content = answer.read()
        is_chosen = self.command in server.methods and urlsplit(self.path).path.endswith(server.ending)
        if is_chosen and answer.status < 300 and self.command not in server.swallowed:
            server.swallowed.append(self.command)
            self.close_connection = True
            return
        self.send_response(answer.status)
        for name, value in answer.getheaders():
            if name.lower() not in HOP_BY_HOP | {"server", "date"}:
                self.send_header(name, value)
        self.send_header("Content-Length", answer.getheader("Content-Length") or str(len(content)))
        self.end_headers()
        self.wfile.write(content)

    do_GET = do_PUT = do_HEAD = do_DELETE = do_POST = handle_one

    def log_message(self, format: str, *args: object) -> None:
        """Say nothing."""


@contextmanager
def swallowing(endpoint: str, ending: str, methods: set[str]) -> Iterator[tuple[str, list[str]]]:
    """Swallow the first good answer to each of the methods on objects whose names end so.

    Gives the address to go to instead of the endpoint, and the list of the methods whose answer was lost.
    """
    server = _Swallowing(("127.0.0.1", 0), _Forward)
    server.behind, server.ending, server.methods, server.swallowed = urlsplit(endpoint).netloc, ending, methods, []
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_address[1]}", server.swallowed
    finally:
        server.shutdown()
        server.server_close()
        thread.join()
