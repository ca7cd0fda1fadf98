"""The documentation as a site: `python docs/scripts/documentation_site.py site` (`make docs`), with the extra `docs`.

Zensical reads a copy of docs/, in which every example has a page with its picture, and is there as a notebook. Nothing
is run: the pictures are those of docs/figures/examples.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
import tempfile
from base64 import b64encode
from pathlib import Path

from gallery import EXAMPLES, ROOT, question

LINK = re.compile(r"\]\((?:\.\./)+examples/(\w+)\.py\)")


def lay_out(docs: Path) -> None:
    """Copy docs/ to a folder, add a page and a notebook for every example, and lead links to an example there."""
    shutil.copytree(ROOT / "docs", docs)
    for page in docs.rglob("*.md"):
        up = "../" * (len(page.relative_to(docs).parts) - 1)
        page.write_text(LINK.sub(rf"]({up}examples/\1.md)", page.read_text(encoding="utf-8")), encoding="utf-8")
    (docs / "examples").mkdir()
    for path in EXAMPLES:
        source = path.read_text(encoding="utf-8")
        asked, said = question(path)
        text = (
            f"# {asked}\n\n{said} [As a notebook]({path.stem}.ipynb).\n\n```python\n{source}```\n\n"
            f"![{asked}](../figures/examples/{path.stem}.png)\n"
        )
        (docs / "examples" / f"{path.stem}.md").write_text(text, encoding="utf-8")
        (docs / "examples" / f"{path.stem}.ipynb").write_text(notebook(path.stem, source), encoding="utf-8")


def notebook(name: str, source: str) -> str:
    """Return an example as a notebook, with its picture as the output."""
    picture = b64encode((ROOT / "docs" / "figures" / "examples" / f"{name}.png").read_bytes()).decode()
    code = re.sub(r"^import sys\n", "", source.partition('"""\n')[2].strip(), flags=re.MULTILINE)
    code = re.sub(r"\S+\.savefig\(sys\.argv\[1\].*$", "plt.show()", code)
    shown = {"output_type": "display_data", "data": {"image/png": picture}, "metadata": {}}
    title = source.splitlines()[0].strip('"')
    cells = [
        {"cell_type": "markdown", "id": "title", "metadata": {}, "source": title},
        {"cell_type": "code", "id": "code", "metadata": {}, "source": code, "execution_count": 1, "outputs": [shown]},
    ]
    kernel = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}}
    return json.dumps({"cells": cells, "metadata": kernel, "nbformat": 4, "nbformat_minor": 5}, indent=1)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        place = Path(name)
        lay_out(place / "docs")
        shutil.copy(ROOT / "mkdocs.yml", place)
        subprocess.run([sys.executable, "-m", "zensical", "build", "--strict"], cwd=place, check=True)
        shutil.copytree(place / "site", sys.argv[1])
