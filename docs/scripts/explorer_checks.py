"""Print how fast the explorer's page is and what a browser says of it: `python docs/scripts/explorer_checks.py`.

With names of pages, of any command: only errors on the console, text beyond the width of the screen, and axe-core (of
a table its first 20 rows: all are written alike, and a thousand cells take minutes).
What headless chromium calls a narrower window is 500 pixels wide.

99 records of 33 gearboxes, 38,400 samples of two channels each: the set that the tests make in memory, made longer.
Needs chromium, and axe-core for the check of accessibility (`pip install axe-core-python`). A server on this machine
gives the page to the browser, which measures itself and sends back what it measured. First view: from the start of
navigation until the first frame with all charts. Zoom: from the call until the frame after it, with the charts that
follow. Medians of ten; every load starts a new browser.
"""

from __future__ import annotations

import json
import shutil
import statistics
import subprocess
import sys
import tempfile
import threading
from collections.abc import Sequence
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.util import find_spec
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from diagnostics.explore.explorer import ExplorerOptions, write_explorer  # noqa: E402
from tests.diagnostics.conftest import memory_dataset  # noqa: E402

GEARBOXES, DURATION_S, TIMES = 33, 3.0, 10
BROWSERS = ("chromium", "chromium-browser", "google-chrome")
SEEN: tuple[tuple[str, tuple[int, int], tuple[str, ...]], ...] = (
    ("1280 x 800", (1280, 800), ()),
    ("500 x 844", (500, 844), ()),
    ("dark", (1280, 800), ("--blink-settings=preferredColorScheme=0",)),
)
"""How pages are looked at: name, window, flags of the browser."""

WATCH = """<script>window.found={errors:[]};
addEventListener("error",(e)=>found.errors.push(String(e.message)));
addEventListener("unhandledrejection",(e)=>found.errors.push(String(e.reason)));
addEventListener("securitypolicyviolation",(e)=>found.errors.push("policy: "+e.violatedDirective+" "+e.blockedURI));
for(const kind of ["error","warn"]){const was=console[kind];
console[kind]=(...a)=>{found.errors.push(a.join(" "));was(...a)}}
</script>"""
MEASURE = """<script>(async()=>{
const frame=()=>new Promise((done)=>requestAnimationFrame(()=>setTimeout(done,0)));
await frame();found.first=performance.now();
const plot=[...Explore.plots.values()][0],x=plot.data[0];found.charts=Explore.plots.size;found.zoom=[];
for(let k=0;k<TIMES+2;k++){const begun=performance.now(),middle=x[0]+(x[x.length-1]-x[0])*(k+1)/(TIMES+4);
plot.setScale("x",{min:middle,max:middle+2});await frame();if(k>1)found.zoom.push(performance.now()-begun)}
found.open=[];
for(let k=0;k<TIMES;k++){const begun=performance.now();
Explore.open(k+1);await frame();found.open.push(performance.now()-begun)}
if(window.axe){const all=(await axe.run(document)).violations;
found.axe=all.map((v)=>({id:v.id,impact:v.impact,nodes:v.nodes.length,first:v.nodes[0].html.slice(0,160)}))}
await fetch("done",{method:"POST",body:JSON.stringify(found)})})()</script>""".replace("TIMES", str(TIMES))


ASK = """<script>addEventListener("load",async()=>{
found.wide=Math.max(0,document.documentElement.scrollWidth-innerWidth);
for(const body of document.querySelectorAll("tbody"))[...body.rows].slice(20).forEach((row)=>row.remove());
const all=(await axe.run(document)).violations;
found.axe=all.map((v)=>({id:v.id,impact:v.impact,nodes:v.nodes.length,first:v.nodes[0].html.slice(0,160)}));
await fetch("done",{method:"POST",body:JSON.stringify(found)})})</script>"""


def axe_source() -> str:
    """Return axe-core as a script element; nothing where it is not installed."""
    for package in ("axe_core_python", "axe_playwright_python"):
        found = find_spec(package)
        for folder in (found.submodule_search_locations or []) if found else []:
            if (path := Path(folder) / "axe.min.js").is_file():
                return f"<script>{path.read_text(encoding='utf-8')}</script>"
    return ""


def instrumented(page: str, more: str, asked: str = MEASURE) -> str:
    """Return the page with what watches it and asks it, and with leave to send back what it found."""
    page = page.replace("default-src 'none';", "default-src 'none'; connect-src 'self';", 1)
    return page.replace('<meta charset="utf-8">', f'<meta charset="utf-8">{WATCH}', 1).replace(
        "</body>", f"{more}{asked}</body>", 1
    )


def measured(program: str, page: str, size: tuple[int, int], flags: Sequence[str] = ()) -> dict[str, Any]:
    """Return what a browser found on a page."""
    answers: list[dict[str, Any]] = []
    done = threading.Event()

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self.send_response(200 if self.path == "/" else 204)
            self.send_header("Content-Type", "text/html; charset=utf-8")
            self.end_headers()
            if self.path == "/":
                self.wfile.write(page.encode("utf-8"))

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


def check_pages(pages: Sequence[str]) -> None:
    """Print a row for each page and width."""
    axe, program = axe_source(), browser()
    if not axe:
        raise SystemExit("axe-core is not installed: pip install axe-core-python")
    print("| page | seen | errors on the console | beyond the screen | findings of axe-core |")
    print("|---|---|---|---|---|")
    for name in pages:
        text = instrumented(Path(name).read_text(encoding="utf-8"), axe, ASK)
        for seen, size, flags in SEEN:
            found = measured(program, text, size, flags)
            said = json.dumps(found["axe"]) if found["axe"] else "none"
            print(f"| {Path(name).name} | {seen} | {found['errors'] or 'none'} | {found['wide']} px | {said} |")


def main() -> None:
    """Make the page, load it ten times after a warm-up, and print what was found."""
    program = browser()
    dataset = memory_dataset(("train",) * GEARBOXES, duration_s=DURATION_S)
    with tempfile.TemporaryDirectory() as folder:
        path = write_explorer(dataset, Path(folder) / "page.html", ExplorerOptions())
        text = path.read_text(encoding="utf-8")
    plain = instrumented(text, "")
    runs = [measured(program, plain, (1280, 800)) for _ in range(TIMES + 1)][1:]
    print("| measured | median of ten (range) |")
    print("|---|---|")
    print(f"| first view, {runs[0]['charts']} charts | {median([run['first'] for run in runs])} |")
    print(f"| zoom of all charts that follow | {median([statistics.median(run['zoom']) for run in runs])} |")
    print(f"| another record | {median([statistics.median(run['open']) for run in runs])} |")
    print(f"| errors and warnings on the console | {sum(len(run['errors']) for run in runs)} |")
    axe = axe_source()
    for seen, size, flags in SEEN:
        found = measured(program, instrumented(text, axe), size, flags).get("axe") if axe else None
        said = "not checked: axe-core is not installed" if found is None else json.dumps(found) if found else "none"
        print(f"| findings of axe-core, {seen} | {said} |")


if __name__ == "__main__":
    if sys.argv[1:]:
        check_pages(sys.argv[1:])
    else:
        main()
