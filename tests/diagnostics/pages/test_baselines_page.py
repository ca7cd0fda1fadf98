"""The example of docs/understand/baselines.md for one's own classifier runs; its figures are those of the report."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

import siggen
from diagnostics.training.training import NetworkOptions, train_models
from tests.diagnostics.pages.published_report import ROOT, report_rows

PAGE = (ROOT / "docs" / "understand" / "baselines.md").read_text(encoding="utf-8")


def test_the_calibration_of_the_network_is_that_of_the_published_report() -> None:
    cells = report_rows("with the temperature T")["1-D network"]
    temperature, _, _, before, after, honest = (text for text, _ in cells[1:])
    said = re.search(
        r"the network gets T = ([\d.]+)\. Its calibration error\s+is ([\d.]+) without T, ([\d.]+) with T, and would be "
        r"([\d.]+) if",
        PAGE,
    )
    assert said is not None
    assert said.groups() == (temperature, before, after, honest)


def test_the_epochs_of_both_networks_are_those_of_the_published_report() -> None:
    rows = report_rows("Scores on")
    trained = {name: re.search(r"epoch \d+ of (\d+)", rows[name][0][1]) for name in rows if "network" in name}
    for name, pattern in (
        ("1-D network", r"the network alone .*, an epoch of (\d+)"),
        ("circular network on the average", r"the circular network alone, an epoch of (\d+)"),
    ):
        said, found = re.search(pattern, PAGE), trained[name]
        assert said is not None
        assert found is not None
        assert said.group(1) == found.group(1), name


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
