"""The network on averages: its rows, its shaft without a beginning, and that it finds what a level does not show."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch

from diagnostics.signal.shaft_signals import separated_average
from diagnostics.statistics.evaluation import Predictions, macro_auroc
from diagnostics.training.average_rows import (
    STEPS,
    AveragedRecords,
    average_rows,
    moved,
    padded_lines,
    with_references,
)
from diagnostics.training.circular_files import load_circular, save_circular
from diagnostics.training.circular_network import (
    CircularNetwork,
    CircularSettings,
    circular_predictions,
    circular_probability,
    train_circular,
)
from diagnostics.training.circular_training import TrainedCircularFile
from diagnostics.training.splits import SpecimenSplit
from siggen.errors import UsageError

ANGLE = 2 * np.pi * np.arange(STEPS) / STEPS
CLASSES = ("healthy", "damaged")


def records_of(signals: np.ndarray, teeth: int) -> AveragedRecords:
    """Return (records, channels, 1024) averages by their lines, as the table of a set keeps them."""
    lines = (2.0 * np.fft.rfft(signals, axis=2) / STEPS).astype(np.complex64)
    return AveragedRecords(padded_lines(lines), np.full(len(lines), teeth), ("lid",) * signals.shape[1])


@pytest.mark.parametrize("teeth", [17, 18, 31])
def test_rows_are_the_average_and_its_residual_whatever_the_teeth(teeth: int) -> None:
    rng = np.random.default_rng(0)
    average = sum(a * np.cos(k * ANGLE + 6.3 * b) for k, (a, b) in enumerate(rng.random((360, 2))) if k)
    found = average_rows(records_of(average[None, None], teeth))[0]
    # float32 lines of size 1: 360 of them round to some 1e-6 each
    np.testing.assert_allclose(found[0], average, atol=1e-4)
    np.testing.assert_allclose(found[1], separated_average(average, teeth).residual, atol=1e-4)


def test_whitening_takes_a_smooth_path_away_and_leaves_the_shape_of_an_event() -> None:
    event = np.zeros(STEPS)
    event[700] = 1.0
    orders = np.arange(STEPS // 2 + 1)
    heard = np.fft.irfft(np.fft.rfft(event) * np.exp(-(((orders - 150) / 120.0) ** 2)) * 40.0)  # 17 dB down at order 0
    plain, rung = (average_rows(records_of(signal[None, None], 600))[0, 2] for signal in (event, heard))
    # of a spike, every line from order 3 on is as strong: flat already
    assert np.corrcoef(plain[690:710], event[690:710])[0, 1] > 0.95
    carried = (plain @ rung) / np.linalg.norm(plain) / np.linalg.norm(rung)
    assert carried > 0.85
    assert carried > 1.05 * (event @ heard) / np.linalg.norm(event) / np.linalg.norm(heard)


def test_beside_a_healthy_record_what_both_share_is_gone() -> None:
    rng = np.random.default_rng(1)
    signals = rng.standard_normal((3, 2, STEPS))
    signals[1] = signals[0]
    alone = records_of(signals, 18)
    found = with_references(alone, np.array([0, 2]), [np.array([1]), np.array([0, 1])])
    through_a_path = moved(found, np.random.default_rng(2), gain_db=3.0)
    for records in (found, through_a_path):  # a gearbox has one path: record and reference pass the same
        rows = average_rows(records)
        assert rows.shape == (2, 12, STEPS)
        for shared in (rows[0, 4:8], rows[0, 10:]):  # difference, its residual, and that whitened; 2 channels each
            np.testing.assert_allclose(shared, 0.0, atol=1e-4)
        assert rows[1, 4:8].std() > 0.5
        assert rows[1, 10:].std() > 0.5
    assert found.healthy is not None
    np.testing.assert_allclose(found.healthy[1], alone.lines[0], rtol=1e-6)


@pytest.mark.parametrize("steps", [16, 512, 1008])
def test_where_the_revolution_begins_does_not_matter(steps: int) -> None:
    torch.manual_seed(0)
    network = CircularNetwork(rows=6, classes=3).eval()
    rows = torch.randn(5, 6, STEPS)
    with torch.no_grad():  # 16 steps: the product of all strides; float32 in another order of summation
        torch.testing.assert_close(network(torch.roll(rows, steps, 2)), network(rows), atol=1e-5, rtol=1e-4)


def planted(gearboxes: int, rng: np.random.Generator) -> tuple[AveragedRecords, np.ndarray, np.ndarray]:
    """Return averages with mesh lines and noise; damaged ones have a burst of 4 degrees and no more energy."""
    signals, damaged = [], np.arange(2 * gearboxes) % 2
    for state in damaged:
        mesh = sum(rng.uniform(0.5, 2.0) * np.cos(18 * h * ANGLE + 6.3 * rng.random()) for h in (1, 2, 3))
        noise = rng.standard_normal(STEPS)
        if state:
            burst = np.exp(-0.5 * ((np.arange(STEPS) - STEPS // 2) / 4.0) ** 2) * np.cos(200 * ANGLE)
            noise += 4.0 * np.roll(burst, rng.integers(STEPS))
        signals.append(mesh * 5.0 + noise / noise.std() * rng.uniform(0.1, 0.3))
    return records_of(np.array(signals)[:, None], 18), damaged, np.arange(2 * gearboxes) // 2


def planted_split(specimen: np.ndarray, train: int, validation: int) -> SpecimenSplit:
    held = specimen >= train + validation
    return SpecimenSplit(specimen < train, (specimen >= train) & ~held, held, CLASSES, "healthy")


def area(found: Predictions) -> float:
    return float(macro_auroc(found, np.ones((1, found.truth.size)))[0])


def test_a_burst_without_more_energy_is_found_on_other_gearboxes_by_the_labels_alone(tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    records, damaged, specimen = planted(90, rng)
    split = planted_split(specimen, 40, 10)
    test = np.flatnonzero(split.test)
    state = torch.random.get_rng_state()
    settings = CircularSettings(most_epochs=25)
    first = train_circular(records, damaged, split, 7, settings)
    assert torch.equal(state, torch.random.get_rng_state())  # the caller's generator is left alone
    assert area(circular_predictions(first, records, test, damaged, specimen)) > 0.9
    # Labels the other way round where it learns: whoever sees those alone names every test record the other way round.
    # Permuted labels would leave a chance correlation with the burst, whose sign hangs on last bits.
    turned = np.where(split.test, damaged, 1 - damaged)
    blind = train_circular(records, turned, split, 7, settings)
    assert area(circular_predictions(blind, records, test, damaged, specimen)) < 0.1

    kept = TrainedCircularFile(replace(first, temperature=0.8), records.channels, "identity")
    save_circular(kept, tmp_path / "circular.safetensors")
    network, facts = load_circular(tmp_path / "circular.safetensors")
    assert (facts.classes, facts.channels, facts.temperature) == (CLASSES, ("lid",), 0.8)
    np.testing.assert_array_equal(circular_probability(network, records), circular_probability(first.network, records))


def test_the_same_seed_gives_the_same_network() -> None:
    records, damaged, specimen = planted(12, np.random.default_rng(4))
    split = planted_split(specimen, 8, 2)
    first, second = (train_circular(records, damaged, split, 5, CircularSettings(most_epochs=2)) for _ in range(2))
    for name, value in first.network.state_dict().items():
        assert torch.equal(value, second.network.state_dict()[name]), name
    assert first.validation_loss == second.validation_loss


def test_a_file_of_another_network_is_not_read(tmp_path: Path) -> None:
    from safetensors.numpy import save_file

    save_file({"x": np.zeros(3)}, tmp_path / "other.safetensors")
    with pytest.raises(UsageError, match="received format None; allowed is 'siggen-diagnostics circular network 1'"):
        load_circular(tmp_path / "other.safetensors")
