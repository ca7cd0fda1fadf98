"""What audits say of clean sets: `python docs/scripts/shams.py SET_audit ...`, of folders that `audit` wrote.

Prints Markdown, a row for each set: the leaks that were found, and the largest AUC of all detectors on its sham, alone
and beside a healthy record, with what the largest stays below in 95 % of 499 permutations. Networks count, though they
are not permuted.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

SIDES = ("alone", "beside a healthy record")


def cell(found: dict[str, Any]) -> str:
    """Return what one sham gave."""
    chance = found["chance"]
    beside = f" (chance {chance['auc']:.2f}, p {chance['p_value']:.2f})" if chance else ""
    return f"{found['auc']['value']:.2f}{beside}"


def row(folder: Path) -> str:
    """Return the row of a set."""
    audit = json.loads((folder / "audit.json").read_text(encoding="utf-8"))
    leaks = ", ".join(finding["leak"] for finding in audit["findings"]) or "none"
    cells = [", ".join(cell(one) for one in audit["shams"] if one["side"] == side) or "-" for side in SIDES]
    return f"| `{audit['set']}` | {audit['specimens']} | {audit['records']} | {leaks} | {' | '.join(cells)} |"


if __name__ == "__main__":
    print(f"| set | gearboxes | records | leaks | {' | '.join(f'sham, {side}' for side in SIDES)} |")
    print("|---" * 6 + "|")
    for name in sys.argv[1:]:
        print(row(Path(name)))
