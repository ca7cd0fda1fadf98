"""The comparison with a user's recordings in sentences and tables."""

from __future__ import annotations

import math

from diagnostics.audit.reference_comparison import FEWEST_GEARBOXES, FEWEST_RECORDINGS, TELLING_AUC, ReferenceComparison
from diagnostics.page import html
from diagnostics.page.html import Cell
from diagnostics.page.wording import counted, decimal, joined, percent

OUTSIDE = 0.05
"""A recording is outside where fewer gearboxes than this lie as far from their median."""

CAPTION = "Features of windows of one second, the most telling first. The AUC tells measured from synthetic windows."
PLACE_CAPTION = (
    "Distance of every recording from the median of the gearboxes' channels, over their spread, and the share of these "
    "channels that lie as far or farther."
)


def reference_sentences(found: ReferenceComparison) -> list[str]:
    """Say what gives the set away, whether recordings lie within its spread, and how wide that is."""
    worst = joined([gap.name for gap in found.gaps[:3]])
    told = (
        f"{found.telling} of {len(found.gaps)} features alone reach an AUC of {TELLING_AUC:g} or more between the set "
        f"and {counted(found.recordings, 'recording')}. The most telling are {worst}. {percent(found.inside)} of the "
        "synthetic values lie inside 95 % of the measured ones."
    )
    inside = [place for place in found.places if place.farther >= OUTSIDE]
    spread = (
        f"{len(inside)} of {counted(len(found.places), 'recording')} lie within the spread of the synthetic gearboxes. "
        f"The median distance of a gearbox's channel from their middle is {decimal(found.gearbox_distance)} spreads; "
        "width alone is no merit."
    )
    return [told, _discriminator_sentence(found), spread]


def _discriminator_sentence(found: ReferenceComparison) -> str:
    if math.isfinite(found.discriminator_auc):
        return (
            f"All features together tell them with an AUC of {decimal(found.discriminator_auc)} on recordings and "
            "gearboxes that were not seen."
        )
    return (
        f"All features together were not judged: that needs {FEWEST_RECORDINGS} recordings and {FEWEST_GEARBOXES} "
        f"gearboxes, and there are {found.recordings} and {found.gearboxes}. Windows of one recording do not count as "
        "several."
    )


def reference_parts(found: ReferenceComparison) -> list[str]:
    """Return the tables of the page."""
    rows = [
        [
            Cell(gap.name),
            *(_number(value) for value in (gap.auc, gap.measured, gap.synthetic, gap.synthetic_spread)),
            Cell(f"{100.0 * gap.inside:.0f}", value=gap.inside),
        ]
        for gap in found.gaps
    ]
    head = ["Feature", "AUC [-]", "Measured", "Synthetic", "Spread of gearboxes", "Synthetic inside [%]"]
    places = [
        [Cell(p.name), _number(p.distance), Cell(f"{100.0 * p.farther:.0f}", value=p.farther), Cell(str(p.windows))]
        for p in found.places
    ]
    place_head = ["Recording", "Distance [spreads]", "Channels as far [%]", "Windows"]
    return [
        *(html.paragraph(text) for text in reference_sentences(found)),
        html.table(place_head, places, caption=PLACE_CAPTION, sortable=True),
        html.table(head, rows, caption=CAPTION, sortable=True),
    ]


def _number(value: float) -> Cell:
    return Cell(f"{value:.3g}", value=value)
