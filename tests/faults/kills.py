"""SIGKILL at random moments, on every executor, while small sets of presets are made; what came of it.

After every run each committed file is compared with that of an undisturbed set, and the same command goes on. When the
set is finished all its files are compared, and the next kills hit a new one.
"""

from __future__ import annotations

import importlib.util
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping
from contextlib import nullcontext, suppress
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from random import Random
from typing import BinaryIO, Self

from benchmarks.row import Row
from siggen.child_environment import ONE_THREAD
from siggen.dataset.storage import LocalFolder
from tests.faults.process_tree import Process, below, seconds_until_gone
from tests.faults.ray_cluster import OPEN, RayCluster
from tests.faults.set_files import committed_problems, committed_shards, set_files, whole_set_problems
from tests.faults.victim_run import OVERRIDES, PARTS

DRIVER, WORKER, NODE = "driver", "worker", "node"
PARTS_AND_END, RAY_CLUSTER = "parts", "ray, two nodes"
COUNTS = {"processes": 40, "serial": 20, PARTS_AND_END: 20, "dask": 20, "ray": 20, RAY_CLUSTER: 10}
"""Of the set of quickstart; of every other preset as many as in `EACH`, by processes."""
EACH = 15
QUICK_COUNTS = {"processes": 3, "serial": 2, PARTS_AND_END: 2}
VICTIMS = {"serial": (DRIVER,), PARTS_AND_END: (DRIVER,), RAY_CLUSTER: (NODE,)}
TRAIL = Path("runs") / "kills.jsonl"
HANG_S, ORPHANS_S, RUNS_PER_STEP = 300.0, 2.0, 30


@dataclass(frozen=True, slots=True)
class Kill:
    """One kill: when, with how many shards committed, and how long the workers of a dead driver went on."""

    victim: str
    after_s: float = 0.0
    committed: int = 0
    orphans_s: float = 0.0


