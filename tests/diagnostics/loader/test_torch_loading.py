"""What users of a torch DataLoader may expect: epochs, batch sizes, workers, labels, transforms, windows by number."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from torch.utils.data import DataLoader

from diagnostics.loader import ShardSampler, Shuffling, StreamSettings, WindowDataset, WindowStream
from siggen.errors import UsageError

Found = list[tuple[int, bytes]]


def contents(batches: Any) -> Found:
    return [
        (int(record), window.numpy().tobytes())
        for batch in batches
        for record, window in zip(batch["record_id"], batch["windows"], strict=True)
    ]


def louder(sample: dict[str, Any], generator: np.random.Generator) -> dict[str, Any]:
    """Change a window by a random gain; at the top of the module, so that worker processes can take it."""
    return {**sample, "windows": sample["windows"] * generator.uniform(0.5, 2.0)}


@pytest.mark.parametrize(
    ("batch", "options"),
    [
        (8, {}),
        pytest.param(None, {"num_workers": 2}, marks=pytest.mark.slow),
        (8, {"num_workers": 2, "persistent_workers": True}),
    ],
)
def test_every_epoch_of_a_dataloader_has_another_order_by_itself(
    dataset: Any, batch: int | None, options: dict[str, Any]
) -> None:
    def epochs() -> list[Found]:
        stream = WindowStream(dataset, "train", batch=batch)
        loader = DataLoader(stream, batch_size=None if batch else 8, **options)
        return [contents(loader) for _ in range(2)]

    first, again = epochs(), epochs()
    assert first == again
    assert first[0] != first[1]
    assert sorted(first[0]) == sorted(first[1])
    assert len(set(first[0])) == WindowStream(dataset, "train").index.size


@pytest.mark.parametrize("workers", [0, 2])
def test_batches_of_batches_are_refused_with_both_ways_out(dataset: Any, workers: int) -> None:
    loader = DataLoader(WindowStream(dataset, "train", batch=8), batch_size=4, num_workers=workers)
    with pytest.raises(UsageError, match=r"each of them is a batch already.*batch_size=None.*batch=None"):
        next(iter(loader))


def test_the_size_of_a_batch_is_that_of_the_dataloader(dataset: Any) -> None:
    sizes = [len(batch["class_id"]) for batch in DataLoader(WindowStream(dataset, "train", batch=None), batch_size=50)]
    assert sizes == [50, 50, 50, 50, 16]


def test_windows_by_number_are_those_of_the_stream_for_any_number_of_workers(dataset: Any, tmp_path: Path) -> None:
    windows = WindowDataset(dataset, "train", cache=tmp_path)
    plain = contents(DataLoader(WindowStream(dataset, "train", batch=None, shuffling=Shuffling(None)), batch_size=8))
    assert [
        (int(own["record_id"]), own["windows"].numpy().tobytes()) for own in map(windows.__getitem__, range(216))
    ] == plain
    with pytest.raises(IndexError, match="window 216 of 216"):
        windows[216]

    def epochs(workers: int, **options: Any) -> list[Found]:
        own = WindowDataset(dataset, "train", transform=louder, **options)
        loader = DataLoader(own, batch_size=16, sampler=ShardSampler(own), num_workers=workers)
        return [contents(loader) for _ in range(2)]

    one = epochs(0)
    assert one == epochs(2, cache=tmp_path)
    assert [record for record, _ in one[0]] != [record for record, _ in one[1]]
    assert not set(one[0]) & set(one[1])  # other gains in every epoch
    assert sorted(record for record, _ in one[0]) == sorted(record for record, _ in plain)


@pytest.mark.parametrize("workers", [0, pytest.param(2, marks=pytest.mark.slow)])
def test_a_transform_of_a_stream_draws_by_seed_epoch_and_window(dataset: Any, workers: int) -> None:
    def epochs(seed: int) -> list[Found]:
        stream = WindowStream(dataset, "train", batch=8, transform=louder, shuffling=Shuffling(seed))
        loader = DataLoader(stream, batch_size=None, num_workers=workers)
        return [sorted(contents(loader)) for _ in range(2)]

    alone = WindowStream(dataset, "train", batch=8, transform=louder)
    found = epochs(0)
    assert found[0] == sorted(contents(DataLoader(alone, batch_size=None)))  # whatever the number of workers
    assert found[0] != found[1]
    assert epochs(1)[0] != found[0]


def test_ranks_of_the_sampler_share_the_windows(dataset: Any) -> None:
    windows = WindowDataset(dataset, "train")
    ranks = [ShardSampler(windows, Shuffling(rank=rank, world_size=3)) for rank in range(3)]
    assert sorted(number for rank in ranks for number in rank) == list(range(len(windows)))
    assert [len(rank) for rank in ranks] == [72, 72, 72]


BOX = {"face_mm": 10.0, "height_mm": 4.0, "semi_axis_face_mm": 1.0, "semi_axis_profile_mm": 0.5, "gear": "pinion"}


class Damaged:
    """A set with teeth and outlines: record k of the training split has pits on teeth k and k + 1 of the pinion."""

    def __init__(self, dataset: Any) -> None:
        teeth = [[k, k + 1] if name != "healthy" else [] for k, name in enumerate(dataset.table["state"].to_pylist())]
        table = dataset.table.append_column("faulty_teeth_pinion", pa.array(teeth, pa.list_(pa.int32())))
        table = table.append_column("faulty_teeth_gear", pa.array([[]] * len(teeth), pa.list_(pa.int32())))
        self.dataset = replace(dataset, table=table)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.dataset, name)

    def damage(self, split: str) -> pa.Table:
        rows = self.dataset.labels(split, ["record_id", "faulty_teeth_pinion"]).to_pylist()
        return pa.Table.from_pylist(
            [
                {**BOX, "record_id": row["record_id"], "tooth": tooth, "face_mm": 10.0 + 3.0 * side + 5.0 * place}
                for row in rows
                for place, tooth in enumerate(row["faulty_teeth_pinion"])
                for side in (0, 1)
            ]
        )


def test_labels_on_request_are_those_of_the_record(dataset: Any) -> None:
    names = ("tooth_pinion", "tooth_gear", "outline_mm", "speed_hz", "torque_nm", "teeth_pinion")
    windows = WindowDataset(Damaged(dataset), "train", labels=names)
    by_record = {int(sample["record_id"]): sample for sample in map(windows.__getitem__, range(len(windows)))}
    assert [int(by_record[k]["tooth_pinion"]) for k in range(4)] == [-1, 1, 2, -1]
    assert {int(sample["tooth_gear"]) for sample in by_record.values()} == {-1}
    # pits of the lowest tooth only: centres 10 and 13 mm, 1 mm to each side
    np.testing.assert_allclose(by_record[1]["outline_mm"], [9.0, 14.0, 3.5, 4.5])
    assert np.isnan(by_record[0]["outline_mm"]).all()
    assert (float(by_record[2]["speed_hz"]), float(by_record[2]["torque_nm"])) == (30.0, 60.0)
    assert int(by_record[2]["teeth_pinion"]) == 18
    batch = next(iter(DataLoader(WindowStream(Damaged(dataset), "train", batch=8, labels=names), batch_size=None)))
    assert batch["outline_mm"].shape == (8, 4)


def test_an_unknown_label_is_named_with_the_known_ones(dataset: Any) -> None:
    with pytest.raises(UsageError, match=r"labels: received 'colour'; allowed are tooth_pinion, .*speed_hz"):
        WindowDataset(dataset, "train", labels=("colour",))


def test_the_angle_of_a_window_tells_where_tooth_0_enters(dataset: Any) -> None:
    angles = ("start_angle_rad", "tooth_0_entry_sample")
    order = WindowDataset(dataset, "train", labels=angles)
    assert {float(order[k][name]) for k in range(0, 40, 7) for name in angles} == {0.0}
    raw = WindowDataset(dataset, "train", StreamSettings(samples_per_revolution=None), labels=angles)
    for k in range(0, 40, 7):
        pulses = np.asarray(dataset.record(int(raw[k]["record_id"]))["tacho_s"])
        entry_s = (raw.index.start[k] + float(raw[k]["tooth_0_entry_sample"])) / dataset.fs_hz
        assert np.abs(pulses - entry_s).min() < 1e-9  # a pulse is where tooth 0 enters
        rest = 2 * np.pi * float(raw[k]["tooth_0_entry_sample"]) / dataset.fs_hz * 30.0
        # the shaft turns at 30 Hz within 0.1 %
        assert np.cos(float(raw[k]["start_angle_rad"]) + rest) == pytest.approx(1.0, abs=1e-4)
