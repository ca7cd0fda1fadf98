"""Show the notebooks in the site as pages: a hook of mkdocs, named in mkdocs.yml.

A notebook is kept without outputs, so its page is its text and its code. Nothing is added to it but a link to the file.
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

LINK = re.compile(r"(\]\([^()\s]*)\.ipynb\)")


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add a page for every notebook; the notebook itself stays, to be downloaded."""
    for file in [file for file in files if file.src_uri.endswith(".ipynb")]:
        source = Path(config.docs_dir, file.src_uri)
        uri = str(Path(file.src_uri).with_suffix(".md"))
        files.append(File.generated(config, uri, content=page_text(source)))
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:  # noqa: ARG001
    """Lead the links of other pages to the page of a notebook instead of to its file."""
    return markdown if page.file.generated_by else LINK.sub(r"\1.md)", markdown)


def page_text(notebook: Path) -> str:
    """Return the cells of a notebook as Markdown, after its title a link to the file."""
    cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
    title, *rest = (_cell_text(cell) for cell in cells)
    heading, _, first = title.partition("\n")
    file = f"[{notebook.name}]({notebook.name}) runs this page and shows its tables and figures."
    return "\n\n".join((heading, file, first.strip(), *rest)) + "\n"


def _cell_text(cell: dict[str, Any]) -> str:
    text = "".join(cell["source"])
    return f"```python\n{text}\n```" if cell["cell_type"] == "code" else text
