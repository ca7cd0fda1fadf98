"""Ten planted traps and what the audit says of each: `python docs/scripts/planted_traps.py [SET]`.

Takes what the audit measures of a generated set, changes it by one trap at a time, and prints Markdown: what was
planted, what the audit found, and by which number. Without a set, the small one of the tests. The first row is the set
as it is. One trap per layer: noise, angle, byte, path, length, level, speed, order, duplicate, metadata.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "diagnostics" / "audit")]  # the traps are those of the tests

import siggen  # noqa: E402
from diagnostics.audit.finding import Finding  # noqa: E402
from diagnostics.audit.measured_set import MeasuredSet, measured_set  # noqa: E402
from diagnostics.audit.separability_findings import separability_findings  # noqa: E402
from diagnostics.base.single_thread import single_thread  # noqa: E402
from tests.diagnostics.audit.planted_set import Plant, planted  # noqa: E402
from tests.diagnostics.audit.planted_traps import FOUND_AS, TRAPS  # noqa: E402


def row(name: str, planted: str, found: list[Finding]) -> str:
    """Return a row of the table."""
    traps = ", ".join(f"`{finding.trap}`" for finding in found) or "nothing"
    return f"| {name} | {planted} | {traps} | {'; '.join(finding.measured for finding in found)} |"


@single_thread
def main(path: str) -> None:
    """Print the table."""
    begin = time.process_time()
    clean: MeasuredSet = measured_set(siggen.open(path)) if path else measured_set(planted(Plant()))
    print("| layer | planted | found | measured |\n|---|---|---|---|")
    before = separability_findings(clean)
    known, right, named = {finding.trap for finding in before}, 0, 0
    print(row("none", "nothing", before), flush=True)
    for name, plant in TRAPS.items():
        found = separability_findings(plant(clean))
        new = {finding.trap for finding in found} - known
        right += bool(new)
        named += FOUND_AS[name] in new
        print(row(name, str(plant.__doc__).rstrip("."), found), flush=True)
    print(f"\nfound: {right} of {len(TRAPS)}, {named} by the layer that the tests name")
    print(f"{time.process_time() - begin:.0f} s of CPU")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "")
