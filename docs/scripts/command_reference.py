"""Print docs/reference/commands.md: `python docs/scripts/command_reference.py > docs/reference/commands.md`.

Typer writes the help of every command as Markdown (`typer APP utils docs`); this script makes tables of both programs.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = {"siggen": "siggen/cli/app.py", "siggen-diagnostics": "diagnostics/cli/app.py"}
OFTEN = 2
"""An option that so many commands describe in the same words stands once, in a table of its own."""
ALIKE = ("--set", "CONFIG", "DIR", "SET")
"""What commands describe in words of their own that say the same."""
OPTION = re.compile(r"^\* `([^`]*)`: (.*?)(?:  \[([^\]]*)\])?$", re.MULTILINE)
COMMAND = re.compile(r"^## `([^`]*)`$\n\n(.*)$", re.MULTILINE)
NAME = re.compile(r"(?:-\w, )?(--[\w-]+)")
FORMATS = re.compile(r":? \.csv, [^;]* and others")
"""Of recordings, which the head of the page names once."""
SENTENCE = re.compile(r"^.*?(?<!s3://\.\.)(?<!\d)[.](?=\s[A-Z]|$)")
HEAD = """# Commands

`siggen COMMAND -h` says more: meanings in full, limits of numbers, further examples. `make reference` prints this page.
Recordings are files of [many formats](../start/from_a_file.md#formats-of-recordings); rows of Parquet: `FILE:ROW,ROW`.

exit code|meaning
---|---
0|done
1|unexpected error; run again with `SIGGEN_TRACEBACK=1` for details
2|wrong usage or configuration
3|some records failed: the set is usable and the manifest names them, unless `--allowed-loss` stopped the run; of \
`check`: a recording cannot be compared
4|`verify` found a difference, `check` a change, `audit --strict` a leak or too few gearboxes
130|interrupted; the same command goes on where it stopped
"""


def helped(program: str, app: str) -> str:
    """Return the help of all commands of a program as Markdown."""
    command = [sys.executable, "-m", "typer", app, "utils", "docs", "--name", program]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "TERM": "dumb", "COLUMNS": "80"}
    text = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=True).stdout
    text = re.sub(r"^\* `--(install-completion|show-completion|help|version)`.*\n", "", text, flags=re.MULTILINE)
    text = re.sub(r" <(int|float|str|path|list\[\w+\])( range)?>`", "`", text)  # what a value is, its sentence says
    return text.replace("&lt;", "<").replace("&gt;", ">").replace("&#x27;", "'")


def sentence(meaning: str) -> str:
    """Return the first sentence of a meaning, in a cell."""
    meaning = FORMATS.sub("", meaning)
    found = SENTENCE.search(meaning)
    return (found[0] if found else meaning).removesuffix(".").replace("|", "\\|")


def name(option: str) -> str:
    """Return the name of an option without its value: `--fs` of `--fs <float>`."""
    match = NAME.match(option)
    return match[1] if match else option.partition(" <")[0]


def row(option: str, meaning: str, fact: str) -> str:
    """Return the line of an option; of a default and a range the default alone."""
    default = re.search(r"default: ([^;]+)", fact)
    ending = f" ({default[1]})" if default else " (required)" if "required" in fact and option.startswith("-") else ""
    return f"`{option.replace('|', chr(92) + '|')}`|{sentence(meaning)}{ending}"


def shared(text: str) -> dict[str, tuple[str, str]]:
    """Return option -> meaning, facts of those that several commands describe alike, the most frequent of each name."""
    counted = Counter(OPTION.findall(text))
    found: dict[str, tuple[str, str]] = {}
    for (option, meaning, fact), count in counted.most_common():
        if count >= OFTEN and name(option) not in map(name, found):
            found[option] = meaning, fact
    return found


def commands(text: str, options: Mapping[str, tuple[str, str]]) -> Iterator[str]:
    """Yield what a page says of every command: a sentence, an example, its options, names of those told elsewhere."""
    starts = list(COMMAND.finditer(text))
    for start, following in zip(starts, [*starts[1:], None], strict=True):
        body = text[start.end() : following.start() if following else None]
        yield f"### `{start[1]}`\n\n{start[2]}\n"
        example = re.search(r"^Example: (.*)$", body, re.MULTILINE)
        if example is not None:
            yield f"    {example[1]}\n"
        yield from table(OPTION.findall(body), options)


def table(found: Iterable[tuple[str, str, str]], options: Mapping[str, tuple[str, str]]) -> Iterator[str]:
    """Yield the table of a command's own options, and a line with those that several have."""
    lines = list(found)
    known = [options.get(option, ("",))[0] == meaning or name(option) in ALIKE for option, meaning, _ in lines]
    own = [row(*line) for line, is_known in zip(lines, known, strict=True) if not is_known]
    if own:
        yield "\n".join(["option|meaning", "---|---", *own, ""])
    if any(known):
        names = [f"`{name(line[0])}`" for line, is_known in zip(lines, known, strict=True) if is_known]
        yield f"[Further](#options-of-several-commands): {', '.join(names)}\n"


def page() -> str:
    """Return the page."""
    texts = {program: helped(program, app) for program, app in PROGRAMS.items()}
    options = shared("\n".join(texts.values()))
    parts = [HEAD]
    for program, text in texts.items():
        parts += [f"## `{program}`\n", *commands(text, options)]
    rows = [row(option, *told) for option, told in sorted(options.items())]
    return "\n".join([*parts, "## Options of several commands\n", "option|meaning", "---|---", *rows])


if __name__ == "__main__":
    print(page())
