"""The summary of an audit in a few findings, written from its numbers.

The comparison with a user's recordings in sentences and tables.
"""

from __future__ import annotations

import math

from diagnostics.audit.attack_tables import chance_sentence, lost_below, shown_ladders
from diagnostics.audit.audit import Audit
from diagnostics.audit.detectability import FEWEST_SPECIMENS, TARGETS, Detectability, length_at
from diagnostics.audit.envelope import Realism
from diagnostics.audit.reference_comparison import FEWEST_GEARBOXES, FEWEST_RECORDINGS, TELLING_AUC, ReferenceComparison
from diagnostics.audit.sham import sham_sentences
from diagnostics.page import html
from diagnostics.page.html import Cell
from diagnostics.page.wording import counted, decimal, joined, limits, percent

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


def audit_summary(audit: Audit) -> list[str]:
    """Return what shams tell, the verdict and its basis, realism if asked for, the hardest state, the size found."""
    found = [basis_sentence(audit)]
    found += [_realism_sentence(audit.realism)] if audit.realism else []
    found += reference_sentences(audit.reference) if audit.reference else []
    return [
        *sham_sentences(audit.shams),
        audit.verdict,
        *found,
        *_hardest_sentence(audit),
        *([] if audit.gearboxes_needed else _size_sentence(shown_ladders(audit))),
    ]


def basis_sentence(audit: Audit) -> str:
    """Say how much the audit has judged on, and what so few gearboxes leave open."""
    text = (
        f"The audit used {counted(audit.records, 'record')} of {counted(audit.specimens, 'specimen')} (gearboxes) in "
        f"{counted(audit.channels, 'channel')}."
    )
    if audit.specimens >= FEWEST_SPECIMENS:
        return text
    return (
        f"{text} Traps that only appear between gearboxes may not have been found. Detectability needs "
        f"{FEWEST_SPECIMENS} gearboxes with healthy and {FEWEST_SPECIMENS} with damaged records."
    )


def _realism_sentence(found: Realism) -> str:
    text = (
        f"On average over the quantities, {percent(found.mean_inside)} of "
        f"{counted(found.channel_records, 'healthy channel-record')} lie in the range of measured healthy gearboxes."
    )
    if found.left_out:
        words = ", ".join(dict.fromkeys(found.left_out.values()))
        text += f" Only accelerations were measured there; left out: {words}."
    if not found.shares:
        return text
    worst = min(found.shares, key=lambda share: share.inside)
    text += f" The share is lowest for {worst.quantity.title}: {percent(worst.inside)}."
    if not found.background:
        return text
    worst = min(found.background, key=lambda share: share.inside)
    return (
        f"{text} Of what stands beside the mesh lines, {percent(found.background_inside)} lie in range on average. The "
        f"share is lowest for {worst.quantity.title}: {percent(worst.inside)}."
    )


def _hardest_sentence(audit: Audit) -> list[str]:
    """Name the strongest attacker of the hardest and the easiest state, and say what is lost."""
    reached = {state: max(audit.probes(state).values()) for state in audit.states if audit.probes(state)}
    if not reached:
        return []
    hardest, easiest = (chosen(reached, key=lambda state: reached[state]) for chosen in (min, max))
    which = f"The state {hardest} is the hardest to find" if len(reached) > 1 else f"The damaged state is {hardest}"
    text = f"{which}. {_strongest_words(audit, hardest)}"
    if hardest != easiest:
        text += f" The state {easiest} is the easiest. {_strongest_words(audit, easiest)}"
    lost = [state for state in reached if reached[state] < lost_below(audit, state) and not audit.gearboxes_needed]
    failed = f"These failed: {joined(list(audit.probes(lost[0])))}." if lost else ""
    chance = chance_sentence(audit)
    return [text, *([chance] if chance else []), *([f"No attacker found {joined(lost)}. {failed}"] if lost else [])]


def _strongest_words(audit: Audit, state: str) -> str:
    """Name the strongest attacker of a state, its interval, its band and how many were tried."""
    probes = audit.probes(state)
    name = max(probes, key=lambda probe: probes[probe])
    tried = f"The strongest of {counted(len(probes), 'attacker')} on gearboxes that were not seen is {name}"
    entry = next((found for found in audit.detections.get(name, []) if found.state == state), None)
    if entry is None:
        return f"{tried}, chosen among {counted(audit.best[state].tried, 'column')}: AUC {decimal(probes[name])}."
    basis = f", most often {entry.basis} among {counted(entry.tried, 'column')}" if entry.basis else ""
    return f"{tried}: AUC {decimal(entry.auc.value)} ({limits(entry.auc)}){basis}."


def _size_sentence(detections: dict[str, list[Detectability]]) -> list[str]:
    """Say from which length on damage is found at the lower target, by each variant that reaches it."""
    target, parts = TARGETS[0], []
    for name, entries in detections.items():
        for fault, reached in length_at(entries, target).items():
            if reached:
                bound = "at most " if reached.is_upper_bound else ""
                parts.append(f"{bound}{reached.length_mm:.2f}\N{NO-BREAK SPACE}mm of {fault} by {name}")
    return [f"An AUC of {target:g} is reached from {joined(parts)}. Lengths are along the profile."] if parts else []
