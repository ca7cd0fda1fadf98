"""Leaks planted into the files of a set, and what the audit says: `planted_files.py SET FOLDER [--only ...]`.

Copies the set into FOLDER, plants one leak at a time, seals the copy again, and audits it in a fresh process. Prints
Markdown: what was planted, what the audit found beyond the set as it is. The first row is that set. A copy is deleted
after its audit; the reports stay in FOLDER, and a kind whose report is there already is not run again. With --paired
the audit also judges the differences from a gearbox's own healthy record.
"""

from __future__ import annotations

import argparse
import json
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))  # the leaks are those of the tests

from tests.diagnostics.planted.label_leaks import LABEL_LEAKS  # noqa: E402
from tests.diagnostics.planted.leak import Leak  # noqa: E402
from tests.diagnostics.planted.planted_copy import planted_copy  # noqa: E402
from tests.diagnostics.planted.signal_leaks import SIGNAL_LEAKS  # noqa: E402

AUDIT = "from diagnostics.cli.app import main; main()"
LEAKS = {"nothing": Leak("nothing", "nothing"), **SIGNAL_LEAKS, **LABEL_LEAKS}


def findings(source: Path, folder: Path, leak: Leak, *options: str) -> list[str]:
    """Return the names of what the audit finds in a copy of a set with a leak."""
    report = folder / "_".join([leak.name, "audit", *(option.strip("-") for option in options)])
    if not (report / "audit.json").is_file():
        shutil.rmtree(folder / leak.name, ignore_errors=True)  # of a study that was stopped
        copy = planted_copy(source, folder / leak.name, leak)
        command = [sys.executable, "-c", AUDIT, "audit", str(copy), "--out", str(report), *options]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        shutil.rmtree(copy)
    return [finding["trap"] for finding in json.loads((report / "audit.json").read_text())["findings"]]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("set", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", nargs="+", choices=sorted(LEAKS), default=list(LEAKS), metavar="KIND")
    parser.add_argument("--paired", action="append_const", const="--paired", default=[])
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    clean = findings(given.set, given.folder, LEAKS["nothing"], *given.paired)
    print("| kind | planted into damaged records | the audit names | result |\n|---|---|---|---|")
    print(f"| nothing | nothing | {', '.join(clean) or 'nothing'} | |", flush=True)
    kinds = [LEAKS[name] for name in given.only if name != "nothing"]
    found = 0
    for leak in kinds:
        named = findings(given.set, given.folder, leak, *given.paired)
        is_found = not set(named) <= set(clean)
        found += is_found
        said = ", ".join(f"`{name}`" for name in named) or "nothing"
        print(f"| {leak.name} | {leak.planted} | {said} | {'found' if is_found else 'missed'} |", flush=True)
    print(f"\nfound: {found} of {len(kinds)}")


if __name__ == "__main__":
    main()
