"""Leaks that are planted into files: the set opens and verifies as one of siggen's, and differs by the leak alone."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq
import pytest

import siggen
from diagnostics.audit.measured_set import group_shares
from tests.command import command
from tests.dataset.fake_set import STEP_M_S2, file_bytes, write_fake_set
from tests.diagnostics.planted.fixed_leaks import FIXED_LEAKS
from tests.diagnostics.planted.further_leaks import FURTHER_LEAKS
from tests.diagnostics.planted.label_leaks import LABEL_LEAKS
from tests.diagnostics.planted.leak import Leak
from tests.diagnostics.planted.planted_copy import channel_columns, converter_step, damaged, planted, planted_copy
from tests.diagnostics.planted.signal_leaks import SIGNAL_LEAKS

IN_SIGNALS = [
    *SIGNAL_LEAKS.values(),
    *(leak for leak in FURTHER_LEAKS.values() if not leak.labels),
    *(leak for leak in FIXED_LEAKS.values() if not leak.is_grouped),
]
DAMAGED_FIRST = Leak(
    "damaged_first",
    "damaged records stand first in each file",
    labels=lambda rows, ill: rows.take(pa.array(np.argsort(~ill, kind="stable"))),
)
"""No leak: a file of siggen's holds one gearbox, whose states stand in an order by design."""
IN_LABELS = [*LABEL_LEAKS.values(), *(leak for leak in FURTHER_LEAKS.values() if leak.labels)]


@pytest.fixture(scope="module")
def source(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("planted") / "set"
    write_fake_set(path)
    return path


def test_nothing_planted_leaves_all_signals_and_labels_byte_for_byte(source: Path, tmp_path: Path) -> None:
    copy = planted_copy(source, tmp_path / "copy", Leak("", ""))
    before, after = file_bytes(source), file_bytes(copy)
    assert {name for name in before if before[name] != after[name]} <= {"labels.parquet", "manifest.json"}


@pytest.mark.parametrize(
    ("name", "changed"),
    [
        ("opposite_gains", {"accel_bearing_vertical_m_s2", "accel_bearing_horizontal_m_s2"}),
        ("date", {"recorded_on"}),
    ],
)
def test_a_planted_set_verifies_and_differs_by_the_leak_alone(
    name: str, changed: set[str], source: Path, tmp_path: Path
) -> None:
    copy = planted_copy(source, tmp_path / "copy", {**SIGNAL_LEAKS, **LABEL_LEAKS}[name])
    verified = command("siggen", "verify", str(copy), "--sample", "0")
    assert verified.returncode == 0, verified
    assert len(siggen.open(copy).labels()) == 30
    assert changed_columns(source, copy) == changed


def test_row_groups_of_damaged_records_are_seen_and_one_group_is_nothing(source: Path, tmp_path: Path) -> None:
    copy = planted_copy(source, tmp_path / "copy", FIXED_LEAKS["row_groups"])
    assert changed_columns(source, copy) == set()
    assert group_shares(siggen.open(source).row_groups()) == {}
    (shares,) = group_shares(siggen.open(copy).row_groups()).values()
    assert shares.size == len(siggen.open(copy).labels())
    assert shares.max() < 1.0


def test_labels_keep_the_order_of_the_signals(source: Path, tmp_path: Path) -> None:
    copy = planted_copy(source, tmp_path / "copy", DAMAGED_FIRST)
    before, after = siggen.open(source), siggen.open(copy)
    ids = after.labels("train")["record_id"].to_pylist()
    assert [i for batch in after.records("train") for i in batch["record_id"].to_pylist()] == ids
    assert ids != sorted(ids)
    assert after.record(ids[-1])["tacho_s"].tolist() == before.record(ids[-1])["tacho_s"].tolist()


def test_every_leak_in_signals_stays_on_the_converters_grid_and_off_healthy_records(source: Path) -> None:
    before, names = rows(source, "data"), channel_columns(source)
    assert {converter_step(np.asarray(row.values)) for name in names for row in before[name]} == {STEP_M_S2}
    for leak in IN_SIGNALS:
        after = planted(before, leak, names, fs_hz=5120.0)
        expected = np.ones(before.num_rows, bool) if leak.is_for_all else damaged(before)
        changed = [
            any(_differ(before, after, name, row) for name in (*names, "tacho_s")) for row in range(len(expected))
        ]
        assert changed == expected.tolist(), leak.name
        samples = [value for name in names for value in after[name].combine_chunks().flatten().to_numpy()]
        assert not np.any((np.array(samples, dtype=float) / STEP_M_S2) % 1.0), leak.name


def test_every_leak_in_labels_changes_labels_alone(source: Path) -> None:
    before = rows(source, "data").sort_by("record_id")
    for name in ("speed_hz", "torque_nm"):  # the fake set's are round
        index = before.schema.get_field_index(name)
        before = before.set_column(index, before.schema.field(index), pc.add(before[name], np.pi / 30.0))
    ids = before["record_id"].to_pylist()
    for leak in IN_LABELS:
        after = planted(before, leak, [], fs_hz=5120.0)
        assert _text(after) != _text(before), leak.name
        assert sorted(after["record_id"].to_pylist()) == ids, leak.name
        assert after.sort_by("record_id")["tacho_s"] == before["tacho_s"], leak.name


def _text(table: pa.Table) -> str:
    """Return schema and rows as text, in which -0.0 is not 0.0."""
    return table.schema.to_string(truncate_metadata=False) + repr(table.to_pylist())


def _differ(before: pa.Table, after: pa.Table, name: str, row: int) -> bool:
    return not np.array_equal(before[name][row].values, after[name][row].values)


def changed_columns(source: Path, copy: Path) -> set[str]:
    """Return names of columns of data or labels that are not the same in both sets."""
    changed: set[str] = set()
    for kind in ("data", "labels"):
        before, after = rows(source, kind), rows(copy, kind)
        changed |= {n for n in after.column_names if n not in before.column_names or before[n] != after[n]}
    return changed


def rows(folder: Path, kind: str) -> pa.Table:
    """Return all rows of the data or of the labels of a set."""
    files = sorted((folder / "data").glob("*.parquet")) if kind == "data" else [folder / "labels.parquet"]
    return pa.concat_tables([pq.read_table(file) for file in files])
