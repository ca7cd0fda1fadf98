"""The loader delivers every window once, in a repeatable order, and goes on where it was interrupted."""

from __future__ import annotations

import itertools
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diagnostics.loader.epoch_order import Lane, Shuffling, epoch_chunks, lane_sizes
from diagnostics.loader.window_index import StreamSettings, window_index
from diagnostics.loader.window_stream import WindowLoader, WindowStream
from siggen.errors import DatasetError, UsageError


def contents(batches: Any) -> list[tuple[int, bytes]]:
    """Records and samples of all windows, in the order of delivery."""
    return [
        (int(record), window.numpy().tobytes())
        for batch in batches
        for record, window in zip(batch["record_id"], batch["windows"], strict=True)
    ]


def loader(dataset: Any, workers: int = 0, **options: Any) -> WindowLoader:
    return WindowLoader(WindowStream(dataset, "train", batch=8, **options), workers)


@given(
    counts=st.lists(st.integers(0, 12), max_size=12),
    world_size=st.integers(1, 4),
    workers=st.integers(1, 4),
    batch=st.integers(1, 7),
    epoch=st.integers(0, 3),
    buffer_windows=st.integers(1, 30),
    seed=st.none() | st.integers(0, 5),
)
def test_parts_share_the_windows_without_gap_or_double(
    counts: list[int],
    world_size: int,
    workers: int,
    batch: int,
    epoch: int,
    buffer_windows: int,
    seed: int | None,
) -> None:
    group = np.repeat(np.arange(len(counts)), counts)
    found = []
    for rank in range(world_size):
        shuffling = Shuffling(seed, buffer_windows, rank, world_size)
        lanes = [epoch_chunks(group, epoch, Lane(worker, workers), batch, shuffling) for worker in range(workers)]
        chunks = [chunk for lane in lanes for chunk in lane]
        assert all(chunk.size < buffer_windows + max(counts) for chunk in chunks)
        assert all(np.unique(group[chunk]).size <= buffer_windows for chunk in chunks)
        found.append([np.concatenate([*lane, np.empty(0, dtype=int)]) for lane in lanes])
    assert sorted(np.concatenate([*itertools.chain(*found)]).tolist()) == list(range(group.size))
    sizes = [sum(lane.size for lane in lanes) for lanes in found]
    assert max(sizes) - min(sizes) <= 1


