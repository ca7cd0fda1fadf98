"""The part of a page on which records are looked at, and the page that holds nothing else."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from diagnostics.base.progress import Stage
from diagnostics.explore.payload import PageSource, RecordList, page_axes, page_details, page_head
from diagnostics.page.blocks import Heading, Page, Paragraph, RecordsPlace
from diagnostics.page.live import Live
from diagnostics.page.sentences import Sentences

FOLDER, TEMPLATES = Path(__file__).with_name("page"), Path(__file__).with_name("templates")
RECORDS_WORDS = Sentences(TEMPLATES / "records.txt")
SCRIPTS = (
    *("vendored/uPlot.LICENSE", "vendored/uPlot.iife.min.js", "unpack.js", "charts.js", "waveform.js", "spectra.js"),
    *("averages.js", "internals.js", "flank.js", "life.js", "indicators.js", "histogram.js", "scatter.js"),
    *("waterfall.js", "records.js", "explorer.js"),
)
STYLES = ("vendored/uPlot.min.css", "look.css")


@dataclass(frozen=True, slots=True)
class Look:
    """Records on a page.

    Attributes
    ----------
    live : Live
        What draws it.
    source : PageSource
    """

    live: Live
    source: PageSource


def look_of(source: PageSource, shown: RecordList, stage: Stage, *, full: bool = False) -> Look:
    """Return records as a part of a page.

    Parameters
    ----------
    source : PageSource
    shown : Shown
    stage : Stage
        Told of every record.
    full : bool
        Whether all samples are kept, as far as 30 MB allow.
    """
    axes = page_axes(source, full=full)
    details = page_details(source, axes, source.kept, stage)
    data: dict[str, Any] = {"look-data": page_head(source, axes, shown)}
    data |= {f"look-record-{row}": detail for row, detail in details.items()}
    if source.life is not None:
        gearboxes = sorted({int(source.labels["specimen_id"][row]) for row in source.kept})
        data |= {f"look-life-{gearbox}": source.life(gearbox) for gearbox in gearboxes}
    live = Live(_files(STYLES), _files(SCRIPTS), data)
    return Look(live, source)


def look_page(title: str, look: Look) -> Page:
    """Return a page of nothing but records."""
    opening = Paragraph(RECORDS_WORDS.opening(look.source))
    return Page(title, [Heading(title, 1), opening, RecordsPlace()], look.live)


def _files(names: tuple[str, ...]) -> str:
    return "\n".join(_text(name) for name in names)


def _text(name: str) -> str:
    """Return a file of the package; a licence as a comment, since it must go along with every copy."""
    text = (FOLDER / name).read_text(encoding="utf-8")
    return f"/*\n{text}*/" if name.endswith("LICENSE") else text