@dataclass(slots=True)
class Siege:
    """The kills on one executor and what came of them.

    Attributes
    ----------
    reference
        The files of an undisturbed set.
    horizon_s
        How long an undisturbed run takes; a kill comes up to four fifths of it after the last (of a part: its share).
    """

    executor: str
    preset: str
    count: int
    folder: Path
    reference: Mapping[str, bytes]
    horizon_s: float
    kills: list[Kill] = field(default_factory=list)
    runs: int = 0
    sets: int = 0
    gave_up: int = 0
    wrong: list[str] = field(default_factory=list)

    def run(self) -> Self:
        """Kill until there were as many as asked for and the last set is finished."""
        chance = Random(f"kills {self.executor} {self.preset}")
        with RayCluster(self.folder) if self.executor == RAY_CLUSTER else nullcontext() as cluster:
            while len(self.kills) < self.count:
                self.sets += 1
                place = self.folder / f"{self.preset}_{self.executor.split()[0]}_{self.sets}"
                for step in steps(self.executor, place, self.preset):
                    self._until_done(step, chance, cluster)
                files = set_files(LocalFolder(place))
                self.wrong += whole_set_problems(place, files, self.reference)
        return self

    def _until_done(self, step: list[str], chance: Random, cluster: RayCluster | None) -> None:
        for _ in range(RUNS_PER_STEP):
            self.runs += 1
            done = self._disturbed(step, chance, cluster)
            self.wrong += committed_problems(set_files(LocalFolder(Path(step[1]))), self.reference)
            if done:
                return
        self.wrong.append(f"not finished after {RUNS_PER_STEP} runs: {step[0]}")

    def _disturbed(self, step: list[str], chance: Random, cluster: RayCluster | None) -> bool:
        """Run a step, with kills as long as some are to be done; tell whether it came to its end."""
        address = [] if cluster is None else ["--address", cluster.address]
        with tempfile.TemporaryFile() as said:
            started_s = time.monotonic()
            driver = start([*step, *address], said)
            while len(self.kills) < self.count:
                try:
                    driver.wait(chance.uniform(0.0, self._pause_s))
                    break
                except subprocess.TimeoutExpired:
                    kill = _kill(
                        chance.choice(VICTIMS.get(self.executor, (DRIVER, WORKER, WORKER))), driver, chance, cluster
                    )
                if kill is not None:
                    self._note(kill, Path(step[1]), time.monotonic() - started_s)
                    if kill.victim == DRIVER:
                        return False
            return self._ended(driver, said)

    @property
    def _pause_s(self) -> float:
        return 0.8 * self.horizon_s / (PARTS if self.executor == PARTS_AND_END else 1)

    def _note(self, kill: Kill, place: Path, after_s: float) -> None:
        there = committed_shards(dict.fromkeys(LocalFolder(place).names(), b""))
        self.kills.append(replace(kill, after_s=after_s, committed=len(there)))
        TRAIL.parent.mkdir(exist_ok=True)
        with TRAIL.open("a") as trail:
            facts = {
                "executor": self.executor,
                "preset": self.preset,
                "set": self.sets,
                "wrong": len(self.wrong),
                **asdict(self.kills[-1]),
            }
            trail.write(json.dumps(facts) + "\n")

    def _ended(self, driver: subprocess.Popen[bytes], said: BinaryIO) -> bool:
        try:
            code = driver.wait(HANG_S)
        except subprocess.TimeoutExpired:
            _end_family(driver, below(driver.pid))
            self.wrong.append("a hang")
            return False
        said.seek(0)
        text = said.read().decode(errors="replace")
        if code != 0:
            self.gave_up += 1
            in_words = code > 0 and "Traceback" not in text
            self.wrong += [] if in_words else [f"exit code {code}: {text.strip().splitlines()[-1:]}"]
        return code == 0

    @property
    def row(self) -> Row:
        """The line of the table."""
        victims = [kill.victim for kill in self.kills]
        counts = ", ".join(f"{victims.count(one)} {one}s" for one in (DRIVER, WORKER, NODE) if one in victims)
        orphans_s = max((kill.orphans_s for kill in self.kills), default=0.0)
        sets = f"{self.sets} sets in {self.runs} runs: all bytes those of an undisturbed one"
        wrong = f"{len(self.wrong)} wrong: {'; '.join(self.wrong[:5])}"
        ends = f"workers ended {orphans_s:.2f} s after their driver; " if DRIVER in victims else ""
        return Row(
            f"{len(self.kills)} kills, {self.preset} by {self.executor} ({counts})",
            wrong if self.wrong else sets,
            f"{ends}{self.gave_up} runs gave up in words",
            None,
            f"no other, <= {ORPHANS_S:.0f} s",
            not self.wrong and orphans_s <= ORPHANS_S and len(self.kills) >= self.count,
        )


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield a row per executor; every kill is also appended to `runs/kills.jsonl` as it happens."""
    counts = QUICK_COUNTS if quick else COUNTS
    # short, since Ray keeps sockets below it
    with tempfile.TemporaryDirectory(prefix="kills", dir="/tmp") as name:
        folder = Path(name)
        os.environ.update(OPEN, RAY_TMPDIR=str(folder / "r"))
        for preset in OVERRIDES:
            own = {"processes": EACH} if preset != "quickstart" else counts
            if quick and own is not counts:
                return
            reference, horizon_s = undisturbed(folder / preset, preset)
            for executor in [one for one in own if _installed(one)]:
                yield Siege(executor, preset, own[executor], folder, reference, horizon_s).run().row


def undisturbed(place: Path, preset: str) -> tuple[dict[str, bytes], float]:
    """Return the files of a set that nobody disturbs, and how long it takes with two worker processes."""
    for _ in range(2):  # the first one may compile
        shutil.rmtree(place, ignore_errors=True)
        started_s = time.monotonic()
        with tempfile.TemporaryFile() as said:
            start(["generate", str(place), "--preset", preset], said).wait()
    return set_files(LocalFolder(place)), time.monotonic() - started_s


def steps(executor: str, place: Path, preset: str = "quickstart") -> list[list[str]]:
    """Return the steps that make a set, each as arguments of `victim_run`; the place is the second one."""
    if executor != PARTS_AND_END:
        return [["generate", str(place), "--preset", preset, "--executor", executor.split(",", maxsplit=1)[0]]]
    parts = [["part", str(place), "--part", str(number), "--executor", "serial"] for number in range(1, PARTS + 1)]
    return [*parts, ["generate", str(place), "--executor", "serial"]]


def start(step: list[str], said: BinaryIO) -> subprocess.Popen[bytes]:
    """Start a step; what it says goes to a file."""
    command = [sys.executable, "-m", "tests.faults.victim_run", *step]
    environment = {**os.environ, **ONE_THREAD}
    return subprocess.Popen(command, env=environment, stdout=said, stderr=said, start_new_session=True)


def _kill(victim: str, driver: subprocess.Popen[bytes], chance: Random, cluster: RayCluster | None) -> Kill | None:
    """Kill a victim; None where there is none at the moment."""
    family = below(driver.pid)
    workers = [one for one in family if _works(one)]
    if driver.poll() is not None:
        return None
    if victim == NODE and cluster is not None:
        killed = cluster.kill_node()
        cluster.start_node()
        return Kill(NODE) if killed else None
    if victim == WORKER:
        if not workers:
            return None
        chance.choice(workers).kill()
        return Kill(WORKER)
    driver.kill()
    orphans_s = seconds_until_gone(workers, 10 * ORPHANS_S)
    _end_family(driver, family)
    return Kill(DRIVER, orphans_s=orphans_s)


def _works(process: Process) -> bool:
    """Tell whether it is a worker: of Dask, of Ray, whose agents have names like its workers, or the fork server's."""
    own = any(name in process.command for name in ("spawn_main", "forkserver"))
    return own or (process.command.startswith("ray::") and "Agent" not in process.command)


def _end_family(driver: subprocess.Popen[bytes], family: list[Process]) -> None:
    """End what is left of a driver's session: processes of Ray's own outlive it."""
    for one in family:
        one.kill()
    with suppress(ProcessLookupError):
        os.killpg(driver.pid, signal.SIGKILL)
    driver.wait()


def _installed(executor: str) -> bool:
    package = {"dask": "distributed", "ray": "ray", RAY_CLUSTER: "ray"}.get(executor)
    return package is None or importlib.util.find_spec(package) is not None
