"""Print docs/reference/commands.md: `python docs/scripts/command_reference.py > docs/reference/commands.md`.

Typer writes the help of every command as Markdown (`typer APP utils docs`); this script puts both programs on a page.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Mapping
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = {"siggen": "siggen/cli/app.py", "siggen-diagnostics": "diagnostics/cli/app.py"}
OFTEN = 2
"""An option that so many commands describe in the same words stands once, in a table of its own."""
ALIKE = ("--set", "CONFIG")
"""What commands describe in words of their own that say the same."""
OPTION = re.compile(r"^\* `([^`]*)`: (.*)\n", re.MULTILINE)
NAME = re.compile(r"(?:-\w, )?(--[\w-]+)")
HEAD = """# Commands

This page is printed by `make reference` from the help of the programs. `siggen COMMAND -h` says more, with examples.

| exit code | meaning |
| --- | --- |
| 0 | done |
| 1 | unexpected error; run again with `SIGGEN_TRACEBACK=1` for details |
| 2 | wrong usage or configuration |
| 3 | some records failed: the set is usable and the manifest names them, unless `--allowed-loss` stopped the run |
| 4 | `verify` found a difference, `check` a change, `audit --strict` a trap or too few gearboxes |
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
    text = re.sub(r"\*\*Usage\*\*:\n\n```console\n\$ .*\n```\n\n", "", text)  # arguments and options are listed
    text = re.sub(r" ?Exit codes: [^\n]*(\n[^\n]+)*\n", "\n", text)  # the page begins with them
    text = re.sub(r"^(\* `[^`-][^`]*`: .*)  \[required\]$", r"\1", text, flags=re.MULTILINE)
    text = re.sub(r"\n{3,}", "\n\n", text.replace(" range>", ">"))
    text = re.sub(r"\*\*Arguments\*\*:\n\n((?:\* .*\n)+)\n(?:\*\*Options\*\*:\n\n)?", r"\1", text)
    text = text.replace("**Options**:\n\n", "")
    text = re.sub(r"^(Example|Begin with): .*\n\n?", "", text, flags=re.MULTILINE)  # the guides run them
    text = re.sub(r"^(#+ .*\n\n[^\n]+\n)\n(?:(?![#*]).*\n)*", r"\1\n", text, flags=re.MULTILINE)  # a sentence for each
    text = re.sub(r" <(int|float|str|path|list\[\w+\])>`", "`", text)  # what a value is, its sentence says
    text = re.sub(r"\[default: (\S+?)(; [^\]]*)?\]", r"[\1\2]", text)
    text = text.replace("&lt;", "<").replace("&gt;", ">").replace("&#x27;", "'")
    return re.sub(r"^#", "##", text, flags=re.MULTILINE).strip()


def shared(text: str) -> dict[str, str]:
    """Return option -> meaning of those that several commands describe alike, the most frequent one of each name."""
    counted = Counter(OPTION.findall(text))
    found: dict[str, str] = {}
    for (option, meaning), count in counted.most_common():
        if count >= OFTEN and name(option) not in map(name, found):
            found[option] = meaning
    return found


def name(option: str) -> str:
    """Return the name of an option without its value: `--fs` of `--fs <float>`."""
    match = NAME.match(option)
    return match[1] if match else option.partition(" <")[0]


def with_references(text: str, options: Mapping[str, str]) -> str:
    """Return the help with a line of names in the place of options that stand in the table."""

    def listed(match: re.Match[str]) -> str:
        lines = [(found[0], found[1], found[2]) for found in OPTION.finditer(match[0])]
        is_shared = [options.get(option) == meaning or name(option) in ALIKE for _, option, meaning in lines]
        own = [line for (line, _, _), known in zip(lines, is_shared, strict=True) if not known]
        names = [f"`{name(option)}`" for (_, option, _), known in zip(lines, is_shared, strict=True) if known]
        return "".join(own) + (f"* [Shared](#options-of-several-commands): {', '.join(names)}\n" if names else "")

    return re.sub(r"(?:^\* `[^`]*`: .*\n)+", listed, text, flags=re.MULTILINE)


def page() -> str:
    """Return the page."""
    text = "\n\n".join(helped(program, app) for program, app in PROGRAMS.items()) + "\n"
    options = shared(text)
    rows = [f"| `{option.replace('|', chr(92) + '|')}` | {meaning} |" for option, meaning in sorted(options.items())]
    table = ["", "## Options of several commands", "", "| option | meaning |", "| --- | --- |", *rows]
    return HEAD + with_references(text, options) + "\n".join(table)


if __name__ == "__main__":
    print(page())
