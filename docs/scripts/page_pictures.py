"""Pictures of the page for the documentation: `python docs/scripts/page_pictures.py PAGE`, of the report of quickstart.

Needs chromium. The page is opened as a reader opens it, at 1,280 pixels, once to ask where its parts lie and once to be
taken; each picture is a part of that. They go to docs/figures.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from page_checks import browser, instrumented, measured
from PIL import Image

FIGURES = Path(__file__).resolve().parents[1] / "figures"
WIDE, TALL, MOST = 1280, 9000, 96
"""Window, and colours of a picture."""

PARTS = {
    "page_first": ("h1", ".answer"),
    "page_choose": ("#look-histogram", "#look-list"),
    "page_record": ("#look-chosen", "#look-spectrum"),
}
"""Picture -> the elements from whose top to whose bottom it reaches."""

PLACES = """addEventListener("load",async()=>{await new Promise((done)=>setTimeout(done,1500));
const at=(name)=>document.querySelector(name).getBoundingClientRect();
found.at=PARTS.map(([first,last])=>[at(first).top+scrollY,Math.max(at(first).bottom,at(last).bottom)+scrollY]);
await fetch("done",{method:"POST",body:JSON.stringify(found)})})"""


def places(program: str, page: str) -> list[tuple[float, float]]:
    """Return top and bottom of every part [px]."""
    parts = str([list(ends) for ends in PARTS.values()])
    asked = instrumented(page, "", PLACES.replace("PARTS", parts))
    found: dict[str, Any] = measured(program, asked, (WIDE, TALL), ("--hide-scrollbars",))
    return [(top, bottom) for top, bottom in found["at"]]


def taken(program: str, page: Path, folder: Path) -> Image.Image:
    """Return a picture of the whole page."""
    shot = folder / "page.png"
    command = [program, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", f"--screenshot={shot}"]
    command += [f"--user-data-dir={folder}", f"--window-size={WIDE},{TALL}", "--virtual-time-budget=8000"]
    subprocess.run([*command, page.resolve().as_uri()], check=True, capture_output=True)
    return Image.open(shot).convert("RGB")


def main(page: Path) -> None:
    """Write all pictures and print their sizes."""
    program = browser()
    found = places(program, page.read_text(encoding="utf-8"))
    with tempfile.TemporaryDirectory() as folder:
        whole = taken(program, page, Path(folder))
    for name, (top, bottom) in zip(PARTS, found, strict=True):
        part = whole.crop((0, max(round(top) - 8, 0), WIDE, round(bottom) + 8))
        small = part.quantize(MOST, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
        small.save(FIGURES / f"{name}.png", optimize=True)
        print(f"{name}.png: {(FIGURES / f'{name}.png').stat().st_size / 1e3:.0f} kB")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
