"""Windows as arrays are those of the loader, and answers to them become one row per record."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

pytest.importorskip("torch")

import diagnostics
from diagnostics.loader import WindowDataset
from siggen.errors import UsageError


def test_windows_are_those_of_the_loader_and_their_mean_is_the_answer_of_a_record(dataset: Any) -> None:
    found, loader = diagnostics.windows(dataset, "test", labels=("speed_hz",)), WindowDataset(dataset, "test")
    assert found.values.shape == (len(loader), 2, 8 * 288)
    assert np.array_equal(found.values[5], loader[5]["windows"].numpy())
    assert set(found.labels) == {*loader[5], "speed_hz"} - {"windows"}
    assert np.array_equal(found.groups, found.labels["specimen_id"])
    right = np.eye(len(found.classes))[found.labels["class_id"]]
    wavering = np.where(np.arange(len(right))[:, None] % 2, right, 1.0 / len(found.classes))
    mine = found.predictions(wavering)
    record = mine["record_id"][0]
    own = found.labels["record_id"] == record
    assert mine["p_severe"][0] == pytest.approx(wavering[own, found.classes.index("severe")].mean())
    scores = {row.measure: row.score.value for row in diagnostics.score(dataset, mine).rows}
    assert scores["balanced accuracy"] == 1.0


def test_averages_and_tables_go_into_a_fit_as_they_are(
    dataset: Any, measured: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    import torch

    for module in ("indicators.classifier_table", "training.average_rows"):
        monkeypatch.setattr(f"diagnostics.{module}.record_table", lambda *_, **__: measured)
    found = diagnostics.averages(dataset, "test")
    assert found.values.shape == (8 * 3, 3 * 2, 1024)
    assert set(found.labels["specimen_id"]) == set(range(16, 24))
    rows, truth = next(iter(torch.utils.data.DataLoader(found, batch_size=5)))
    np.testing.assert_array_equal(rows.numpy(), found.values[:5])
    np.testing.assert_array_equal(truth.numpy(), found.labels["class_id"][:5])
    values, target, groups = diagnostics.table(dataset).split("test")
    assert len(values) == len(target) == len(groups) == 24
    whole = diagnostics.table(dataset)
    assert whole.undefined  # too few turns for some indicators
    assert np.isfinite(whole.values).any(axis=0).all()
    assert np.isnan(whole.columns(whole.undefined).values).all()
    for wrong, said in ((str(dataset.path), r"received '.*'"), (values, "received a ndarray")):
        with pytest.raises(UsageError, match=rf"table: {said}; allowed: what siggen\.open returned"):
            diagnostics.table(wrong)
    names = np.array(found.classes)
    np.testing.assert_array_equal(names[found.labels["class_id"]], target)
