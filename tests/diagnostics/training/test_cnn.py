"""The network: windows, determinism, files, and that it can learn at all."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from diagnostics.indicators.classifier_table import feature_matrix
from diagnostics.loader import windows
from diagnostics.loader.windows import OrderRecords, WindowSettings, drawn_windows, order_records, record_windows
from diagnostics.records.recording import Recording
from diagnostics.training.baselines import state_index
from diagnostics.training.splits import SpecimenSplit, specimen_split
from siggen.errors import DatasetError, UsageError


@pytest.fixture(scope="module")
def records(dataset: Any) -> OrderRecords:
    return order_records(dataset)


@pytest.fixture(scope="module")
def split(features: pa.Table) -> SpecimenSplit:
    return specimen_split(feature_matrix(features).labels)


@pytest.fixture(scope="module")
def target(features: pa.Table, split: SpecimenSplit) -> np.ndarray:
    return state_index(feature_matrix(features), split.classes)


def test_windows_hold_eight_revolutions_and_start_on_a_revolution(records: OrderRecords) -> None:
    found = record_windows(records, 0)
    assert records.settings.samples == 8 * 18 * 16
    assert found.shape == (6, 2, records.settings.samples)  # 29 revolutions: starts 0, 4 ... 20
    np.testing.assert_array_equal(found[1], records.signals[0][:, 4 * 288 : 12 * 288])


def test_drawn_windows_are_pieces_of_their_record(records: OrderRecords) -> None:
    found = drawn_windows(records, np.array([3, 5]), 2, np.random.default_rng(0))
    signal = records.signals[5]
    matches = [np.array_equal(found[2], signal[:, s : s + 2304]) for s in range(signal.shape[1] - 2303)]
    assert sum(matches) == 1


def test_a_record_shorter_than_a_window_is_refused(dataset: Any) -> None:
    with pytest.raises(DatasetError, match=r"holds 2[89] whole pinion revolutions; a window of the network needs 40"):
        order_records(dataset, WindowSettings(teeth=18, revolutions=40))


def test_same_seed_same_network_and_files_keep_it(
    records: OrderRecords, target: np.ndarray, split: SpecimenSplit, tmp_path: Path
) -> None:
    import torch

    from diagnostics.training.cnn import TrainingSettings, train_network
    from diagnostics.training.cnn_files import describe_network, load_network, save_network

    short = TrainingSettings(most_epochs=2, windows_per_epoch=64)
    state = torch.random.get_rng_state()
    first, second = (train_network(records, target, split, 7, short) for _ in range(2))
    assert torch.equal(state, torch.random.get_rng_state())  # the caller's generator is left alone
    for name, value in first.network.state_dict().items():
        assert torch.equal(value, second.network.state_dict()[name]), name

    train = np.concatenate([records.signals[k] for k in np.flatnonzero(split.train)], axis=1)
    np.testing.assert_allclose(first.network.mean.numpy()[:, 0], train.mean(axis=1), atol=1e-3)
    np.testing.assert_allclose(first.network.scale.numpy()[:, 0], train.std(axis=1), rtol=1e-3)

    facts = describe_network(first, records.channels, records.settings, "identity")
    save_network(first.network, facts, tmp_path / "cnn.safetensors")
    network, read = load_network(tmp_path / "cnn.safetensors")
    assert read == facts
    windows = torch.from_numpy(record_windows(records, 0))
    expected = first.network(windows).detach().numpy()
    np.testing.assert_array_equal(network(windows).detach().numpy(), expected)


def test_the_network_learns_within_few_epochs_and_computes_in_float32_alone(
    records: OrderRecords, target: np.ndarray, split: SpecimenSplit, monkeypatch: pytest.MonkeyPatch
) -> None:
    import torch

    from diagnostics.training import cnn

    kinds: set[torch.dtype] = set()

    class Watched(torch.nn.Conv1d):
        def forward(self, signal: torch.Tensor) -> torch.Tensor:
            mapped = super().forward(signal)
            kinds.update((signal.dtype, mapped.dtype))
            return mapped

    monkeypatch.setattr(cnn.nn, "Conv1d", Watched)
    trained = cnn.train_network(records, target, split, 7, cnn.TrainingSettings(most_epochs=6, windows_per_epoch=144))
    # bfloat16 did not learn on a processor with matrix units, whose convolutions oneDNN 3.12 is reported to get wrong
    assert kinds == {torch.float32}
    assert min(trained.validation_loss) < np.log(3) - 0.2  # guessing three states, which it begins with
    assert trained.note == ""


def test_a_network_that_has_not_learned_says_so(
    records: OrderRecords, target: np.ndarray, split: SpecimenSplit
) -> None:
    from diagnostics.training.cnn import TrainingSettings, train_network, training_note

    useless = TrainingSettings(most_epochs=2, windows_per_epoch=64, learning_rate=3.0)
    trained = train_network(records, target, split, 7, useless)
    assert min(trained.validation_loss) > np.log(3)
    assert trained.note.startswith("the 1-D network has not learned: its best validation loss is ")
    assert "guessing by how often each class occurs gives 1.1;" in trained.note
    # three of four are of class 0: guessing costs -(0.75 ln 0.75 + 0.25 ln 0.25) = 0.562, not ln 2
    train, validation = np.array([0, 0, 0, 1]), np.array([0, 1, 0, 0])
    assert training_note("network", [0.6, 0.55], 2, train, validation) == ""
    assert "0.57, and guessing by how often each class occurs gives 0.562" in training_note(
        "network", [float("nan"), 0.57], 2, train, validation
    )
    assert "loss is nan" in training_note("network", [float("nan")], 1, train, validation)


def test_a_foreign_file_is_not_read(tmp_path: Path) -> None:
    from safetensors.numpy import save_file

    from diagnostics.training.cnn_files import load_network

    save_file({"x": np.zeros(3)}, tmp_path / "other.safetensors")
    with pytest.raises(UsageError, match="received format None"):
        load_network(tmp_path / "other.safetensors")
    (tmp_path / "broken.safetensors").write_bytes(b"not a file of weights")
    with pytest.raises(UsageError, match="cannot be read as safetensors"):
        load_network(tmp_path / "broken.safetensors")


@pytest.mark.slow
def test_network_learns_a_plain_modulation(records: OrderRecords, target: np.ndarray, split: SpecimenSplit) -> None:
    from diagnostics.statistics.scores import scores
    from diagnostics.training.cnn import network_predictions, train_network

    trained = train_network(records, target, split, seed=1)
    specimen = np.repeat(np.arange(24), 3)
    found = network_predictions(trained, records, np.flatnonzero(split.test), target, specimen)
    assert scores(found, seed=0).accuracy.value > 0.8
    assert trained.best_epoch == int(np.argmin(trained.validation_loss)) + 1


@pytest.mark.parametrize(("name", "message"), [("head.bias", r"head\.bias that is not finite"), ("", "another schema")])
def test_weights_that_are_not_finite_or_of_another_schema_are_refused(name: str, message: str, tmp_path: Path) -> None:
    import torch

    from diagnostics.training.cnn import WideKernelNetwork
    from diagnostics.training.cnn_files import NetworkFile, load_network, save_network

    network = WideKernelNetwork(2, 3, WindowSettings(teeth=18).samples_per_tooth)
    if name:
        torch.nn.init.constant_(network.get_parameter(name), float("nan"))
    channels = ("a", "b") if name else ("a", "b", "c")
    facts = NetworkFile(("h", "s", "t"), channels, WindowSettings(teeth=18), (0.0,) * 2, (1.0,) * 2, "0" * 64)
    save_network(network, facts, tmp_path / "cnn.safetensors")
    with pytest.raises(UsageError, match=message):
        load_network(tmp_path / "cnn.safetensors")


def test_pinions_of_different_teeth_get_the_same_steps_per_revolution(monkeypatch: pytest.MonkeyPatch) -> None:
    time_s, teeth, speed_hz = np.arange(12800) / 12800.0, (18, 24), (20.0, 16.0)
    pulses = [np.arange(0.0, 0.99, 1.0 / speed) for speed in speed_hz]
    found = [
        Recording(
            {"record_id": i, "teeth_pinion": teeth[i]},
            {"a": np.sin(2.0 * np.pi * teeth[i] * speed_hz[i] * time_s).astype(np.float32)},
            pulses[i],
            12800.0,
        )
        for i in range(2)
    ]
    labels = pa.table({"teeth_pinion": list(teeth)})
    dataset = SimpleNamespace(
        labels=lambda columns=None: labels.select(columns or ["teeth_pinion"]), channels=[SimpleNamespace(name="a")]
    )
    monkeypatch.setattr(windows, "recordings", lambda _: iter(found))
    records = order_records(dataset)  # type: ignore[arg-type]
    assert records.settings.samples_per_revolution == 24 * 16
    for signal, count in zip(records.signals, teeth, strict=True):
        window = signal[0, : records.settings.samples]
        spectrum = np.abs(np.fft.rfft(window))
        assert int(np.argmax(spectrum)) == count * records.settings.revolutions
