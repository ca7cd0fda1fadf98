"""A stream gives the records of a set in an order of its own, whoever simulates them, and goes on where it was."""

from __future__ import annotations

import hashlib
import json
import os
import signal
import subprocess
import sys
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

COUNT, MIXED = 30, 2
QUICKEST = "tests/configs/linear_pits.yaml"
CHANGES = ("specimens=4", "duration_s=0.1")
"""8 records of a gearbox in 0.3 s of CPU; streams do not ask what a record follows from."""


@pytest.fixture(scope="module")
def design() -> SetDesign:
    return siggen.load_config(QUICKEST, CHANGES)


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
    siggen.generate(siggen.load_config(QUICKEST, ("specimens=6", *CHANGES[1:])), tmp_path / "set", workers=0)
    stored = siggen.open(tmp_path / "set")
    assert min(record["specimen_id"] for record in serial) == design.specimens  # none of the set
    mixed = serial[: MIXED * design.records_per_specimen]
    assert digest(mixed) == digest([{**stored.record(record["record_id"]), "renewal": 0} for record in mixed])
    ids = [record["record_id"] for record in mixed]
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


def test_renewals_move_as_their_record_and_have_noise_of_their_own(
    design: SetDesign, serial: list[dict[str, Any]]
) -> None:
    given = {"mixed": 1, "renewals": 7}
    stream = siggen.stream(design, **given, executor="serial")
    found = taken(stream, 64)
    first = {record["record_id"]: record for record in serial}
    assert sorted((record["record_id"], record["renewal"]) for record in found) == [
        (number, renewal) for number in sorted(first)[:8] for renewal in range(8)
    ]
    renewed = design.gearbox(4).renewed
    gains = [design.gearbox(4).channels[0].gain, *(renewed(number)[0].gain for number in range(1, 8))]
    for record in found:
        one, channel = first[record["record_id"]], "bearing_vertical"
        if record["renewal"] == 0:
            assert digest([record]) == digest([one])
            continue
        differing = {name for name in one if not np.array_equal(one[name], record[name])}
        assert all(name == "renewal" or "bearing_" in name for name in differing)
        # what is read without noise: the same motion, times the gain
        silent = [
            10.0 ** (own[f"snr_{channel}_db"] / 20.0) * own[f"noise_floor_{channel}_m_s2"] / gains[own["renewal"]]
            for own in (one, record)
        ]
        assert silent[1] == pytest.approx(silent[0], rel=1e-9)
    noise = np.array([record["accel_bearing_vertical_m_s2"] for record in found if record["record_id"] == 32])
    assert len(np.unique(noise[:, 0])) == len(noise)
    begun = siggen.stream(design, **given, workers=2)
    assert digest(taken(begun, 21)) == digest(found[:21])
    last = siggen.stream(design, **given, executor="serial")
    last.load_state_dict(begun.state_dict())
    assert digest(taken(last, 43)) == digest(found[21:])


def test_noise_and_gains_of_renewals_have_the_laws_of_the_set(design: SetDesign) -> None:
    from scipy.stats import kstest, loguniform, truncnorm

    found = taken(siggen.stream(design, mixed=1, renewals=50, executor="serial"), 8 * 51)
    floors = [record["noise_floor_bearing_vertical_m_s2"] for record in found]
    assert kstest(floors, loguniform(1.0, 20.0).cdf).pvalue > 0.01
    renewed = design.gearbox(4).renewed
    gains = [channel.gain for number in range(1, 401) for channel in renewed(number)]
    assert kstest(gains, truncnorm(-2.5, 2.5, 1.0, 0.02).cdf).pvalue > 0.01


def test_a_script_that_workers_cannot_import_is_told_the_line_that_it_lacks(tmp_path: Path) -> None:
    script = tmp_path / "unguarded.py"
    made = f"siggen.stream(siggen.load_config({str(Path(QUICKEST).resolve())!r}, ['duration_s=0.1']), workers=1)"
    script.write_text(f"import siggen\nnext(iter({made}))\n", encoding="utf-8")
    said = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=300, check=False).stderr
    assert said.splitlines()[-1].endswith('Put what calls siggen below the line `if __name__ == "__main__":`')
    assert said.count("Traceback") == 1  # of the script, none of workers


def test_a_stream_says_where_it_is(design: SetDesign) -> None:
    stream = siggen.stream(design, mixed=2, rank=1, ranks=2, executor="serial")
    assert repr(stream) == "<stream of linear_pits: 0 records given, next those of gearboxes 6 to 7>"
    stream.load_state_dict({**stream.state_dict(), "passed": 17})
    assert repr(stream) == "<stream of linear_pits: 17 records given, next those of gearboxes 10 to 11>"


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
    r"^renewals: received 401; allowed: whole numbers from 0 to 400": {"renewals": 401},
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
