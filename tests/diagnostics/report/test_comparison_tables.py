"""What the page says about splits and the learning curve, and what it says where they were not run or are undefined."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from diagnostics.page.style import png_bytes, styled
from diagnostics.report.comparison_tables import curve_table, split_sentence, split_table, study_blocks, verdict
from diagnostics.report.score_figures import learning_curve_figure
from diagnostics.statistics.evaluation import Interval
from diagnostics.training.studies import CurvePoint, Studies


def row(title: str, area: float) -> Any:
    found = SimpleNamespace(
        macro_auroc=Interval(area, area - 0.05, area + 0.05), accuracy=Interval(area, area - 0.05, area + 0.05)
    )
    return SimpleNamespace(title=title, indicators=found, rms=found, leaky="leaky" in title, folds=5)


@pytest.mark.parametrize(
    ("leaky", "records", "specimens", "text", "below"),
    [
        (0.861, 0.9, 0.799, "give 0.80 (0.06 less)", False),
        (0.80, 0.9, 0.804, "give 0.80 (nothing is lost)", False),
        (0.86, 0.69, 0.80, "Windows held out by record score lower still (0.69)", True),
    ],
)
def test_the_difference_that_is_said_is_that_of_the_numbers_that_are_shown(
    leaky: float, records: float, specimens: float, text: str, below: bool
) -> None:
    rows = (row("random windows (leaky)", leaky), row("records", records), row("specimens", specimens))
    assert text in split_sentence(rows)
    assert ("lower still" in split_sentence(rows)) == below


def test_splits_that_could_not_be_scored_are_not_compared() -> None:
    sentence = split_sentence((row("random windows (leaky)", math.nan), row("specimens", 0.8)))
    assert sentence.startswith("The same windows of 8 pinion revolutions")
    assert "less" not in sentence
    assert "lost" not in sentence
    assert "undefined" in split_table((row("specimens", math.nan),))


POINTS = (
    CurvePoint(1, np.array([np.nan, np.nan]), np.array([0.5, 0.7])),
    CurvePoint(2, np.array([0.6, 0.8]), np.array([0.5, 0.7])),
    CurvePoint(3, np.array([0.9]), np.array([0.6])),
)


def test_the_curve_shows_mean_and_range_and_leaves_out_what_is_undefined() -> None:
    text = curve_table(POINTS)
    assert '<td data-value="">undefined</td>' in text
    assert "<td>0.70 <small>0.60 … 0.80</small></td>" in text
    assert "<td>0.90</td>" in text
    with styled():
        assert png_bytes(learning_curve_figure(POINTS)).startswith(b"\x89PNG")


def test_studies_that_were_not_run_say_how_to_have_them() -> None:
    (text,) = study_blocks(None)
    assert "<code>siggen-diagnostics report DIR --studies</code>" in text
    assert len(study_blocks(Studies((row("specimens", 0.8),), POINTS))) == 3


@pytest.mark.parametrize(
    ("low", "high", "specimens", "text"),
    [
        (0.1, 0.3, 6, "yes"),
        (-0.3, -0.1, 6, "yes"),
        (-0.1, 0.3, 6, "no"),
        (0.0, 0.0, 6, "no"),
        (0.1, 0.3, 5, "too few gearboxes"),
        (math.nan, math.nan, 6, "too few gearboxes"),
    ],
)
def test_an_interval_of_few_gearboxes_decides_nothing(low: float, high: float, specimens: int, text: str) -> None:
    assert verdict(Interval(0.5 * (low + high), low, high), specimens) == text
