"""Print how fast the page of a set is and what a browser says of it: `python docs/scripts/page_checks.py`.

With names of pages, of any command: errors on the console, requests, text beyond the width of the screen, and findings
of axe-core (of a table its first 20 rows: all are written alike, and a thousand cells take minutes).

Measured are the records of 33 gearboxes, 38,400 samples of two channels each, which are the set that the tests make in
memory, made longer: 99 records; and their labels and indicators 101 times, 9,999 records. Needs chromium, and axe-core
for the check of accessibility (`pip install axe-core-python`, or `--axe FILE`). A server on this machine gives the page
to the browser, which measures itself and sends back what it measured. First view: from the start of navigation until
the first frame with all charts. Zoom: from the call until the frame after it, with the charts that follow. Medians of
ten; every load starts a new browser. What the page asks for besides itself is refused, and counted.
"""

from __future__ import annotations

import argparse
import json
import shutil
import statistics
import subprocess
import sys
import tempfile
import threading
from collections.abc import Sequence
from dataclasses import replace
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from diagnostics.base.progress import silent_stage  # noqa: E402
from diagnostics.explore.look import look_of, look_page  # noqa: E402
from diagnostics.explore.payload import PageSource, RecordList, packed_column, unpacked_column  # noqa: E402  # noqa: E402
from diagnostics.explore.set_page import COLUMNS, FILTERS  # noqa: E402
from diagnostics.explore.set_source import set_source  # noqa: E402
from diagnostics.indicators.table import record_table  # noqa: E402
from diagnostics.page.security_policy import script_hash  # noqa: E402
from diagnostics.page.template import page_html  # noqa: E402
from tests.diagnostics.conftest import memory_dataset  # noqa: E402

GEARBOXES, DURATION_S, TIMES, MANY = 33, 3.0, 10, 101
BROWSERS = ("chromium", "chromium-browser", "google-chrome")
SEEN: tuple[tuple[str, tuple[int, int], tuple[str, ...]], ...] = (
    ("1280 x 800", (1280, 800), ()),
    ("390 x 844", (390, 844), ()),
    ("dark", (1280, 800), ("--blink-settings=preferredColorScheme=0",)),
)
"""How pages are looked at: name, window, flags of the browser."""

NARROWEST = 500
"""No window of the browser is narrower [px]; a page that is seen in less stands in a frame."""

WATCH = """window.found={errors:[]};
addEventListener("error",(e)=>found.errors.push(String(e.message)));
addEventListener("unhandledrejection",(e)=>found.errors.push(String(e.reason)));
addEventListener("securitypolicyviolation",(e)=>found.errors.push("policy: "+e.violatedDirective+" "+e.blockedURI));
for(const kind of ["error","warn"]){const was=console[kind];
console[kind]=(...a)=>{found.errors.push(a.join(" "));was(...a)}}
"""
MEASURE = """(async()=>{
const frame=()=>new Promise((done)=>requestAnimationFrame(()=>setTimeout(done,0)));
await frame();found.first=performance.now();
const plot=Explore.plots.get(document.querySelector("#look-waveform .plot")),x=plot.data[0];
found.charts=Explore.plots.size;found.zoom=[];
for(let k=0;k<TIMES+2;k++){const begun=performance.now(),middle=x[0]+(x[x.length-1]-x[0])*(k+1)/(TIMES+4);
plot.setScale("x",{min:middle,max:middle+2});await frame();if(k>1)found.zoom.push(performance.now()-begun)}
found.open=[];
for(let k=0;k<TIMES;k++){const begun=performance.now();
Explore.open(k+1);await frame();found.open.push(performance.now()-begun)}
found.asked=performance.getEntriesByType("resource").map((one)=>one.name);
if(window.axe){const all=(await axe.run(document)).violations;
found.axe=all.map((v)=>({id:v.id,impact:v.impact,nodes:v.nodes.length,first:v.nodes[0].html.slice(0,160)}))}
await fetch("done",{method:"POST",body:JSON.stringify(found)})})()""".replace("TIMES", str(TIMES))


ASK = """addEventListener("load",async()=>{
await new Promise((done)=>setTimeout(done,400));
found.wide=Math.max(0,document.documentElement.scrollWidth-document.documentElement.clientWidth);
found.asked=performance.getEntriesByType("resource").map((one)=>one.name);
for(const body of document.querySelectorAll("tbody"))[...body.rows].slice(20).forEach((row)=>row.remove());
if(window.axe){const all=(await axe.run(document)).violations;
found.axe=all.map((v)=>({id:v.id,impact:v.impact,nodes:v.nodes.length,first:v.nodes[0].html.slice(0,160)}))}
await fetch("done",{method:"POST",body:JSON.stringify(found)})})"""


def axe_source(file: Path | None) -> str:
    """Return axe-core; nothing where it is not installed."""
    places = [file] if file else []
    for package in ("axe_core_python", "axe_playwright_python"):
        found = find_spec(package)
        places += [Path(folder) / "axe.min.js" for folder in (found.submodule_search_locations or [])] if found else []
    place = next((path for path in places if path.is_file()), None)
    return place.read_text(encoding="utf-8") if place else ""


def instrumented(page: str, more: str, asked: str = MEASURE) -> str:
    """Return the page with what watches it and asks it, with leave to run both and to send back what they found."""
    scripts = [script for script in (more, asked) if script]
    allowed = " ".join(map(script_hash, scripts))
    page = page.replace("default-src 'none';", "default-src 'none'; connect-src 'self';", 1)
    page = page.replace("script-src ", f"script-src {allowed} ", 1)
    elements = "".join(f"<script>{script}</script>" for script in scripts)
    watched = page.replace('<meta charset="utf-8">', f'<meta charset="utf-8"><script>{WATCH}</script>', 1)
    return watched.replace("</body>", f"{elements}</body>", 1)


