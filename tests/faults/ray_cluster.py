"""A cluster of Ray on this machine with a head and one more node, which can be killed and started again."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path
from types import TracebackType
from typing import Self

from siggen.child_environment import ONE_THREAD
from siggen.workers.clusters import QUIET
from tests.faults.process_tree import Process, below

PORT = 26379
START_S = 90.0
OPEN = {"RAY_AUTH_MODE": "disabled"}
"""Without a token, which every process would have to find: it listens on loopback alone."""


class RayCluster:
    """Head and node of one core each; both end with the block.

    Parameters
    ----------
    folder : Path
        For what Ray writes; short, since a socket lies in it.
    """

    address = f"127.0.0.1:{PORT}"

    def __init__(self, folder: Path) -> None:
        self._environment = {**os.environ, **ONE_THREAD, **QUIET, **OPEN}
        self._folder = folder
        self._parts: dict[str, subprocess.Popen[bytes]] = {}

    def __enter__(self) -> Self:
        head = ("--head", f"--port={PORT}", "--include-dashboard=false", f"--temp-dir={self._folder / 'r'}")
        try:
            self._start("head", *head)
            self.start_node()
        except BaseException:
            self.__exit__(None, None, None)
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for name in ("node", "head"):
            self._end(name)

    def start_node(self) -> None:
        """Start the node that can be killed and wait until it runs tasks."""
        self._start("node", f"--address={self.address}")

    def kill_node(self) -> bool:
        """Kill the node and all that runs on it; tell whether there was one."""
        found = self._raylets("node")
        self._end("node")
        return bool(found)

    def _start(self, name: str, *options: str) -> None:
        command = [
            str(Path(sys.executable).with_name("ray")),
            "start",
            "--block",
            "--num-cpus=1",
            "--node-ip-address=127.0.0.1",
            *options,
        ]
        command += [f"--object-store-memory={256 << 20}", "--disable-usage-stats"]
        out = subprocess.DEVNULL
        self._parts[name] = subprocess.Popen(
            command, env=self._environment, stdout=out, stderr=out, start_new_session=True
        )
        deadline = time.monotonic() + START_S
        while not self._raylets(name):
            if time.monotonic() > deadline or self._parts[name].poll() is not None:
                raise RuntimeError(f"the {name} of the cluster of Ray did not start")
            time.sleep(0.2)

    def _raylets(self, name: str) -> list[Process]:
        return [one for one in below(self._parts[name].pid) if "raylet/raylet" in one.command.split(" ")[0]]

    def _end(self, name: str) -> None:
        part = self._parts.pop(name, None)
        if part is None:
            return
        family = below(part.pid)
        # first what runs tasks: whoever starts processes for it must not see it die and clean up in order
        for one in sorted(family, key=lambda one: "raylet/raylet" not in one.command):
            one.kill()
        part.kill()
        part.wait()
