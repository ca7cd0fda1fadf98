"""Pools of clusters: Dask's own executor, and one of twelve lines for Ray."""

from __future__ import annotations

import importlib.util
import logging
import os
import shlex
import signal
import sys
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor, Future
from contextlib import ExitStack, contextmanager, redirect_stdout
from typing import Any

from siggen.child_environment import OF_WORKERS, SAFE_PATH, child_environment
from siggen.errors import EngineError, UsageError, how_to_install
from siggen.workers import orphan
from siggen.workers.orphan import ending_with_this

RETRIES = 2
"""Of a task whose worker died, by the cluster itself."""

ADDRESS_VARIABLES = {"dask": "DASK_SCHEDULER_ADDRESS", "ray": "RAY_ADDRESS"}
PACKAGES = {"dask": "distributed", "ray": "ray"}

OBJECT_BYTES = 128 << 20
"""Of Ray's shared memory per worker: answers are some kB."""

QUIET = {"RAY_USAGE_STATS_ENABLED": "0", "RAY_ACCEL_ENV_VAR_OVERRIDE_ON_ZERO": "0"}
"""Nothing is reported to anybody, and no warning about graphics cards that no task uses."""

LOOKS = {"raylet_death_check_interval_milliseconds": 200, "prestart_worker_first_driver": False}
"""How often a worker looks whether Ray's own process lives; no workers before the first task, which are not bound."""

BOUND_PYTHON = shlex.join([sys.executable, "-I", orphan.__file__])
"""Binds a worker before it imports Ray, and stays with it."""


def address_of(name: str, address: str | None) -> str | None:
    """Return the address of a cluster: the one given, else of the environment; None: one is made on this machine.

    Raises
    ------
    UsageError
        If its package is not installed.
    """
    if importlib.util.find_spec(PACKAGES[name]) is None:
        raise UsageError(f"the executor '{name}' needs {PACKAGES[name]}: {how_to_install(name)}")
    return address or os.environ.get(ADDRESS_VARIABLES[name])


@contextmanager
def dask_pool(workers: int, address: str | None) -> Iterator[Executor]:
    """Give the executor of a Dask client."""
    from distributed import Client, LocalCluster

    with ExitStack() as stack:
        cluster: Any = address
        try:
            if address is None:
                stack.enter_context(ending_with_this())  # to the end: those that die are replaced
                stack.enter_context(child_environment(OF_WORKERS))  # what Dask is given as `env` comes after the start
                options = {"host": "127.0.0.1", "threads_per_worker": 1, "dashboard_address": None}
                cluster = stack.enter_context(LocalCluster(n_workers=workers, silence_logs=50, **options))
            client = stack.enter_context(Client(cluster))
        except (RuntimeError, OSError, TimeoutError) as error:
            where = address or "this machine"
            raise EngineError(f"the cluster of Dask at {where} did not start or answer ({error}); try again") from error
        yield client.get_executor(pure=False, retries=RETRIES)


class OnRay(Executor):
    """Tasks as those of Ray, each of which has a future of `concurrent.futures`."""

    def __init__(self, ray: Any) -> None:
        self._run = ray.remote(num_cpus=1, max_retries=RETRIES)(_called)

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **named: Any) -> Future[Any]:
        """Run a function on a worker."""
        future: Future[Any] = self._run.remote(function, arguments, named).future()
        return future


def _called(function: Callable[..., Any], arguments: tuple[Any, ...], named: dict[str, Any]) -> Any:
    return function(*arguments, **named)


@contextmanager
def ray_pool(workers: int, address: str | None) -> Iterator[Executor]:
    """Give an executor on a cluster of Ray."""
    os.environ.update({name: value for name, value in QUIET.items() if name not in os.environ})
    import ray

    options: dict[str, Any] = {"runtime_env": {"env_vars": dict(OF_WORKERS)}}
    if address is None:
        memory = OBJECT_BYTES * max(2, workers)
        local = {"num_cpus": workers, "include_dashboard": False, "object_store_memory": memory}
        options |= {"address": "local", "_node_ip_address": "127.0.0.1", **local}
        if sys.platform == "linux":  # elsewhere nothing of it outlives the start of another program
            options["runtime_env"]["py_executable"] = BOUND_PYTHON
        options["_system_config"] = LOOKS
    else:
        options["address"] = address
    logging.getLogger("ray").setLevel(logging.ERROR)
    # Ray prints what befalls its workers to stdout, where a command's result stands alone
    with redirect_stdout(sys.stderr):
        with _own_signals(), _loopback(), child_environment(SAFE_PATH):
            try:
                ray.init(log_to_driver=False, configure_logging=False, job_config=_job_config(), **options)
            except (ConnectionError, RuntimeError, ValueError, TimeoutError) as error:
                raise EngineError(f"the cluster of Ray at {address or 'this machine'}: {error}") from error
        try:
            yield OnRay(ray)
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
