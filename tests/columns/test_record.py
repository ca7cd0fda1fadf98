"""Columns, their order and metadata, and what may not become a row."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pyarrow as pa
import pytest

from siggen.columns.damage import DAMAGE_COLUMNS
from siggen.columns.record import (
    damage_schema,
    label_schema,
    non_finite,
    record_batch,
    record_schema,
    signal_matrix,
)
from siggen.errors import DatasetError
from siggen.gearbox.plan import planned_record
from siggen.sets.drawn import set_columns
from tests.dataset.fake_set import fake_config, fake_record, simulate
from tests.simulated import label_names

CONFIG = fake_config()
COLUMNS = set_columns(CONFIG)


def test_columns_come_as_ids_labels_operating_channel_labels_signals_tacho() -> None:
    names = record_schema(COLUMNS).names
    landmarks = [
        "record_id", "split", "fault", "status", "teeth_pinion", "start_angle_rad", "noise_floor_bearing_vertical_m_s2",
        "clipped_share_bearing_horizontal", "accel_bearing_vertical_m_s2", "accel_bearing_horizontal_m_s2", "tacho_s",
    ]  # fmt: skip
    assert [names.index(name) for name in landmarks] == sorted(names.index(name) for name in landmarks)
    assert names[0] == "record_id"
    assert names[-1] == "tacho_s"
    assert label_schema(COLUMNS).names == names[: names.index("accel_bearing_vertical_m_s2")]


def test_signals_are_fixed_size_lists_without_nulls_that_say_what_they_are() -> None:
    schema = record_schema(COLUMNS)
    field = schema.field("accel_bearing_horizontal_m_s2")
    assert field.type.list_size == CONFIG.samples == 512
    assert field.type.value_type == pa.float32()
    assert not field.type.value_field.nullable
    assert field.metadata == {
        b"sensor": b"bearing",
        b"place": b"pinion_bearing", b"axis": b"horizontal", b"quantity": b"acceleration",
        b"unit": b"m/s^2", b"fs_hz": b"5120.0", b"converter_step": b"0.015625",
        b"role": b"signal",
    }  # fmt: skip
    assert not any(f.nullable for f in [*schema, *damage_schema(COLUMNS)])
    assert schema.metadata[b"siggen.identity"].decode() == CONFIG.identity
    assert schema.metadata[b"fs_hz"] == b"5120.0"


def test_a_batch_holds_exactly_what_the_records_hold() -> None:
    records = [fake_record(CONFIG, planned_record(CONFIG, i)) for i in range(4)]
    batch = record_batch(COLUMNS, records)
    assert batch.schema.equals(record_schema(COLUMNS), check_metadata=True)
    signals = np.stack([record.channels["bearing_vertical"] for record in records])
    assert signal_matrix(batch["accel_bearing_vertical_m_s2"]).tobytes() == signals.tobytes()
    for row, record in zip(batch.to_pylist(), records, strict=True):
        assert {name: row[name] for name in label_names(CONFIG)} == dict(record.labels)
        assert row["specimen_id"] == record.planned.specimen_id
        assert row["tacho_s"] == list(record.tacho_s)


def test_a_slice_of_a_signal_column_gives_only_its_own_rows() -> None:
    batch = record_batch(COLUMNS, simulate(CONFIG, range(5)))
    whole = signal_matrix(batch["accel_bearing_vertical_m_s2"])
    part = signal_matrix(batch.slice(2, 2)["accel_bearing_vertical_m_s2"])
    assert part.shape == (2, 512)
    assert np.array_equal(part, whole[2:4])


def test_no_records_make_an_empty_batch_of_the_same_schema() -> None:
    batch = record_batch(COLUMNS, [])
    assert batch.num_rows == 0
    assert batch.schema.equals(record_schema(COLUMNS))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda r: replace(r, labels={k: v for k, v in r.labels.items() if k != "fault"}), "fault"),
        (lambda r: replace(r, labels={**r.labels, "colour": "red"}), "colour"),
        (lambda r: replace(r, labels={**r.labels, "fault": None}), "nulls"),
        (lambda r: replace(r, labels={**r.labels, "torque_nm": float("nan")}), "torque_nm"),
        (lambda r: replace(r, channels={"bearing_vertical": r.channels["bearing_vertical"]}), "bearing_horizontal"),
        (lambda r: replace(r, channels={k: v[:-1] for k, v in r.channels.items()}), r"\(511,\)"),
        (lambda r: replace(r, channels={k: v.astype(float) for k, v in r.channels.items()}), "float64"),
        (lambda r: replace(r, channels={k: v * np.float32("inf") for k, v in r.channels.items()}), "not finite"),
    ],
)
def test_an_incomplete_or_non_finite_record_never_becomes_a_row(change, message) -> None:
    record = change(fake_record(CONFIG, planned_record(CONFIG, 0)))
    with pytest.raises(DatasetError, match=message):
        record_batch(COLUMNS, [record])


def test_an_infinite_signal_to_noise_ratio_is_allowed_since_noise_may_be_absent() -> None:
    record = fake_record(CONFIG, planned_record(CONFIG, 0))
    noiseless = replace(record, labels={**record.labels, "snr_bearing_vertical_db": float("inf")})
    assert non_finite(noiseless) == ""
    assert record_batch(COLUMNS, [noiseless])["snr_bearing_vertical_db"].to_pylist() == [float("inf")]


def test_damage_rows_name_their_record_and_lengths_carry_their_unit() -> None:
    assert DAMAGE_COLUMNS[0].name == "record_id"
    assert all(column.unit == "mm" for column in DAMAGE_COLUMNS if column.name.endswith("_mm"))
