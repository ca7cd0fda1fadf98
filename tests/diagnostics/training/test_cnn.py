"""The network on averages: its rows, its shaft without a beginning, and that it finds what a level does not show."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch

from diagnostics.signal.shaft_signals import separated_average
from diagnostics.statistics.evaluation import weighted_auc
from diagnostics.training import cnn
from diagnostics.training.average_rows import (
    STEPS,
    AveragedRecords,
    average_rows,
    moved,
    padded_lines,
    with_references,
)
from diagnostics.training.cnn import (
    CircularNetwork,
    NetworkSettings,
    TrainedNetwork,
    load_network,
    network_probability,
    save_network,
    train_network,
)
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


def test_a_channel_in_another_unit_changes_nothing() -> None:
    records = records_of(np.random.default_rng(6).standard_normal((8, 2, STEPS)), 18)
    factor = np.array([[30.0 / np.pi], [1e-2]], np.float32)  # rad/s as rpm, cm as m
    scaled = replace(records, lines=records.lines * factor)
    damaged, split = np.arange(8) % 2, planted_split(np.arange(8) // 2, 2, 1)
    first, second = (train_network(taken, damaged, split, 1, few(2)) for taken in (records, scaled))
    np.testing.assert_allclose(
        network_probability(first.network, records), network_probability(second.network, scaled), rtol=1e-3
    )


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


def few(epochs: int) -> NetworkSettings:
    return NetworkSettings(most_epochs=epochs)


def area(trained: TrainedNetwork, records: AveragedRecords, rows: np.ndarray, damaged: np.ndarray) -> float:
    score = network_probability(trained.network, records.chosen(rows))[:, 1]
    return float(weighted_auc(score, damaged[rows] == 1, np.ones((1, rows.size)), rows // 2)[0])


def test_a_burst_without_more_energy_is_found_on_other_gearboxes_by_the_labels_alone(tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    records, damaged, specimen = planted(90, rng)
    split = planted_split(specimen, 40, 10)
    test = np.flatnonzero(split.test)
    state = torch.random.get_rng_state()
    settings = few(25)
    first = train_network(records, damaged, split, 7, settings)
    # a network that learns is not best where it starts
    assert first.best_epoch > 5
    assert first.best_epoch == int(np.argmin(first.validation_loss)) + 1
    assert first.note == ""
    assert torch.equal(state, torch.random.get_rng_state())  # the caller's generator is left alone
    assert area(first, records, test, damaged) > 0.9
    # Labels the other way round where it learns: whoever sees those alone names every test record the other way round.
    # Permuted labels would leave a chance correlation with the burst, whose sign hangs on last bits.
    turned = np.where(split.test, damaged, 1 - damaged)
    blind = train_network(records, turned, split, 7, settings)
    assert area(blind, records, test, damaged) < 0.1

    save_network(replace(first, temperature=0.8, identity="identity"), tmp_path / "cnn.safetensors")
    again = load_network(tmp_path / "cnn.safetensors")
    assert (again.classes, again.channels, again.temperature, again.identity) == (CLASSES, ("lid",), 0.8, "identity")
    np.testing.assert_array_equal(*(network_probability(one.network, records) for one in (again, first)))


def test_the_same_seed_gives_the_same_network() -> None:
    records, damaged, specimen = planted(12, np.random.default_rng(4))
    split = planted_split(specimen, 8, 2)
    first, second = (train_network(records, damaged, split, 5, few(2)) for _ in range(2))
    for name, value in first.network.state_dict().items():
        assert torch.equal(value, second.network.state_dict()[name]), name
    assert first.validation_loss == second.validation_loss


def test_a_network_that_has_not_learned_says_so_and_computes_in_float32_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    records, damaged, specimen = planted(12, np.random.default_rng(4))
    split = planted_split(specimen, 8, 2)
    kinds: set[torch.dtype] = set()

    class Watched(torch.nn.Conv1d):
        def forward(self, signal: torch.Tensor) -> torch.Tensor:
            mapped = super().forward(signal)
            kinds.update((signal.dtype, mapped.dtype))
            return mapped

    monkeypatch.setattr(cnn.nn, "Conv1d", Watched)
    trained = train_network(records, damaged, split, 7, NetworkSettings(most_epochs=2, learning_rate=3.0))
    # bfloat16 did not learn on a processor with matrix units, whose convolutions oneDNN 3.12 is reported to get wrong
    assert kinds == {torch.float32}
    assert min(trained.validation_loss) > np.log(2)
    assert trained.note.startswith("the 1-D network has not learned: its best validation loss is ")
    assert "guessing by how often each class occurs gives 0.693;" in trained.note
    without = train_network(records, damaged, replace(split, validation=split.validation & False), 7, few(1))
    assert without.note == "no validation specimens: trained for 1 epochs without stopping"


@pytest.mark.parametrize(("name", "message"), [("head.bias", r"head\.bias that is not finite"), ("", "another schema")])
def test_weights_that_are_not_finite_or_of_another_schema_are_refused(name: str, message: str, tmp_path: Path) -> None:
    network = CircularNetwork(6, 2)
    if name:
        torch.nn.init.constant_(network.get_parameter(name), float("nan"))
    save_network(TrainedNetwork(network, CLASSES, ("a", "b") if name else ("a",)), tmp_path / "cnn.safetensors")
    with pytest.raises(UsageError, match=message):
        load_network(tmp_path / "cnn.safetensors")


def test_a_foreign_file_is_not_read(tmp_path: Path) -> None:
    from safetensors.numpy import save_file

    save_file({"x": np.zeros(3)}, tmp_path / "other.safetensors")
    with pytest.raises(UsageError, match="received format None; allowed is 'siggen-diagnostics network on averages 1'"):
        load_network(tmp_path / "other.safetensors")
    (tmp_path / "broken.safetensors").write_bytes(b"not a file of weights")
    with pytest.raises(UsageError, match="cannot be read as safetensors"):
        load_network(tmp_path / "broken.safetensors")
