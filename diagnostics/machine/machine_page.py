"""The page of a machine: the newest verdicts, the trend over all checks, and what moved."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from datetime import datetime, timedelta
from pathlib import Path
from typing import TYPE_CHECKING

from diagnostics.machine.check import CHANGED, MACHINE_WORDS, UNCHANGED, Check, PastCheck, rate_sentence
from diagnostics.machine.machine import Machine
from diagnostics.page.blocks import (
    Cell,
    FigureBlock,
    FigureGrid,
    Heading,
    Page,
    Paragraph,
    TableBlock,
    note_blocks,
    summary_blocks,
)
from diagnostics.page.style import FAULT_COLOURS, HEALTHY_COLOUR, new_figure, png_bytes, styled
from diagnostics.page.tables import cell, table
from diagnostics.page.template import write_page

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PAGE = "machine.html"
SHORTEST_SPAN = timedelta(hours=12)
"""Beside the first and the last check, so that those of one call stand over their date."""
FINE = 10.0
"""Largest over smallest distance up to which the axis has more marks than 1, 2 and 5."""
TREND = (
    "Distance from the healthy recordings by the time of each check (UTC), over the limit of that check. Above 1 a "
    "recording counts as changed. The unchanged machine exceeds 1 as often as the rate of false alarms says. Checks "
    "that cannot tell have no point."
)
NO_STATE = (
    "This page says whether the machine has changed against its own healthy recordings. It names no fault: that takes "
    "recordings of known faults, or a model of this machine."
)


def write_machine_page(machine: Machine, folder: Path, checks: Sequence[Check], history: Sequence[PastCheck]) -> Path:
    """Write `machine.html` into the machine's folder; return its path."""
    with styled():
        figure = png_bytes(_trend(history))
    counts = Counter(check.verdict for check in checks)
    used = min((check.used for check in checks if check.score is not None), default=len(machine.references))
    files = dict.fromkeys(check.recording.partition(":")[0] for check in checks)
    parts = [
        Heading(f"Machine {folder.name}: {', '.join(counts)}", 1),
        *summary_blocks(
            [MACHINE_WORDS.headline(counts), NO_STATE, rate_sentence(used, machine.false_alarms)], _tone(set(counts))
        ),
        FigureGrid([FigureBlock(figure, TREND)]),
        table(
            ("Recording", "Verdict", "Reason", "Speed [Hz]"),
            [(c.recording, c.verdict, c.reason, c.speed_hz) for c in checks],
            *("Newest checks.", ".4g"),
            text=True,
        ),
        Paragraph(MACHINE_WORDS.look(folder.name, [*files])),
        *(_moved_table(check) for check in checks if check.moved),
        Heading("References"),
        *note_blocks(machine.doubts),
        table(
            ("Recording", "Speed [Hz]", "Load"),
            zip(machine.references, machine.speed_hz, machine.load, strict=True),
            *("Healthy recordings that everything is compared with.", ".4g"),
            tall=True,
        ),
    ]
    page = folder / PAGE
    write_page(page, Page(f"Machine {folder.name}", parts))
    return page


def _tone(verdicts: set[str]) -> str:
    """Return green where nothing has changed, red where something has, neither where a check cannot tell."""
    return "failed" if CHANGED in verdicts else "passed" if verdicts == {UNCHANGED} else ""


def _moved_table(check: Check) -> TableBlock:
    rows = [
        (Cell(moved.title, moved.indicator), moved.channel, cell(moved.factor, ".3g"), cell(moved.spreads, "+.1f"))
        for moved in check.moved
    ]
    return table(("Indicator", "Channel", "Factor", "Spreads"), rows, MACHINE_WORDS.moved(check), sortable=True)


def _trend(history: Sequence[PastCheck]) -> Figure:
    from matplotlib.dates import AutoDateLocator, ConciseDateFormatter
    from matplotlib.ticker import LogLocator, NullFormatter

    figure, axes = new_figure(height_in=2.8)
    axis = axes[0, 0]
    known = [
        (datetime.fromisoformat(past.made), past.verdict, past.score / past.limit)
        for past in history
        if past.score is not None and past.limit is not None
    ]
    for verdict, colour, marker in ((UNCHANGED, HEALTHY_COLOUR, "o"), (CHANGED, FAULT_COLOURS[2], "D")):
        places = [(made, distance) for made, said, distance in known if said == verdict]
        if places:
            axis.plot(*zip(*places, strict=True), marker, color=colour, label=verdict, markersize=5)
    axis.axhline(1.0, color="#1c2733", linewidth=1.2, label="limit")
    axis.set_yscale("log")
    low, high = axis.get_ylim()
    axis.yaxis.set_major_locator(
        LogLocator(subs=(1.0, 2.0, 5.0) if high > FINE * low else (1.0, 1.2, 1.5, 2.0, 3.0, 5.0, 7.0))
    )
    axis.yaxis.set_major_formatter("{x:g}")
    axis.yaxis.set_minor_formatter(NullFormatter())
    if known:
        first, last = min(made for made, *_ in known), max(made for made, *_ in known)
        margin = max(0.05 * (last - first), SHORTEST_SPAN)
        axis.set_xlim(first - margin, last + margin)
        dates = AutoDateLocator(minticks=2, maxticks=6)
        axis.xaxis.set_major_locator(dates)
        axis.xaxis.set_major_formatter(ConciseDateFormatter(dates))
    axis.set_xlabel("time of the check (UTC)")
    axis.set_ylabel("distance over limit")
    figure.legend(loc="outside upper center", ncols=3)
    return figure
