"""Pages of the presets in docs/reports: `python docs/scripts/report_pages.py [--sets DIR] [NAME ...]`.

Without names those of quickstart and bench are made (`make pages`). Sets are looked for in runs/ and generated where
they are missing; every command is printed before it runs. With `--sets DIR` a set is taken from DIR/NAME, where it
is. A set of another configuration, or of another number of gearboxes, is refused, and so is a page that names a place
on this machine. Sets, JSON files, tables and models stay in runs/. Two pages are kept in the repository (`KEPT`). The
figures of quickstart that other pages of the documentation cite are drawn anew (`cited_figures.py`).
"""

from __future__ import annotations

import argparse
import getpass
import os
import re
import resource
import shlex
import shutil
import socket
import subprocess
import sys
from pathlib import Path

RUNS, PAGES = Path("runs"), Path("docs/reports")
GEARBOXES = {"bench": 24}
"""Fewer than the preset has."""

SETS = {
    "quickstart": ("siggen generate configs/quickstart.yaml --out runs/quickstart --workers 2",),
    "bench": (f"siggen generate configs/bench.yaml --set specimens={GEARBOXES['bench']} --out runs/bench --workers 2",),
}
"""Commands that make a set, by its folder in runs/; the last one generates it."""

OPTIONS = {"quickstart": ""}
"""Networks of bench cost minutes. The audit is of quickstart alone."""

REPORTS = {
    name: {
        # the audit first: the report cites it
        **({f"{name}_audit": ("audit.html", f"audit runs/{name}")} if name == "quickstart" else {}),
        f"{name}_report": ("report.html", f"report runs/{name}{OPTIONS.get(name, ' --no-cnn')}"),
    }
    for name in SETS
}
"""By set: the name of a page, what the program calls it, and the command that writes it."""

KEPT = ("quickstart_audit", "quickstart_report")
"""Pages that the repository keeps as examples; git ignores the others."""


def run(command: str) -> None:
    """Print a command, run it with the programs of this Python, and print what it cost."""
    print(f"$ {command}", flush=True)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    program, *arguments = shlex.split(command)
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    subprocess.run([program, *arguments], check=True, env={**os.environ, "PATH": path})
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu_s = used.ru_utime + used.ru_stime - before.ru_utime - before.ru_stime
    print(f"{cpu_s:.0f} s of CPU time", flush=True)


def places(page: str) -> list[str]:
    """Return what a page says about the machine it was made on: folders, user, host."""
    text = re.sub(r'base64,[A-Za-z0-9+/=]+|"[A-Za-z0-9+/=]{100,}"', "", page)  # pictures, packed numbers
    names = {str(Path.cwd()), str(Path.home()), socket.gethostname(), getpass.getuser()} - {
        "",
        "/",
        "root",
        "localhost",
    }
    found = [name for name in names if re.search(rf"(?<!\w){re.escape(name)}(?!\w)", text)]
    return [*found, *re.findall(r"(?<![\w<])/(?:tmp|home|work|root|Users|var)/[\w./-]+", text)]


def write_page(name: str, page: str, command: str) -> None:
    """Run one command and keep its page."""
    run(f"siggen-diagnostics {command} --out {RUNS / name}")
    text = (RUNS / name / page).read_text(encoding="utf-8")
    if found := places(text):
        raise SystemExit(f"{RUNS / name / page} names {', '.join(found)}: nobody else can read that")
    PAGES.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(RUNS / name / page, PAGES / f"{name}.html")
    print(f"{PAGES / name}.html: {len(text.encode()) / 1e6:.2f} MB")


def fetch_set(name: str, sets: Path | None) -> None:
    """Have the set in runs/: as it is there, from another folder (its files linked), or generated."""
    target = RUNS / name
    RUNS.mkdir(exist_ok=True)
    if not target.exists() and sets is not None and (sets / name).is_dir():
        shutil.copytree(sets / name, target, copy_function=_linked)
    elif not target.exists():
        for command in SETS[name]:
            run(command)
    check_set(name)


def _linked(source: str, target: str) -> None:
    """Link a file; copy it where that is not possible."""
    try:
        os.link(source, target)
    except OSError:
        shutil.copy2(source, target)


def check_set(name: str) -> None:
    """Refuse a set in runs/ that its commands would not make.

    Raises
    ------
    SystemExit
        If configuration or number of gearboxes differ.
    """
    import siggen

    *before, generate = SETS[name]
    _, _, source, *options = shlex.split(generate)
    if before and not Path(source).exists():
        run(before[0])
    overrides = [value for option, value in zip(options[::2], options[1::2], strict=True) if option == "--set"]
    config, dataset = siggen.load_config(source, overrides), siggen.open(RUNS / name)
    gearboxes = len(set(dataset.labels(columns=["specimen_id"]).column("specimen_id").to_pylist()))
    if (dataset.manifest["identity"], gearboxes) != (config.identity, config.specimens):
        raise SystemExit(
            f"runs/{name}: {gearboxes} gearboxes of identity {dataset.manifest['identity']}; `{generate}` gives "
            f"{config.specimens} of {config.identity}. Remove the folder to have it made"
        )


def main() -> None:
    """Write the pages of the named sets, or of all."""
    parser = argparse.ArgumentParser()
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(SETS)}; all unless told")
    parser.add_argument("--sets", type=Path, help="folder that has sets by these names")
    asked = parser.parse_args()
    if unknown := set(asked.names) - set(SETS):
        parser.error(f"{', '.join(sorted(unknown))}: allowed are {', '.join(SETS)}")
    for name in asked.names or SETS:
        fetch_set(name, asked.sets)
        for page, (file, command) in REPORTS[name].items():
            write_page(page, file, command)
    subprocess.run([sys.executable, str(Path(__file__).with_name("cited_figures.py"))], check=True)


if __name__ == "__main__":
    main()
