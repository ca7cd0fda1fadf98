"""Leaks planted into the files of a set, and what the audit says: `planted_files.py SET FOLDER [--only ...]`.

Copies the set into FOLDER, plants one leak at a time, seals the copy again, and looks for leaks as
`siggen-diagnostics audit` does; its detectors on the gears are left out, which accuse no damaged state. Prints
Markdown: what was planted, what is found beyond the set as it is. The first row is that set. A copy is deleted when it
is judged; what was found stays in FOLDER, and a kind that was judged there is not judged again.
"""

from __future__ import annotations

import argparse
import json
import shutil
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))  # the leaks are those of the tests

import siggen  # noqa: E402
from diagnostics.audit.leaks import separability_findings  # noqa: E402
from diagnostics.audit.measured_set import measured_set  # noqa: E402
from diagnostics.base.single_thread import single_thread  # noqa: E402
from tests.diagnostics.planted.fixed_leaks import FIXED_LEAKS  # noqa: E402
from tests.diagnostics.planted.further_leaks import FURTHER_LEAKS  # noqa: E402
from tests.diagnostics.planted.label_leaks import LABEL_LEAKS  # noqa: E402
from tests.diagnostics.planted.leak import Leak  # noqa: E402
from tests.diagnostics.planted.planted_copy import planted_copy  # noqa: E402
from tests.diagnostics.planted.signal_leaks import SIGNAL_LEAKS  # noqa: E402

LEAKS = {"nothing": Leak("nothing", "nothing"), **SIGNAL_LEAKS, **LABEL_LEAKS, **FURTHER_LEAKS, **FIXED_LEAKS}


def findings(source: Path, folder: Path, leak: Leak) -> list[str]:
    """Return the names of what the audit finds in a copy of a set with a leak."""
    judged = folder / f"{leak.name}.json"
    if not judged.is_file():
        for name in (leak.name, f"{leak.name}_table"):  # of a study that was stopped
            shutil.rmtree(folder / name, ignore_errors=True)
        copy = planted_copy(source, folder / leak.name, leak)
        found = separability_findings(measured_set(siggen.open(copy)))
        judged.write_text(json.dumps([finding.leak for finding in found]))
        shutil.rmtree(copy)
        shutil.rmtree(folder / f"{leak.name}_table", ignore_errors=True)
    return list(json.loads(judged.read_text()))


@single_thread()
def main() -> None:
    """Print the table."""
    parser, begin = argparse.ArgumentParser(description=__doc__), time.process_time()
    parser.add_argument("set", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", nargs="+", choices=sorted(LEAKS), default=list(LEAKS), metavar="KIND")
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    clean = findings(given.set, given.folder, LEAKS["nothing"])
    print("| kind | planted into damaged records | the audit names | result |\n|---|---|---|---|")
    print(f"| nothing | nothing | {', '.join(clean) or 'nothing'} | |", flush=True)
    kinds = [LEAKS[name] for name in given.only if name != "nothing"]
    found = 0
    for leak in kinds:
        named = findings(given.set, given.folder, leak)
        is_found = not set(named) <= set(clean)
        found += is_found
        said = ", ".join(f"`{name}`" for name in named) or "nothing"
        print(f"| {leak.name} | {leak.planted} | {said} | {'found' if is_found else 'missed'} |", flush=True)
    print(f"\nfound: {found} of {len(kinds)}; {time.process_time() - begin:.0f} s of CPU")


if __name__ == "__main__":
    main()