def measured(program: str, page: str, size: tuple[int, int], flags: Sequence[str] = ()) -> dict[str, Any]:
    """Return what a browser found on a page."""
    answers: list[dict[str, Any]] = []
    narrow = size[0] < NARROWEST
    framed = f'<!doctype html><iframe src="/page" width="{size[0]}" height="{size[1]}"></iframe>' if narrow else ""
    done = threading.Event()

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            sent = {"/": framed or page, "/page": page}.get(self.path)
            self.send_response(204 if sent is None else 200)
            self.send_header("Content-Type", "text/html; charset=utf-8")
            self.end_headers()
            self.wfile.write((sent or "").encode("utf-8"))

        def do_POST(self) -> None:
            answers.append(json.loads(self.rfile.read(int(self.headers["Content-Length"]))))
            self.send_response(204)
            self.end_headers()
            done.set()

        def log_message(self, *_: Any) -> None:
            """Stay silent."""

    with ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server, tempfile.TemporaryDirectory() as profile:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        command = [
            *(program, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={profile}"),
            *("--no-first-run", f"--window-size={size[0]},{size[1]}", *flags),
        ]
        with subprocess.Popen(
            [*command, f"http://127.0.0.1:{server.server_port}/"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        ) as process:
            finished = done.wait(120)
            process.terminate()
        server.shutdown()
    if not finished:
        raise SystemExit("the page sent nothing back within two minutes")
    return answers[0]


def median(values: Sequence[float]) -> str:
    """Return the median with the range [ms]."""
    return f"{statistics.median(values):.0f} ms ({min(values):.0f} to {max(values):.0f})"


def browser() -> str:
    """Return the browser of this machine."""
    found = next((path for name in BROWSERS if (path := shutil.which(name))), None)
    if found is None:
        raise SystemExit(f"none of {', '.join(BROWSERS)} is installed")
    return found


def check_pages(pages: Sequence[Path], axe: str) -> None:
    """Print a row for each page and width."""
    program = browser()
    print("| page | seen | errors on the console | requests | beyond the screen | findings of axe-core |")
    print("|---|---|---|---|---|---|")
    for page in pages:
        text = instrumented(page.read_text(encoding="utf-8"), axe, ASK)
        for seen, size, flags in SEEN:
            found = measured(program, text, size, flags)
            said = (
                json.dumps(found["axe"]) if found.get("axe") else "none" if axe else "not checked: axe-core is missing"
            )
            print(
                f"| {page.name} | {seen} | {found['errors'] or 'none'} | {found['asked'] or 'none'} | "
                f"{found['wide']} px | {said} |"
            )


def few() -> PageSource:
    """Return the source of a page of all records of the set in memory."""
    dataset = memory_dataset(("train",) * GEARBOXES, duration_s=DURATION_S)
    return set_source(dataset, record_table(dataset), np.arange(dataset.labels().num_rows))


def many(source: PageSource) -> PageSource:
    """Return a source with the labels and indicators of all records many times, under numbers of their own."""
    records = source.labels["record_id"].size
    labels = {name: np.tile(values, MANY) for name, values in source.labels.items()}
    labels["record_id"] = np.arange(MANY * records)
    labels["specimen_id"] = labels["specimen_id"] + GEARBOXES * np.repeat(np.arange(MANY), records)
    indicators = [{**one, **packed_column(np.tile(unpacked_column(one), MANY))} for one in source.indicators]
    over = [None if row is None else row + k * records for k in range(MANY) for row in source.overlay]
    return replace(source, labels=labels, indicators=indicators, further={}, overlay=over)


def measure(name: str, source: PageSource, axe: str) -> None:
    """Load a page ten times after a warm-up, and print what was found."""
    program = browser()
    text = page_html(look_page("Records", look_of(source, RecordList(COLUMNS, FILTERS), silent_stage)))
    runs = [measured(program, instrumented(text, ""), (1280, 800)) for _ in range(TIMES + 1)][1:]
    print(f"| measured, {name}, {len(text.encode()) / 1e6:.1f} MB | median of ten (range) |")
    print("|---|---|")
    print(f"| first view, {runs[0]['charts']} charts | {median([run['first'] for run in runs])} |")
    print(f"| zoom of all charts that follow | {median([statistics.median(run['zoom']) for run in runs])} |")
    print(f"| another record | {median([statistics.median(run['open']) for run in runs])} |")
    print(f"| errors and warnings on the console | {sum(len(run['errors']) for run in runs)} |")
    print(f"| requests | {sum(len(run['asked']) for run in runs)} |")
    for seen, size, flags in SEEN:
        found = measured(program, instrumented(text, axe), size, flags).get("axe") if axe else None
        said = "not checked: axe-core is not installed" if found is None else json.dumps(found) if found else "none"
        print(f"| findings of axe-core, {seen} | {said} |")


def main() -> None:
    """Check the named pages, or measure those of few and of many records."""
    parser = argparse.ArgumentParser()
    parser.add_argument("pages", nargs="*", type=Path, metavar="PAGE")
    parser.add_argument("--axe", type=Path, help="axe.min.js, where no package brings it")
    asked = parser.parse_args()
    axe = axe_source(asked.axe)
    if asked.pages:
        check_pages(asked.pages, axe)
        return
    source = few()
    measure("99 records", source, axe)
    measure("9,999 records", many(source), axe)


if __name__ == "__main__":
    main()
