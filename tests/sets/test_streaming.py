"""A stream gives the records of a set in an order of its own, whoever simulates them, and goes on where it was."""

from __future__ import annotations

import hashlib
import json
import os
import signal
from collections.abc import Mapping
from contextlib import closing
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import siggen
from siggen.columns.record import RecordFailure
from siggen.errors import EngineError, UsageError
from siggen.gearbox.design import SetDesign
from siggen.sets.streaming import RecordStream
from siggen.workers.process_pool import WorkerPool

COUNT, MIXED = 30, 3
CHANGES = ("specimens=4", "duration_s=0.1")


@pytest.fixture(scope="module")
def design() -> SetDesign:
    return siggen.load_config("quickstart", CHANGES)


def taken(stream: RecordStream, count: int = COUNT) -> list[dict[str, Any]]:
    with closing(iter(stream)) as records:
        return list(islice(records, count))


def digest(records: list[dict[str, Any]]) -> str:
    found = hashlib.sha256()
    for record in records:
        for name, value in record.items():
            found.update(name.encode())
            found.update(value.tobytes() if isinstance(value, np.ndarray) else repr(value).encode())
    return found.hexdigest()


@pytest.fixture(scope="module")
def serial(design: SetDesign) -> list[dict[str, Any]]:
    return taken(siggen.stream(design, mixed=MIXED, executor="serial"))


def test_streamed_records_are_those_of_the_set_with_as_many_gearboxes(
    design: SetDesign, serial: list[dict[str, Any]], tmp_path: Path
) -> None:
    siggen.generate(siggen.load_config("quickstart", ("specimens=7", *CHANGES[1:])), tmp_path / "set", workers=0)
    stored = siggen.open(tmp_path / "set")
    gearboxes = {record["specimen_id"] for record in serial}
    assert min(gearboxes) == design.specimens  # none of the set
    behind = [record for record in serial if record["specimen_id"] < 7]
    assert len(behind) == MIXED * design.records_per_specimen
    assert digest(behind) == digest([stored.record(record["record_id"]) for record in behind])
    ids = [record["record_id"] for record in behind]
    assert ids != sorted(ids)
    assert len(set(ids)) == len(ids)


@pytest.mark.parametrize("workers", [1, 2, 4])
def test_order_and_samples_depend_on_no_number_of_workers(
    design: SetDesign, serial: list[dict[str, Any]], workers: int
) -> None:
    assert digest(taken(siggen.stream(design, mixed=MIXED, workers=workers))) == digest(serial)


def test_a_stream_goes_on_from_a_place_that_was_stored(design: SetDesign, serial: list[dict[str, Any]]) -> None:
    first = siggen.stream(design, mixed=MIXED, executor="serial")
    begun = taken(first, 17)
    second = siggen.stream(design, mixed=MIXED, executor="serial")
    second.load_state_dict(json.loads(json.dumps(first.state_dict())))
    assert digest(begun + taken(second, COUNT - 17)) == digest(serial)
    assert digest(taken(first, COUNT - 17)) == digest(serial[17:])  # and so does the first one


def test_a_worker_that_dies_changes_nothing(
    design: SetDesign, serial: list[dict[str, Any]], monkeypatch: pytest.MonkeyPatch
) -> None:
    pools, real = list[WorkerPool](), WorkerPool.submit

    def submitted(pool: WorkerPool, *given: Any) -> Any:
        pools.append(pool)
        return real(pool, *given)

    monkeypatch.setattr(WorkerPool, "submit", submitted)
    with closing(iter(siggen.stream(design, mixed=MIXED, workers=2))) as records:
        begun = list(islice(records, 5))
        os.kill(next(iter(pools[-1]._processes)), signal.SIGKILL)
        assert digest(begun + list(islice(records, COUNT - 5))) == digest(serial)
    assert len({id(pool) for pool in pools}) >= 2  # another one went on


def test_ranks_share_the_gearboxes(design: SetDesign) -> None:
    streams = [siggen.stream(design, mixed=2, rank=rank, ranks=2, executor="serial") for rank in range(2)]
    shares = [{record["specimen_id"] for record in taken(one, 10)} for one in streams]
    assert shares == [{4, 5}, {6, 7}]


def test_a_stream_has_one_reader(design: SetDesign, serial: list[dict[str, Any]]) -> None:
    stream = siggen.stream(design, mixed=MIXED, executor="serial")
    with closing(iter(stream)) as first, closing(iter(stream)) as second:
        begun = [next(first), next(first)]
        begun.append(next(second))  # which takes the place over
        with pytest.raises(UsageError, match=r"^the stream: received another loop or another place"):
            next(first)
        assert digest([*begun, *islice(second, 5)]) == digest(serial[:8])
        stream.load_state_dict(stream.state_dict())
        with pytest.raises(UsageError, match=r"one loop at a time"):
            next(second)


def test_gearboxes_that_all_fail_end_the_stream_with_the_first_reason(
    design: SetDesign, monkeypatch: pytest.MonkeyPatch
) -> None:
    def failing(_: SetDesign, ids: range) -> list[RecordFailure]:
        return [RecordFailure(number, "diverged", "it is only asked for") for number in ids]

    monkeypatch.setattr("siggen.sets.drawn.simulated", failing)
    stream = siggen.stream(design, mixed=2, executor="serial")
    with pytest.raises(EngineError, match=r"^no record of 2 gearboxes.*the first is diverged: it is only asked for"):
        next(iter(stream))
    assert len(stream.failures) == 2 * design.records_per_specimen


REFUSED: Mapping[str, Mapping[str, Any]] = {
    r"^workers: received 0; allowed: whole numbers from 1.*executor='serial' simulates in this process": {"workers": 0},
    r"^workers: received 1.5; allowed: whole numbers from 1": {"workers": 1.5},
    r"^mixed: received 0; allowed: whole numbers from 1": {"mixed": 0},
    r"^rank: received 2; allowed: whole numbers from 0 to 1": {"rank": 2, "ranks": 2},
    r"^first_gearbox: received -1; allowed: whole numbers from 0": {"first_gearbox": -1},
    r"^seed: received 'a'": {"seed": "a"},
}


@pytest.mark.parametrize("message", REFUSED)
def test_arguments_that_cannot_be_are_refused_in_words(design: SetDesign, message: str) -> None:
    with pytest.raises(UsageError, match=message):
        siggen.stream(design, **REFUSED[message])


def test_lives_and_plain_gearboxes_are_refused_and_so_is_the_place_of_another_stream(design: SetDesign) -> None:
    with pytest.raises(UsageError, match=r"^design: received 'quickstart'; allowed: what siggen.load_config returns"):
        siggen.stream("quickstart")  # type: ignore[arg-type]
    healthy = siggen.load_config({**design.canonical(), "states": {"healthy": {}}})
    with pytest.raises(UsageError, match=r"^design: received states without damage"):
        siggen.stream(healthy)
    stream = siggen.stream(design, executor="serial")
    with pytest.raises(UsageError, match=r"belongs to another stream: it has seed 3 instead of 0"):
        stream.load_state_dict({**stream.state_dict(), "seed": 3})
    with pytest.raises(UsageError, match=r"belongs to another stream: it has passed -1"):
        stream.load_state_dict({**stream.state_dict(), "passed": -1})
