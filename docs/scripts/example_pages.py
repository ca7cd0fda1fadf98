"""Show the examples in the site, each with its picture and as a notebook: a hook of mkdocs, named in mkdocs.yml.

Nothing is run: the pictures are those of docs/figures/examples.
"""

from __future__ import annotations

import json
import re
from base64 import b64encode

from gallery import EXAMPLES, ROOT, question
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files, InclusionLevel
from mkdocs.structure.pages import Page

LINK = re.compile(r"\]\((?:\.\./)+examples/(\w+)\.py\)")


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add a page and a notebook for every example."""
    for path in EXAMPLES:
        source = path.read_text(encoding="utf-8")
        asked, said = question(path)
        text = (
            f"# {asked}\n\n{said} [As a notebook]({path.stem}.ipynb).\n\n```python\n{source}```\n\n"
            f"![{asked}](../figures/examples/{path.stem}.png)\n"
        )
        place, apart = f"examples/{path.stem}", InclusionLevel.NOT_IN_NAV  # the gallery leads to them
        files.append(File.generated(config, f"{place}.md", content=text, inclusion=apart))
        files.append(File.generated(config, f"{place}.ipynb", content=notebook(path.stem, source)))
    return files


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


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:  # noqa: ARG001
    """Lead links to an example's file to its page."""
    up = "../" * page.file.src_uri.count("/")
    return LINK.sub(rf"]({up}examples/\1.md)", markdown)
