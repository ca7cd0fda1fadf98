"""The example of docs/understand/baselines.md for one's own classifier runs, and its baseline is that of the report."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

import siggen
from diagnostics.training.training import NetworkOptions, train_models

PAGE = (Path(__file__).resolve().parents[3] / "docs" / "understand" / "baselines.md").read_text(encoding="utf-8")


@pytest.mark.slow  # trains the baselines and their permuted labels
def test_own_classifier_is_judged_beside_the_baseline_of_the_report(
    dataset: Any, features: pa.Table, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (block,) = [code for code in re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL) if "RandomForest" in code]
    monkeypatch.setattr(siggen, "open", lambda path: dataset)
    names: dict[str, Any] = {"__name__": "__main__"}
    exec(compile(block, "docs/understand/baselines.md", "exec"), names)
    reported = train_models(dataset, features, 0, network=NetworkOptions(cnn=False)).judged
    (indicators,) = [found for found in reported if found.name == "indicators"]
    # the report trains in one BLAS thread, a reader in as many as there are: sums round differently
    np.testing.assert_allclose(names["baseline"].probability, indicators.predictions.probability, rtol=1e-6, atol=1e-9)
    assert names["score"].macro_auroc == indicators.scores.macro_auroc
    # depth of modulation tells the states of this set apart: a forest finds most, guessing a third
    assert np.mean(names["mine"].predicted == names["mine"].truth) > 0.8
    assert capsys.readouterr().out.startswith("mine Interval(value=")
