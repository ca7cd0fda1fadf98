"""Pages of the presets in docs/reports: `python docs/scripts/report_pages.py [quickstart] [bench]`, `make reports`.

Sets are looked for in runs/ and made where they are missing; every command is printed before it runs. A page that
names a place on this machine is refused. Sets, JSON files, tables and models stay in runs/.
"""

from __future__ import annotations

import getpass
import os
import re
import shlex
import shutil
import socket
import subprocess
import sys
from pathlib import Path

RUNS, PAGES = Path("runs"), Path("docs/reports")
OTHER_GEARS = (
    "--set gears.pinion.teeth=21 --set gears.gear.teeth=50 --set specimens=24 --set seed=99 "
    "--set 'splits={train: 0, validation: 0, test: 20}'"
)
LADDER = " ".join(f"--state through_{size:03d}" for size in (40, 50, 60, 70, 80, 90, 100, 125, 150))
SETS = {
    "quickstart": ("siggen generate configs/quickstart.yaml --out runs/quickstart",),
    "bench": ("siggen generate configs/bench.yaml --out runs/bench --workers 2",),
    "other": (f"siggen generate configs/bench.yaml {OTHER_GEARS} --out runs/other --workers 2",),
}
"""Commands that make a set, by its folder in runs/."""

REPORTS = {
    "quickstart": {
        "quickstart_report": ("report.html", "report runs/quickstart"),
        "quickstart_indicators": ("indicators.html", "indicators runs/quickstart"),
    },
    "bench": {
        "bench_report": ("report.html", "report runs/bench --test runs/other --channel lid_vertical"),
        "bench_indicators": ("indicators.html", "indicators runs/bench --leave-out"),
        "bench_ladder": ("indicators.html", f"indicators runs/bench --leave-out {LADDER}"),
        "bench_audit": ("audit.html", "audit runs/bench --realism --paired"),
    },
}
"""By preset: the name of a page, what the program calls it, and the command that writes it."""

NEEDED = {"quickstart": ("quickstart",), "bench": ("bench", "other")}


def run(command: str) -> None:
    """Print a command and run it with the programs of this Python."""
    print(f"$ {command}", flush=True)
    program, *arguments = shlex.split(command)
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    subprocess.run([program, *arguments], check=True, env={**os.environ, "PATH": path})


def places(page: str) -> list[str]:
    """Return what a page says about the machine it was made on: folders, user, host."""
    text = re.sub(r"base64,[A-Za-z0-9+/=]+", "", page)
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


def main(*presets: str) -> None:
    """Write the pages of these presets, or of all."""
    for preset in presets or tuple(REPORTS):
        for folder in NEEDED[preset]:
            if not (RUNS / folder).exists():
                RUNS.mkdir(exist_ok=True)
                for command in SETS[folder]:
                    run(command)
        for name, (page, command) in REPORTS[preset].items():
            write_page(name, page, command)


if __name__ == "__main__":
    main(*sys.argv[1:])
