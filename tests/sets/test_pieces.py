"""What a run that ends early keeps of unfinished shards, what it loses, and that a set never shows any of it."""

from __future__ import annotations

import contextlib
import os
import pickle
import re
import signal
import subprocess
import sys
import time
from contextlib import AbstractContextManager
from dataclasses import replace
from pathlib import Path
from unittest.mock import patch

import pyarrow as pa
import pytest

from siggen.dataset.chunk import Chunk, ChunkSimulation
from siggen.dataset.environment import environment, fingerprint
from siggen.dataset.pieces import FOLDER, Pieces
from siggen.dataset.sealed_streams import Maker
from siggen.dataset.storage import LocalFolder
from siggen.errors import DatasetError
from siggen.planning.plan import shards
from siggen.sets import shard_making, shard_work
from siggen.sets.generation import generate
from siggen.sets.parts import generate_part, merge
from siggen.sets.set_run import Generation, InterruptionError
from siggen.sets.shard_work import PART_S, Answer, Stretch
from siggen.sets.under_way import UnderWay
from tests.dataset.fake_set import fake_config, fake_physics, file_bytes, simulate

CONFIG = fake_config(specimens=20)
"""Three shards of 12, 4 and 4 gearboxes; 120 records."""

RUN = """
import os, sys, time
from itertools import count
from siggen.errors import SiggenError
from siggen.sets.generation import generate
from tests.dataset.fake_set import fake_physics
from tests.sets.test_pieces import CONFIG, slow
if __name__ == "__main__":
    engine, workers = sys.argv[2], int(sys.argv[3])
    with fake_physics(slow):
        try:
            generate(CONFIG, sys.argv[1], workers, engine=engine)
        except SiggenError as error:
            sys.stderr.write(f"{error}\\n")
            sys.exit(error.exit_code)
"""


def slow(config, record_ids):
    """Yield a record a time that the environment says, and write its end down; clocks run as fast as it says."""
    seconds, speed = float(os.environ["SIGGEN_TEST_RECORD_S"]), float(os.environ["SIGGEN_TEST_SPEED"])
    if speed != 1.0 and not getattr(time, "is_fast", False):
        real = time.monotonic
        time.monotonic, time.is_fast = lambda: speed * real(), True  # type: ignore[attr-defined]
    for record_id in record_ids:
        time.sleep(seconds)
        with Path(os.environ["SIGGEN_TEST_DONE"]).open("a", encoding="ascii") as log:
            log.write(f"{record_id}\n")
        yield from simulate(config, [record_id])


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    path = tmp_path_factory.mktemp("sets") / "reference"
    with fake_physics():
        generate(CONFIG, path, 0)
    return file_bytes(path)


def finished(path: Path) -> Generation:
    """Finish a set by the same call, with records that take no time."""
    with fake_physics():
        return generate(CONFIG, path, 0)


class Started:
    """A run in a process of its own, whose records take a given time, and where clocks of workers are fast."""

    def __init__(self, tmp_path: Path, engine: str, workers: int, *, record_s: float, speed: float):
        self.done, self.path = tmp_path / "done", tmp_path / "set"
        self.done.touch()
        times = {"SIGGEN_TEST_RECORD_S": str(record_s), "SIGGEN_TEST_SPEED": str(speed)}
        command = [sys.executable, "-c", RUN, str(self.path), engine, str(workers)]
        facts = {**os.environ, **times, "SIGGEN_TEST_DONE": str(self.done)}
        self.process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env=facts)

    def records(self) -> list[int]:
        """Return the records that were simulated."""
        return [int(line) for line in self.done.read_text().split()]

    def wait(self, condition) -> None:
        deadline = time.monotonic() + 60
        while not condition() and self.process.poll() is None and time.monotonic() < deadline:
            time.sleep(0.01)


@pytest.mark.parametrize(("engine", "workers"), [pytest.param("serial", 0, marks=pytest.mark.slow), ("processes", 2)])
def test_ctrl_c_in_the_first_shard_loses_what_is_under_way_alone(
    tmp_path: Path, reference: dict[str, bytes], engine: str, workers: int
) -> None:
    """200 times as fast: a part ends after 50 ms, so a worker has at most some records more than that."""
    run = Started(tmp_path, engine, workers, record_s=0.02, speed=200.0)
    run.wait(lambda: len(run.records()) >= 30)
    run.process.send_signal(signal.SIGINT)
    _, said = run.process.communicate(timeout=30)
    assert run.process.returncode == 130
    made = len(run.records())
    found = re.match(r"stopped: 0 of 3 shards of .* and stay(?:, and (\d+) records of others)?; ", said)
    assert found, said
    kept = CONFIG.specimens * CONFIG.records_per_specimen - finished(run.path).records_made
    # a worker may have kept a part whose answer nobody heard any more
    assert int(found[1] or 0) <= kept <= made
    # 50 ms and a record that began before, for each worker
    assert made - kept <= max(workers, 1) * 4
    assert file_bytes(run.path) == reference
    assert not (run.path / FOLDER).exists()


