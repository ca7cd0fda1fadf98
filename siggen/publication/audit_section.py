"""Section of a published card: what an audit found that tells the states apart all too easily."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from siggen.errors import UsageError

AUDIT = "audit.json"
TOO_FEW = "What detectors reached is not quoted: there are too few gearboxes to tell it from chance.\n"
UNAUDITED = """## Audit

Nobody has looked for what makes this set trivially separable: no audit was found when it was published. Do not take a
score on it as a score on gearboxes before `siggen-diagnostics audit` has run.
"""


def audit_section(identity: str, file: Path | None) -> str:
    """Return the section from the file that `siggen-diagnostics audit` left; without one it says so.

    Raises
    ------
    UsageError
        If the file is no audit, or one of another set.
    """
    if file is None:
        return UNAUDITED
    try:
        found: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
        of, best = found["identity"], found["best_single_indicator"]
        sentences = _sentences(found["verdict"], found["summary"])
        detectors = _strongest(found["strongest"]) if "strongest" in found else _detectors(best)
        detectors = TOO_FEW if found.get("too_few_gearboxes") else detectors
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise UsageError(f"{file}: is no {AUDIT} of siggen-diagnostics ({error!r}); run the audit again") from error
    if of != identity:
        raise UsageError(f"{file}: is the audit of another set (identity {str(of)[:12]} instead of {identity[:12]})")
    return f"## Audit\n\n{sentences}\n\n{detectors}"


def _sentences(verdict: object, summary: object) -> str:
    """Return the verdict and the findings of the summary, of which the verdict may be the first."""
    said = str(verdict).rstrip(".")
    texts = [str(text) for text in (summary if isinstance(summary, list) else [summary])]
    return " ".join([f"Verdict: {said}.", *(text for text in texts if text.rstrip(".") != said)])


def _strongest(sides: Mapping[str, Mapping[str, Any]]) -> str:
    """Return a table of what the strongest detector reached in each state, alone and with a healthy reference."""
    lines = [
        f"| {side} | {entry['state']} | {entry['chosen']} | {_number(entry['auc']['value'])} | {entry['tried']} |"
        for side, entries in sides.items()
        for entry in entries["states"]
    ]
    head = "A classifier that scores no better has learnt no more than this:\n"
    table = ["| detector | state | what it chose most often | AUC against healthy | tried |", "|---|---|---|---|---|"]
    return "\n".join([head, *table, *lines, ""]) if lines else "No state could be judged.\n"


def _detectors(best: Mapping[str, Mapping[str, Any]]) -> str:
    """Return a table of the single indicator that separates each state best, the strongest first."""
    if not best:
        return "No state could be judged by single indicators.\n"
    rows = sorted(best.items(), key=lambda entry: -(entry[1]["auc_chosen_on_other_gearboxes"] or 0.0))
    lines = [
        f"| {state} | `{entry['indicator']}` | {_number(entry['auc_chosen_on_other_gearboxes'])} | {entry['tried']} |"
        for state, entry in rows
    ]
    head = (
        "The strongest detector of each state is the single indicator that separates it best from healthy. A "
        "classifier that scores no better has learnt no more than this number:\n"
    )
    table = ["| state | indicator | AUC, chosen on other gearboxes | indicators tried |", "|---|---|---|---|"]
    return "\n".join([head, *table, *lines, ""])


def _number(value: float | None) -> str:
    return "unknown" if value is None else f"{value:.3f}"
