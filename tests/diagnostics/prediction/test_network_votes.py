"""The network on averages says of a recording what it says of the same record in its set."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from diagnostics.indicators.classifier_table import feature_matrix
from diagnostics.indicators.table import RecordTable
from diagnostics.judging.of_split import Training
from diagnostics.prediction.prediction import predict_recording
from diagnostics.prediction.released_model import load_model
from diagnostics.prediction.saved_models import save_models
from diagnostics.recordings.measured_recording import MeasuredRecording
from diagnostics.statistics.calibration import tempered
from diagnostics.training.average_rows import averaged_records
from diagnostics.training.cnn import NetworkSettings, network_probability, train_network
from diagnostics.training.feature_classifier import state_index
from siggen.errors import UsageError


def test_the_vote_of_a_recording_is_that_of_the_record_and_a_foreign_network_is_refused(
    dataset: Any, features: pa.Table, measured: RecordTable, training: Training, tmp_path: Path
) -> None:
    averages = averaged_records(measured)
    target = state_index(feature_matrix(features), training.split.classes)
    found = train_network(averages, target, training.split, 1, NetworkSettings(most_epochs=8))
    kept = replace(found, temperature=0.7, identity="0" * 64)
    save_models(replace(training, network=kept), features, dataset, tmp_path)
    model = load_model(tmp_path)
    assert model.network is not None

    place = int(np.flatnonzero(training.split.test)[2])
    row = dataset.record(int(features.column("record_id")[place].as_py()))
    signals = {name: row[f"accel_{name}_m_s2"] for name in averages.channels}
    recording = MeasuredRecording(Path("run.npz"), signals, dataset.fs_hz, row["tacho_s"], simulated=True)
    votes = {vote.classifier: vote for vote in predict_recording(model, recording, (18, 47)).votes}
    alone = network_probability(found.network, averages.chosen(np.array([place])))
    np.testing.assert_allclose(votes["network"].probability, tempered(alone, 0.7)[0], atol=1e-4)

    save_models(replace(training, network=replace(kept, identity="f" * 64)), features, dataset, tmp_path)
    with pytest.raises(UsageError, match=r"cnn\.safetensors: does not belong .*identity"):
        load_model(tmp_path)