@pytest.mark.slow  # Ctrl-C above, and SIGKILL of test_generation_faults.py
def test_a_killed_run_loses_no_more_than_a_part_of_each_worker(tmp_path: Path, reference: dict[str, bytes]) -> None:
    run = Started(tmp_path, "processes", 2, record_s=0.02, speed=200.0)
    run.wait(lambda: len(run.records()) >= 40)
    run.process.kill()
    run.process.communicate()
    made = len(run.records())
    assert not (run.path / "manifest.json").exists()
    again = finished(run.path)
    assert made - (CONFIG.specimens * CONFIG.records_per_specimen - again.records_made) <= 2 * 4
    assert file_bytes(run.path) == reference


@pytest.mark.parametrize(("engine", "workers"), [("serial", 0), pytest.param("processes", 2, marks=pytest.mark.slow)])
def test_records_that_take_longer_than_a_minute_are_finished_before_the_run_stops(
    tmp_path: Path, reference: dict[str, bytes], engine: str, workers: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Half a second stands for more than a minute: the limit, of the driver, is patched to 0.1 s."""
    limit = "    from siggen.sets import shard_making\n    shard_making.STOP_AT_ONCE_S = 0.1\n"
    code = RUN.replace("    engine,", f"{limit}    engine,", 1)
    monkeypatch.setattr(sys.modules[__name__], "RUN", code)
    run = Started(tmp_path, engine, workers, record_s=0.5, speed=200.0)
    run.wait(lambda: len(run.records()) >= max(workers, 1))
    time.sleep(0.3)
    run.process.send_signal(signal.SIGINT)
    _, said = run.process.communicate(timeout=30)
    assert run.process.returncode == 130
    assert "Ctrl-C once more stops at once" in said
    made = len(run.records())
    assert f"and {made} records of others; nothing is lost; the same command" in said
    assert finished(run.path).records_made == CONFIG.specimens * CONFIG.records_per_specimen - made
    assert file_bytes(run.path) == reference


def chunk_by_chunk() -> AbstractContextManager[object]:
    """Let a worker keep every chunk, that is the six records of a gearbox, as if it took long."""
    return patch.object(shard_work, "PART_BYTES", 1)


def interrupted(path: Path, after: int) -> None:
    def interrupt(done: int, total: int) -> None:
        if done >= after:
            signal.raise_signal(signal.SIGINT)

    with chunk_by_chunk(), fake_physics(), pytest.raises(InterruptionError):
        generate(CONFIG, path, 0, interrupt)


def pieces_of(path: Path) -> list[Path]:
    return sorted(file for file in (path / FOLDER).rglob("*") if file.is_file())


@pytest.mark.parametrize("change", ["flipped", "cut", "of other code", "text", "other rows"])
def test_a_piece_that_is_not_of_this_set_and_code_or_not_whole_is_made_again(
    tmp_path: Path, reference: dict[str, bytes], monkeypatch: pytest.MonkeyPatch, change: str
) -> None:
    interrupted(tmp_path, 30)
    piece = pieces_of(tmp_path)[0]
    content = piece.read_bytes()
    if change == "flipped":
        piece.write_bytes(content[:-100] + bytes([content[-100] ^ 1]) + content[-99:])
    elif change == "cut":
        piece.write_bytes(content[: len(content) // 2])
    elif change == "text":
        piece.write_bytes(b'{"digest": []}\0')
    elif change == "other rows":  # a stranger's piece in which everything fits but the records
        here = environment()
        maker = Maker(CONFIG.identity, fingerprint(here), here)
        other = ChunkSimulation(CONFIG, simulate)(Chunk("train-00000", range(6, 12)))
        Pieces(LocalFolder(tmp_path), maker, CONFIG).put([replace(other, chunk=Chunk("train-00000", range(6)))])
    else:
        monkeypatch.setattr("siggen.sets.set_run.fingerprint", lambda _: "of other sources")
    assert finished(tmp_path).records_made == (120 if change == "of other code" else 120 - 30 + 6)
    assert file_bytes(tmp_path) == reference
    assert not (tmp_path / FOLDER).exists()


def test_a_part_of_a_set_goes_on_from_its_pieces_and_merged_parts_have_none(
    tmp_path: Path, reference: dict[str, bytes]
) -> None:
    def interrupt(done: int, total: int) -> None:
        if done >= 12:
            signal.raise_signal(signal.SIGINT)

    with chunk_by_chunk(), fake_physics():
        with pytest.raises(InterruptionError, match="and 12 records of others"):
            generate_part(CONFIG, tmp_path / "1", (1, 2), 0, interrupt)
        assert generate_part(CONFIG, tmp_path / "1", (1, 2), 0).records_made == 96 - 12
        with pytest.raises(InterruptionError):
            generate_part(CONFIG, tmp_path / "2", (2, 2), 0, interrupt)
        generate_part(CONFIG, tmp_path / "2", (2, 2), 0)
        merge([tmp_path / "1", tmp_path / "2"], tmp_path / "whole")
    assert file_bytes(tmp_path / "whole") == reference


def test_an_engine_that_knows_no_parts_keeps_its_finished_chunks(tmp_path: Path, reference: dict[str, bytes]) -> None:
    class Plain:
        workers = 1

        def map(self, function, tasks):
            yield from ((index, function(task)) for index, task in enumerate(tasks))

    def interrupt(done: int, total: int) -> None:
        if done >= 30:
            signal.raise_signal(signal.SIGINT)

    with fake_physics(), pytest.raises(InterruptionError):
        generate(CONFIG, tmp_path, None, interrupt, engine=Plain())
    assert finished(tmp_path).records_made == 120 - 30
    assert file_bytes(tmp_path) == reference


def test_pieces_are_never_deleted_through_a_link_out_of_the_set(tmp_path: Path) -> None:
    interrupted(tmp_path / "set", 30)
    own = tmp_path / "own"
    (tmp_path / "set" / FOLDER).rename(own)
    (tmp_path / "set" / FOLDER).symlink_to(own)
    next(own.rglob("0*")).write_text("my diary")
    with contextlib.suppress(DatasetError):  # it says so, or makes the pieces again elsewhere
        finished(tmp_path / "set")
    assert next(own.rglob("0*")).read_text() == "my diary"


def test_what_is_lost_counts_busy_workers_since_they_last_gave_something_back() -> None:
    now_s = [100.0]
    under_way = UnderWay(3, lambda: now_s[0])
    shard = next(iter(shards(CONFIG, "train")))
    stretches = [Stretch(shard, (Chunk(shard.key, range(i, i + 1)),)) for i in range(4)]
    tasks = under_way.taken([*stretches[:3], None, stretches[3]])
    for _ in range(3):
        next(tasks)
    now_s[0] = 110.0
    under_way.hear(Answer(shard.key, worker="a 1"))
    now_s[0] = 130.0
    assert under_way.lost_s() == [20.0, 30.0]  # one of three has nothing to do: the most silent is taken for it
    assert next(tasks) is None
    next(tasks)
    assert under_way.lost_s() == [20.0, 30.0, 30.0]


def test_rows_of_a_piece_are_those_that_a_worker_gave(tmp_path: Path) -> None:
    storage, maker = LocalFolder(tmp_path), Maker(CONFIG.identity, "f", {"cpu": "c"})
    results = [ChunkSimulation(CONFIG, simulate)(Chunk("train-00000", range(i, i + 6))) for i in (0, 6)]
    Pieces(storage, maker, CONFIG).put(results)
    again = pickle.loads(pickle.dumps(Pieces(storage, maker, CONFIG)))  # as workers have it
    assert again.find(["train-00000"]) == {"train-00000": (results[0].chunk, results[1].chunk)}
    held = again.of_shard("train-00000")
    assert [held.result(one.chunk) for one in results] == results
    assert held.result(Chunk("train-00000", range(6, 9))) is None
    assert pa.record_batch(results[0].batch()).num_rows == 6
    other = Pieces(storage, replace(maker, environment={"cpu": "another"}), CONFIG)
    assert other.find(["train-00000"]) == {}
    assert storage.names() == []


def test_the_limits_keep_the_loss_of_a_worker_below_a_minute() -> None:
    """Parts and the wait for the end of a record, as they are without patches."""
    assert shard_making.STOP_AT_ONCE_S <= 50.0
    assert PART_S <= 30.0
