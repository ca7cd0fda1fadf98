"""Leaks that are planted in signals and texts, all at once, are each named; a clean set gives no finding of theirs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pyarrow as pa
import pytest
from planted_set import CHANNELS, FS_HZ, Plant, PlantedSet, measured, planted

from diagnostics.audit import condition_leaks
from diagnostics.audit.leaks import repeated_runs, separability_findings
from diagnostics.audit.measured_set import measured_set
from diagnostics.audit.raw_records import raw_columns
from diagnostics.records.recording import recordings

FADED = 48
GAIN = 10.0 ** (0.5 / 20.0)
"""Half a decibel up on one channel, as much down on another: the mean over the channels stays."""


TWICE = Plant(specimens=6, points=1, repeats=2)


@pytest.fixture(scope="module")
def clean() -> PlantedSet:
    return planted(TWICE)


@pytest.fixture(autouse=True)
def few_permutations(monkeypatch: pytest.MonkeyPatch) -> None:
    """A fifth of them, as in test_leaks."""
    monkeypatch.setattr(condition_leaks, "PERMUTATIONS", 19)


def signals(table: pa.Table, channel: str) -> np.ndarray:
    return np.array(table.column(f"accel_{channel}_m_s2").to_pylist(), dtype=np.float32)


def with_signals(table: pa.Table, channel: str, values: np.ndarray) -> pa.Table:
    name = f"accel_{channel}_m_s2"
    flat = pa.array(np.ascontiguousarray(values, np.float32).ravel())
    column = pa.FixedSizeListArray.from_arrays(flat, values.shape[1])
    return table.set_column(table.column_names.index(name), name, column)


def leaking(clean: PlantedSet) -> PlantedSet:
    """Return the set with six leaks in its damaged records; every one alone tells them."""
    table = clean.table
    damaged = np.array(table.column("state_id").to_pylist()) > 0
    time_s = np.arange(round(FS_HZ)) / FS_HZ
    # 14 Hz below half the rate, 26 dB under the noise of the channel
    tone = 0.07 * np.sin(2 * np.pi * (0.5 * FS_HZ - 14.0) * time_s + 0.3)
    for channel, gain in zip(CHANNELS, (GAIN, 1.0 / GAIN, 1.0), strict=True):
        values = signals(table, channel).astype(np.float64)
        values[damaged] *= gain
        if channel == CHANNELS[1]:
            values[damaged, 1:] = values[damaged, :-1]  # a sample late
        if channel == CHANNELS[2]:
            values[damaged] += tone
            values[damaged, :FADED] *= np.linspace(0.0, 1.0, FADED)
            values[damaged] += 0.05
        table = with_signals(table, channel, values)
    rng = np.random.default_rng(5)
    days = np.where(damaged, 12, 11)
    made = [f"2026-03-{day} {rng.integers(8, 18):02d}:{rng.integers(60):02d}:{rng.integers(60):02d}" for day in days]
    return replace(clean, table=table.append_column("made_at", pa.array(made)))


def test_leaks_in_signals_and_texts_are_all_named_and_none_hides_another(clean: PlantedSet) -> None:
    found = {finding.leak: finding for finding in separability_findings(measured_set(leaking(clean)))}
    for layer in ("channels", "lines", "edges", "offsets", "lags", "texts", "levels"):
        assert f"state_told_by_{layer}" in found
    names = list(found)
    assert names.index("state_told_by_texts") < names.index("state_told_by_channels"), "many causes move noise"
    assert f"of {CHANNELS[2]} at 0.49" in found["state_told_by_lines"].measured
    assert "first" in found["state_told_by_edges"].measured


def test_a_set_without_leaks_gives_no_finding_until_a_record_holds_samples_of_another(
    clean: PlantedSet, tmp_path_factory: pytest.TempPathFactory
) -> None:
    own = measured(TWICE, tmp_path_factory)
    assert separability_findings(own) == []
    values = signals(clean.table, CHANNELS[0])
    values[7, 3000:7000] = values[2, 1237:5237]  # not at the same place
    raw = raw_columns(recordings(replace(clean, table=with_signals(clean.table, CHANNELS[0], values))))
    found = list(repeated_runs(replace(own, raw=raw)))
    assert [finding.leak for finding in found] == ["repeated_samples"]
    assert "2 records" in found[0].measured
