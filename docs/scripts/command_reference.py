"""Print docs/reference/commands.md: `python docs/scripts/command_reference.py > docs/reference/commands.md`.

Typer writes the help of every command as Markdown (`typer APP utils docs`); this script puts both programs on a page.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = {"siggen": "siggen/cli/app.py", "siggen-diagnostics": "diagnostics/cli/app.py"}
HEAD = """# Commands

This page is printed by `python docs/scripts/command_reference.py` from the help of the programs. `siggen COMMAND -h`
shows the same in a terminal.

| exit code | meaning |
| --- | --- |
| 0 | done |
| 1 | unexpected error; run again with `SIGGEN_TRACEBACK=1` for details |
| 2 | wrong usage or configuration |
| 3 | done, but some records failed; the set is usable and the manifest names them |
| 4 | `verify` found a difference, or `audit --strict` found a trap or too few gearboxes |
| 130 | interrupted; the same command goes on where it stopped |
"""


def helped(program: str, app: str) -> str:
    """Return the help of all commands of a program, its headings one level down and its table of commands linked."""
    command = [sys.executable, "-m", "typer", app, "utils", "docs", "--name", program]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "TERM": "dumb", "COLUMNS": "80"}
    text = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=True).stdout
    text = re.sub(r"^\* `--(install-completion|show-completion|help)`.*\n", "", text, flags=re.MULTILINE)
    text = re.sub(r"\*\*Commands\*\*:\n\n(\* .*\n)+", "", text)  # cut off in the middle of their sentences
    text = re.sub(r"\*\*Options\*\*:\n\n(?!\*)", "", text)
    text = text.replace("```console\n$ ", "```text\n")  # how a command is called, not a command
    return re.sub(r"^#", "##", text, flags=re.MULTILINE).strip()


if __name__ == "__main__":
    print(HEAD)
    print("\n\n".join(helped(program, app) for program, app in PROGRAMS.items()))
