"""Records in blocks (`filters: blocks`) against the same records at once, and what they do not depend on."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import siggen.sensing.block_filter as block_filter
from siggen.checks.loading import load_config
from siggen.columns.record import Record, label_names
from siggen.config import Config
from siggen.record.simulation import simulate
from tests.config.minimal import minimal

SENSOR = {"place": "casing", "bits": None, "range_m_s2": 1e6}
LID = {**SENSOR, "name": "lid", "axes": ["vertical"], "position_mm": [60.0, 50.0], "cross_axis": 0.04,
       "path": {"kind": "modal", "delay_us": 63.0}, "high_pass_hz": 2.0,
       "mounting": {"frequency_hz": 9000.0, "damping_ratio": 0.05}}  # fmt: skip
PLAIN = {"name": "bearing", "bits": None, "range_m_s2": 1e6}
BASE = {"horizontal_hz": 40.0, "vertical_hz": 40.0, "rocking_hz": 40.0, "damping_ratio": 0.15}
LINES: dict[str, Any] = {"base": BASE, "shafts": {}, "second_stage": {"order": 4.13}}
ALL = {**LINES, "rubbing": {"bursts": {"rate_hz": 20.0}}, "floor": {}}
VARYING = {"speed": {"random_rms": 0.005, "ripple_once": 0.001}, "torque": {"random_rms": 0.02}}


def loaded(filters: str, *sensors: dict[str, Any], **changes: Any) -> Config:
    changes = {"dynamics__model": "casing", "duration_s": 0.4, "specimens": 2, "fs_hz": 25600.0, **changes}
    changes = {"housing": {"settle_s": 0.4}, "variation": VARYING, **changes}
    return load_config(minimal(sensors=list(sensors or (LID, PLAIN)), filters=filters, **changes))


def record(config: Config, record_id: int = 0) -> Record:
    result = simulate(config, [record_id])[0]
    assert isinstance(result, Record), result
    return result


def test_without_noise_blocks_are_the_record_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    whole, blocks = (record(loaded(filters, background=LINES)) for filters in ("record", "blocks"))
    monkeypatch.setattr(block_filter, "BLOCK_SAMPLES", 1500)
    short = record(loaded("blocks", background=LINES))
    for name, values in whole.channels.items():
        inside = slice(0, -100)  # at once, delays see the beginning behind the end
        size = values.astype(float).std()
        error = (blocks.channels[name].astype(float) - values)[inside].std() / size
        # what rings longer than 0.4 s (e^-7 of the base, of the housing's modes), the mean of the forces
        assert error < 1e-3
        # no seam: both are the same convolution, in single precision
        assert np.abs(short.channels[name].astype(float) - blocks.channels[name]).max() < 3e-6 * size
    assert set(blocks.labels) == set(whole.labels)
    equal = {name for name in whole.labels if whole.labels[name] == blocks.labels[name]}
    assert {"contact_loss_share", "mesh_hz", "start_angle_rad"} <= equal


def test_a_machine_without_base_needs_no_history() -> None:
    """`calibrate` keeps the forces of such machines: nothing reaches back before the record."""
    # at rest there is nothing that a filter would have to settle on, and without housing nothing that rings
    plain = {"background": None, "housing": None, "variation": {}, "duration_s": 0.2}
    plain |= {"internals": {"quantities": ["all"]}}
    whole, blocks = (record(loaded(filters, PLAIN, **plain)) for filters in ("record", "blocks"))
    for name, values in whole.channels.items():
        error = blocks.channels[name].astype(float) - values
        assert error.std() < 1e-3 * values.std()


def test_noise_in_blocks_has_the_power_of_noise_at_once() -> None:
    white = {"frequency_hz": [10, 12000], "density": [0.01, 0.01], "modulation": {"level_std": 0.3}}
    loud = {**LID, "pink_noise": {"density_m_s2_per_sqrt_hz": 0.02, "corner_hz": 100}, "noise_spectrum": white}
    without = {"duration_s": 2.0, "variation": {}}
    clean = {f: record(loaded(f, background=LINES, **without)) for f in ("record", "blocks")}
    noisy = {f: record(loaded(f, loud, PLAIN, background=ALL, **without)) for f in ("record", "blocks")}
    assert set(noisy["blocks"].labels) == set(label_names(loaded("blocks", loud, PLAIN, background=ALL, **without)))
    for name in ("lid_vertical", "bearing_vertical"):
        if name not in clean["blocks"].channels:
            continue
        added = {f: noisy[f].channels[name].astype(float) - clean[f].channels[name] for f in clean}
        powers = {f: np.abs(np.fft.rfft(a[:-100])) ** 2 for f, a in added.items()}
        for low, high in ((200, 800), (800, 3000), (3000, 9000)):
            band = slice(2 * low, 2 * high)
            ratio = powers["blocks"][band].mean() / powers["record"][band].mean()
            # two draws of modulated noise and bursts: 10 % of scatter
            assert ratio == pytest.approx(1.0, abs=0.35)


def test_a_record_in_blocks_depends_on_itself_alone() -> None:
    config = loaded("blocks", background=ALL, duration_s=0.2)
    together = simulate(config, [0, 1])
    with_internals = record(loaded("blocks", background=ALL, duration_s=0.2, internals={"quantities": ["all"]}))
    for found in (record(config), with_internals):
        assert isinstance(together[0], Record)
        for name, values in together[0].channels.items():
            assert found.channels[name].tobytes() == values.tobytes()
        assert {n: found.labels[n] for n in together[0].labels} == together[0].labels


def test_only_the_value_blocks_counts_in_an_identity() -> None:
    assert loaded("record").identity == load_config(minimal_without_key()).identity
    assert loaded("blocks").identity != loaded("record").identity


def minimal_without_key() -> Any:
    return minimal(
        sensors=[LID, PLAIN], dynamics__model="casing", duration_s=0.4, specimens=2, fs_hz=25600.0,
        housing={"settle_s": 0.4}, variation=VARYING,
    )  # fmt: skip
