"""What a report says of the audit of the same set, where it was run; it says what is missing where it was not."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from diagnostics.audit.audit import ALONE
from diagnostics.base.beside import beside as folder_beside
from diagnostics.page.wording import decimal, joined
from siggen.dataset.reading import Dataset


def audit_beside(dataset: Dataset) -> dict[str, Any] | None:
    """Return the content of `audit.json` in the folder beside a set, DIR_audit; None without one of this very set."""
    path = folder_beside(dataset.path, "_audit") / "audit.json"
    try:
        audit = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    same = isinstance(audit, dict) and audit.get("identity") == dataset.manifest["identity"]
    return audit if same else None


def audit_sentence(dataset: Dataset, audit: Mapping[str, Any] | None) -> str:
    """Say what the audit found, or what is not known without it."""
    name = dataset.path.name
    if audit is None:
        return (
            "The audit was not run. So it is not known whether something other than the damage gives the states away, "
            f"nor what detectors on the averaged revolution find. Run it: `siggen-diagnostics audit {name}`. Then make "
            "this report again."
        )
    if audit.get("too_few_gearboxes"):
        return str(audit.get("verdict"))
    states = audit.get("strongest", {}).get(ALONE, {}).get("states", [])
    reached = [
        f"{state['state']} {decimal(state['auc']['value'])}"
        for state in states
        if state.get("auc", {}).get("value") is not None
    ]
    detectors = f" Its strongest detectors reach, on unseen gearboxes, an AUC of: {joined(reached)}." if reached else ""
    return f"{audit.get('verdict', 'The audit gives no verdict.')}{detectors}"
