"""A prediction as a folder: JSON, a sideband plot per channel, and one page with both."""

from __future__ import annotations

import json
from pathlib import Path

from diagnostics.base.extras import require_packages
from diagnostics.page import html
from diagnostics.page.style import png_bytes, styled
from diagnostics.prediction.model_facts import ModelFacts
from diagnostics.prediction.prediction import Prediction
from diagnostics.prediction.prediction_facts import MEANING, prediction_facts, prediction_rows
from diagnostics.prediction.prediction_sentences import model_provenance, prediction_summary
from diagnostics.prediction.sideband_figure import sideband_figure

INDICATORS_SHOWN = 400


def write_prediction(found: Prediction, facts: ModelFacts, folder: Path) -> Path:
    """Write `prediction.json`, `sidebands_<channel>.png` and `prediction.html`; return the page's path.

    Parameters
    ----------
    found : Prediction
        What to write.
    facts : ModelFacts
        Of the model that answered.
    folder : Path
        Created where missing.

    Raises
    ------
    UsageError
        If matplotlib is missing.
    """
    require_packages("the plots of a prediction", "matplotlib")
    folder.mkdir(parents=True, exist_ok=True)
    content = prediction_facts(found, facts)
    text = json.dumps(content, indent=1, allow_nan=False) + "\n"
    (folder / "prediction.json").write_text(text, encoding="utf-8")
    blocks = []
    for channel in found.recording.channels:
        with styled():
            png = png_bytes(sideband_figure(found.recording, found.teeth, found.pulses, channel))
        (folder / f"sidebands_{channel}.png").write_bytes(png)
        blocks.append(html.figure_block(png, f"Order spectrum (Hann) around mesh harmonics: {channel}."))
    page = folder / "prediction.html"
    page.write_text(_page(found, facts, content["indicators"], blocks), encoding="utf-8")
    return page


def _page(found: Prediction, facts: ModelFacts, indicators: dict[str, float | None], blocks: list[str]) -> str:
    rows = [[html.Cell(label), html.Cell(text)] for label, text in prediction_rows(found)]
    values = [
        [html.Cell(name), html.Cell("undefined" if value is None else f"{value:.4g}", value=value)]
        for name, value in list(indicators.items())[:INDICATORS_SHOWN]
    ]
    name = found.recording.path.name
    parts = [
        html.heading(f"{name}: {found.state}", 1),
        *html.summary([MEANING, *prediction_summary(found)]),
        html.table(("Question", "Answer"), rows, caption="What the models say about this recording.", text=True),
        html.heading("Sidebands"),
        html.figure_grid(blocks),
        html.heading("Indicators"),
        html.table(
            ("Indicator and channel", "Median"),
            values,
            caption="Median of each indicator over the pieces of the recording. Levels in m/s², ratios without unit.",
            sortable=True,
            tall=True,
        ),
        html.heading("Notes"),
        *html.notes([model_provenance(facts)]),
    ]
    return html.page(f"Prediction for {name}", parts)