@given(windows=st.integers(0, 200), batch=st.integers(1, 20), workers=st.integers(1, 6))
def test_workers_have_their_batches_strictly_in_turn(windows: int, batch: int, workers: int) -> None:
    batches = -(-lane_sizes(windows, batch, workers) // batch)
    total = -(-windows // batch)
    assert batches.tolist() == [len(range(worker, total, workers)) for worker in range(workers)]


@pytest.mark.parametrize(("world_size", "workers"), [(1, 0), (2, 0), pytest.param(3, 2, marks=pytest.mark.slow)])
def test_every_window_comes_once_per_epoch(dataset: Any, world_size: int, workers: int) -> None:
    expected = sorted(contents(loader(dataset, shuffling=Shuffling(seed=None))))
    assert len(set(expected)) == len(expected) == window_index(dataset, "train", StreamSettings()).size
    ranks = [
        loader(dataset, workers, shuffling=Shuffling(rank=rank, world_size=world_size)) for rank in range(world_size)
    ]
    found = [contents(rank) for rank in ranks]
    assert sorted(itertools.chain(*found)) == expected
    assert max(map(len, found)) - min(map(len, found)) <= 1


@pytest.mark.parametrize("workers", [0, pytest.param(2, marks=pytest.mark.slow)])
def test_same_seed_same_order_and_another_epoch_another_one(dataset: Any, workers: int) -> None:
    first, second = (loader(dataset, workers) for _ in range(2))
    epochs = [contents(first), contents(first)]
    assert epochs == [contents(second), contents(second)]
    assert epochs[0] != epochs[1]
    assert contents(loader(dataset, workers, shuffling=Shuffling(seed=1))) != epochs[0]
    records = [record for record, _ in epochs[0]]
    assert records != sorted(records)


# three workers on a machine with fewer cores are slow, not wrong, and unequal lanes need three
@pytest.mark.filterwarnings("ignore:This DataLoader will create")
@pytest.mark.parametrize(("workers", "taken"), [(0, 11), pytest.param(3, 7, marks=pytest.mark.slow)])
def test_a_resumed_epoch_gives_the_same_remainder(dataset: Any, workers: int, taken: int) -> None:
    whole = loader(dataset, workers)
    contents(whole)  # the second epoch, so that the epoch has to be resumed too
    expected = contents(whole)
    interrupted = loader(dataset, workers)
    contents(interrupted)
    first = contents(itertools.islice(interrupted, taken))
    resumed = loader(dataset, workers)
    resumed.load_state_dict(interrupted.state_dict())
    assert first + contents(resumed) == expected
    assert contents(resumed) == contents(whole)  # and the epoch after it


@pytest.mark.parametrize(
    ("workers", "pieces"), [(0, (0, 5)), (0, (27, 0)), pytest.param(2, (3, 1), marks=pytest.mark.slow)]
)
def test_an_epoch_that_is_interrupted_twice_loses_and_repeats_nothing(
    dataset: Any, workers: int, pieces: tuple[int, int]
) -> None:
    whole = loader(dataset, workers)
    assert len(whole) == 27  # so that one case stops behind the last batch, before the epoch is over
    expected, following = contents(whole), contents(whole)
    found, state = [], whole.state_dict() | {"epoch": 0}
    for taken in pieces:
        part = loader(dataset, workers)
        part.load_state_dict(json.loads(json.dumps(state)))
        found += contents(itertools.islice(part, taken)) if taken else []
        state = part.state_dict()
    last = loader(dataset, workers)
    last.load_state_dict(state)
    assert found + contents(last) == expected
    assert contents(last) == following


def test_a_position_of_another_loader_is_refused(dataset: Any) -> None:
    state = loader(dataset, 2).state_dict()
    with pytest.raises(UsageError, match="it has workers 2 instead of 0"):
        loader(dataset).load_state_dict(state)


def test_the_cache_gives_the_same_windows_and_is_read_without_the_set(
    dataset: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    expected = contents(loader(dataset))
    assert sorted(contents(loader(dataset, 2, cache=tmp_path))) == sorted(expected)
    files = sorted(tmp_path.rglob("*"))
    assert [path.suffix for path in files if path.is_file()] == [".f32"] * 6  # 36 records in groups of 7
    again = loader(dataset, cache=tmp_path)

    def unreadable(*_: Any) -> None:
        raise AssertionError("the set was read although the cache is complete")

    monkeypatch.setattr(type(dataset), "shard_rows", unreadable)
    assert contents(again) == expected


def chirped(dataset: Any) -> Any:
    """The same set with one order 7.25 of a shaft that speeds up from 25 to 40 Hz, with its exact pulse times."""
    samples = round(dataset.duration_s * dataset.fs_hz)
    time_s = np.arange(samples) / dataset.fs_hz
    turns = 25.0 * time_s + 7.5 * time_s**2
    pulses = np.arange(np.floor(turns[-1]) + 1)
    tacho_s = (-25.0 + np.sqrt(25.0**2 + 30.0 * pulses)) / 15.0
    signal = np.cos(2 * np.pi * 7.25 * turns).astype(np.float32)
    table = dataset.table.filter(pa.array(np.arange(dataset.table.num_rows) < 2))
    for name in ("accel_bearing_vertical_m_s2", "accel_bearing_horizontal_m_s2"):
        column = pa.FixedSizeListArray.from_arrays(pa.array(np.tile(signal, 2)), samples)
        table = table.set_column(table.schema.get_field_index(name), name, column)
    column = pa.array([tacho_s.tolist()] * 2)
    return type(dataset)(table.set_column(table.schema.get_field_index("tacho_s"), "tacho_s", column))


def test_a_chirp_becomes_a_line_in_the_order_domain(dataset: Any) -> None:
    # 8 revolutions resolve order 1/8, so order 7.25 lies on bin 58; the second bin from it would hold a chirp's skirt
    settings = StreamSettings(samples_per_revolution=64)
    batch = next(iter(WindowLoader(WindowStream(chirped(dataset), "train", settings, batch=3))))
    assert batch["windows"].shape == (3, 2, 8 * 64)
    amplitude = np.abs(np.fft.rfft(batch["windows"].numpy(), axis=2)) / 256.0
    np.testing.assert_allclose(amplitude[:, :, 58], 1.0, atol=5e-3)
    amplitude[:, :, 58] = 0.0
    assert amplitude.max() < 5e-3

    raw = StreamSettings(samples_per_revolution=None)
    taken = next(iter(WindowLoader(WindowStream(chirped(dataset), "train", raw, batch=3))))["windows"].numpy()
    spectrum = np.abs(np.fft.rfft(taken, axis=2)) / (taken.shape[2] / 2)
    assert spectrum.max() < 0.7  # the same records without the resampling: smeared


def test_windows_as_taken_hold_their_revolutions_where_the_shaft_is_slowest(dataset: Any) -> None:
    index = window_index(dataset, "train", StreamSettings(samples_per_revolution=None, revolutions=10))
    assert index.samples == pytest.approx(10 / 30.0 * dataset.fs_hz, rel=0.01)
    assert (index.start + index.samples).max() <= dataset.duration_s * dataset.fs_hz


def test_fewer_than_eight_revolutions_are_refused() -> None:
    with pytest.raises(UsageError, match="revolutions: received 4; allowed are 8 or more"):
        StreamSettings(revolutions=4)


def test_records_without_a_whole_window_are_an_error_with_a_way_out(make_dataset: Callable[..., Any]) -> None:
    with pytest.raises(
        DatasetError, match=r"no record of split 'train' holds 8 whole turns of the first shaft.*duration_s"
    ):
        WindowStream(make_dataset(("train",), duration_s=0.2), "train")
