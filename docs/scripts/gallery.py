"""Run the examples, or print their page: `python docs/scripts/gallery.py > docs/start/gallery.md`.

With a folder, as in `python docs/scripts/gallery.py docs/figures/examples [NAME ...]`, each example draws its picture
there. They run one after the other in this process and in one new folder, so that a set is made once.
"""

from __future__ import annotations

import ast
import os
import runpy
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))
FIRST = ("gear_spectrum", "mesh_stiffness", "own_gearbox", "load_set", "own_classifier")
"""What a newcomer asks first; the others follow by name."""
TOP = """# Gallery

Each picture comes from a program of at most 40 lines, which runs in seconds: `python examples/gear_spectrum.py`. Copy
one and change it. [From the paper to a figure](from_the_paper.md) takes one apart.
"""


def question(path: Path) -> tuple[str, str]:
    """Return what an example asks, and its answer."""
    text = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8")))
    asked, _, said = str(text).partition("? ")
    return f"{asked}?", said


def ordered() -> list[Path]:
    """Return the examples as the page shows them."""
    place = {name: number for number, name in enumerate(FIRST)}
    return sorted(EXAMPLES, key=lambda path: (place.get(path.stem, len(FIRST)), path.stem))


def page() -> str:
    """Return the page."""
    parts = [TOP]
    for path in ordered():
        asked, said = question(path)
        parts.append(f"## {asked}\n\n{said} [`{path.stem}.py`](../../examples/{path.name})\n")
        parts.append(f'<img src="../figures/examples/{path.stem}.png" width="560" alt="{path.stem}">\n')
    return "\n".join(parts)


def draw(folder: Path, names: list[str]) -> None:
    """Run examples in a new folder; the picture of each goes to `folder`."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot

    folder = folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as work:
        os.chdir(work)
        sys.path.insert(0, work)  # as for a program that lies there
        for path in EXAMPLES:
            if not names or path.stem in names:
                sys.argv = [str(path), str(folder / f"{path.stem}.png")]
                runpy.run_path(str(path), run_name="__main__")
                pyplot.close("all")
        os.chdir(ROOT)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        draw(Path(sys.argv[1]), sys.argv[2:])
    else:
        print(page(), end="")
