"""The engine of Ray: tasks go to a cluster that is there already, or to worker processes of this machine."""

from __future__ import annotations

import importlib.util
import logging
import os
import shlex
import signal
import sys
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, redirect_stdout
from functools import partial
from typing import Any

from siggen.child_environment import OF_WORKERS, SAFE_PATH, child_environment
from siggen.engines import orphan
from siggen.engines.orphan import end_with
from siggen.engines.processes import TASK_ATTEMPTS
from siggen.engines.protocol import Result, Results, Task, task_error
from siggen.engines.window import windowed
from siggen.engines.worker import RAISED, answer
from siggen.errors import EngineError, UsageError, how_to_install

ADDRESS_VARIABLE = "RAY_ADDRESS"

RESULT_BYTES = 128 << 20
"""Of Ray's shared memory per worker: a window of results, each of a few row groups."""

QUIET = {"RAY_USAGE_STATS_ENABLED": "0", "RAY_ACCEL_ENV_VAR_OVERRIDE_ON_ZERO": "0"}
"""Nothing is reported to anybody, and no warning about graphics cards that no task uses."""


LOOKS = {"raylet_death_check_interval_milliseconds": 200, "prestart_worker_first_driver": False}
"""How often a worker looks whether Ray's own process lives; no workers before the first task, which are not bound."""


BOUND_PYTHON = shlex.join([sys.executable, "-I", orphan.__file__])
"""Binds a worker before it imports Ray, and stays with it."""


class RayEngine:
    """Runs tasks on Ray workers with one numeric thread each.

    Parameters
    ----------
    workers : int
        Processes of a cluster on this machine, which ends with the work; for a given cluster, how many workers the
        window of open tasks is cut for.
    address : str, optional
        Of a cluster: 'auto' for the one that this machine belongs to, or ray://head:10001; default: the environment's
        `RAY_ADDRESS`, else a cluster on this machine. Workers of a given cluster need siggen.

    Raises
    ------
    UsageError
        If Ray is not installed, or fewer than one worker is asked for.
    """

    def __init__(self, workers: int, address: str | None = None) -> None:
        if importlib.util.find_spec("ray") is None:
            raise UsageError(f"the engine 'ray' needs ray: {how_to_install('ray')}")
        if workers < 1:
            raise UsageError(f"received {workers} workers; at least 1 is needed")
        self.workers = workers
        self.address = address or os.environ.get(ADDRESS_VARIABLE)
        self._draining = False

    def drain(self) -> None:
        """Hand in no further task, nor the rest of one; see `DrainingEngine`."""
        self._draining = True

    def map(self, function: Callable[[Task], Result], tasks: Iterable[Task]) -> Results[Result]:
        """Yield (position, result) as tasks complete; see `Engine.map`.

        Raises
        ------
        EngineError
            If a task raised, its workers died too often, or the cluster cannot be reached.
        """
        self._draining = False
        call = answer if self.address is not None else _child_answer
        with self._cluster() as ray:
            run = ray.remote(num_cpus=1, max_retries=TASK_ATTEMPTS - 1)(call)
            everywhere = ray.put(function)
            yield from windowed(
                tasks,
                self.workers,
                submit=lambda task, _: run.remote(everywhere, task),
                finished=lambda opened: _finished(ray, list(opened)),
                value=partial(_value, ray),
                drained=lambda: self._draining,
            )

    @contextmanager
    def _cluster(self) -> Iterator[Any]:
        os.environ.update({name: value for name, value in QUIET.items() if name not in os.environ})
        import ray

        options: dict[str, Any] = {"runtime_env": {"env_vars": dict(OF_WORKERS)}}
        if self.address is None:
            memory = RESULT_BYTES * max(2, self.workers)
            local = {"num_cpus": self.workers, "include_dashboard": False, "object_store_memory": memory}
            options |= {"address": "local", "_node_ip_address": "127.0.0.1", **local}
            if sys.platform == "linux":  # elsewhere nothing of it outlives the start of another program
                options["runtime_env"]["py_executable"] = BOUND_PYTHON
            options["_system_config"] = LOOKS
        else:
            options["address"] = self.address
        logging.getLogger("ray").setLevel(logging.ERROR)
        # Ray prints what befalls its workers to stdout, where a command's result stands alone
        with redirect_stdout(sys.stderr):
            with _own_signals(), _loopback(), child_environment(SAFE_PATH):
                try:
                    ray.init(log_to_driver=False, configure_logging=False, job_config=_job_config(), **options)
                except (ConnectionError, RuntimeError, ValueError, TimeoutError) as error:
                    raise EngineError(f"the cluster of Ray at {self.address or 'this machine'}: {error}") from error
            try:
                yield ray
            finally:
                ray.shutdown()


class _ImportedPaths(list[str]):
    """Folders that workers import from too; without the current one, which Ray puts first, unless this process does."""

    def extend(self, paths: Iterable[str]) -> None:
        super().extend(path for path in paths if path in sys.path)


def _job_config() -> Any:
    from ray.job_config import JobConfig

    job = JobConfig()
    job._py_driver_sys_path = _ImportedPaths()
    return job


@contextmanager
def _loopback() -> Iterator[None]:
    """Let Ray keep the loopback address that it is given.

    Its processes listen on all interfaces unless that is their address. Ray turns it into the machine's own, so that
    others can reach it: here nobody shall. Where a later Ray has no such function, its default stays.
    """
    from ray._private import services

    name = "resolve_ip_for_localhost"
    before = getattr(services, name, None)
    if before is None:
        yield
        return
    setattr(services, name, lambda host: host)
    try:
        yield
    finally:
        setattr(services, name, before)


@contextmanager
def _own_signals() -> Iterator[None]:
    """Keep what SIGTERM does: Ray puts a handler of its own in place."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.getsignal(signal.SIGTERM)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _child_answer(function: Callable[[Any], Any], task: Any) -> tuple[str, Any]:
    """Answer on a worker of this machine's cluster: its parent is Ray's own process, which ends with the driver."""
    end_with(os.getppid())
    return answer(function, task)


def _finished(ray: Any, opened: list[Any]) -> list[Any]:
    """Wait for one, and return all that are there then: each question costs time with every open task."""
    first = ray.wait(opened, num_returns=1)[0]
    return list(ray.wait(opened, num_returns=len(opened), timeout=0)[0] or first)


def _value(ray: Any, reference: Any, task: object) -> Any:
    try:
        kind, content = ray.get(reference)
    except (ray.exceptions.WorkerCrashedError, ray.exceptions.NodeDiedError, ray.exceptions.OutOfMemoryError) as error:
        raise EngineError(
            f"{task} was lost because the workers that ran it died ({str(error).splitlines()[0]}); what is committed "
            "stays: try again with fewer workers"
        ) from error
    if kind == RAISED:
        raise task_error(task, content)
    return content
