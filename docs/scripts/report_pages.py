"""Pages of the presets in docs/reports: `python docs/scripts/report_pages.py [NAME ...]`.

`make reports` makes those of quickstart and of the whole bench. `make pages` makes those of quickstart, bench,
industrial and a machine of one's own, the last three with 20 gearboxes each: less sure than with all gearboxes.

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

GEARBOXES = 20
"""Of the smaller sets: four of them test, and 5 % of 20 healthy records is one."""

OWN = "--teeth 25,56 --module 2 --face-width 20 --speed 15,25 --torque 20 --sensors 2"
SETS |= {
    f"{preset}_{GEARBOXES}": (
        f"siggen generate configs/{preset}.yaml --set specimens={GEARBOXES} --workers 2 "
        f"--out runs/{preset}_{GEARBOXES}",
    )
    for preset in ("bench", "industrial")
}
SETS["rig"] = (
    f"siggen init {OWN} --out runs/rig.yaml",
    f"siggen generate runs/rig.yaml --set specimens={GEARBOXES} --out runs/rig --workers 2",
)

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

SMALLER = {
    name: {
        f"{name}_audit": ("audit.html", f"audit runs/{name} --realism"),  # first: the report cites it
        f"{name}_report": ("report.html", f"report runs/{name}"),
        f"{name}_indicators": ("indicators.html", f"indicators runs/{name} --leave-out"),
    }
    for name in (f"bench_{GEARBOXES}", f"industrial_{GEARBOXES}", "rig")
}
"""The same for sets of few gearboxes."""

NEEDED = {"quickstart": ("quickstart",), "bench": ("bench", "other")} | {name: (name,) for name in SMALLER}


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
    for preset in presets or REPORTS:
        for folder in NEEDED[preset]:
            if not (RUNS / folder).exists():
                RUNS.mkdir(exist_ok=True)
                for command in SETS[folder]:
                    run(command)
        for name, (page, command) in (REPORTS | SMALLER)[preset].items():
            write_page(name, page, command)


if __name__ == "__main__":
    main(*sys.argv[1:])
