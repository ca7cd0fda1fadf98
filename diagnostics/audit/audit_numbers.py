"""The content of `audit.json`: everything that the audit found, in numbers."""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import Any

from diagnostics.audit.audit import ALONE, WITH_REFERENCE, Audit
from diagnostics.audit.audit_sentences import audit_summary
from diagnostics.audit.bank_detections import ChanceLimit
from diagnostics.audit.detectability import TARGETS, Detection, length_at
from diagnostics.audit.envelope import QuantityShare, Realism
from siggen.dataset.reading import Dataset


def audit_numbers(audit: Audit, dataset: Dataset) -> dict[str, Any]:
    """Return the content of `audit.json`; undefined numbers are null."""
    return {
        "set": dataset.path.name,
        "identity": dataset.manifest["identity"],
        "records": audit.records,
        "specimens": audit.specimens,
        "channels": audit.channels,
        "seed": audit.seed,
        "verdict": audit.verdict,
        "too_few_gearboxes": audit.tells_too_little,
        "gearboxes_needed": audit.gearboxes_needed,
        "summary": audit_summary(audit),
        "findings": [asdict(finding) for finding in audit.findings],
        "realism": _realism_numbers(audit.realism) if audit.realism else None,
        "reference": asdict(audit.reference) | {"discriminator_auc": _number(audit.reference.discriminator_auc)}
        if audit.reference
        else None,
        "detectability": {name: _entries_numbers(entries, audit) for name, entries in audit.detections.items()},
        "strongest": {
            name: _entries_numbers(audit.ladder(referenced=side), audit)
            for name, side in ((ALONE, False), (WITH_REFERENCE, True))
        },
        "chance": _chance_numbers(audit.chance) if audit.chance else None,
        "best_single_indicator": {
            state: {
                "indicator": found.column,
                "tried": found.tried,
                "auc_chosen_on_the_same_gearboxes": found.auc.numbers(),
                "auc_chosen_on_other_gearboxes": _number(found.held_out),
            }
            for state, found in audit.best.items()
        },
        "notes": list(audit.notes),
        "seconds_per_record": audit.seconds_per_record,
    }


def _entries_numbers(entries: list[Detection], audit: Audit) -> dict[str, Any]:
    return {
        "states": [
            {
                "state": entry.state,
                "fault": entry.fault,
                "specimens": entry.specimens,
                "chosen": entry.basis,
                "tried": entry.tried,
                **{size: _number(value) for size, value in entry.sizes.items()},
                "auc": entry.auc.numbers(),
            }
            for entry in entries
        ],
        "profile_length_mm_at_auc": {
            str(target): {
                fault: asdict(reached) if reached and not audit.gearboxes_needed else None
                for fault, reached in length_at(entries, target).items()
            }
            for target in TARGETS
        },
    }


def _chance_numbers(chance: ChanceLimit) -> dict[str, Any]:
    states = {
        state: asdict(law) | {"auc": _number(law.auc), "p_value": _number(law.p_value)}
        for state, law in chance.states.items()
    }
    return asdict(chance) | {"auc": _number(chance.auc), "states": states}


def _realism_numbers(found: Realism) -> dict[str, Any]:
    return {
        "healthy_channel_records": found.channel_records,
        "mean_share_inside": found.mean_inside,
        "share_inside_all": found.all_inside,
        "quantities": _share_numbers(found.shares),
        "background": {
            "mean_share_inside": _number(found.background_inside),
            "quantities": _share_numbers(found.background),
        },
        "sensor_spread": [
            {"name": s.name, "spread_db": _number(s.spread_db), "wanted_db": s.wanted_db} for s in found.spreads
        ],
    }


def _share_numbers(shares: tuple[QuantityShare, ...]) -> list[dict[str, Any]]:
    return [
        {
            "name": share.quantity.name,
            "ranges": share.quantity.ranges,
            **{name: _number(value) for name, value in zip(("q05", "q50", "q95"), share.quantiles, strict=True)},
            "inside": share.inside,
            "undefined": share.undefined,
        }
        for share in shares
    ]


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
