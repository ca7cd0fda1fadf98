"""Show the notebooks in the site as pages with what they print and draw: a hook of mkdocs, named in mkdocs.yml.

The repository keeps notebooks without outputs, so the build executes them; run_notebooks.py keeps the executed copies.
"""

from __future__ import annotations

import logging
import re
from base64 import b64decode
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page
from run_notebooks import executed

LINK = re.compile(r"(\]\([^()\s]*)\.ipynb\)")
COLOUR = re.compile(r"\x1b\[[0-9;]*m")


@dataclass
class NotebookPage:
    """A notebook as Markdown, and the pictures of it by their file names."""

    name: str
    parts: list[str] = field(default_factory=list)
    pictures: dict[str, bytes] = field(default_factory=dict)

    def add_cell(self, cell: Any) -> None:
        """Add the text of a cell, or its code with what that printed and drew."""
        if cell.cell_type != "code":
            self.parts.append(cell.source)
            return
        self.parts.append(f"```python\n{cell.source}\n```")
        for output in cell.outputs:
            self._add_output(output)

    def _add_output(self, output: Any) -> None:
        data = output.get("data", {})
        if "image/png" in data:
            name = f"{self.name}_{len(self.pictures) + 1}.png"
            self.pictures[name] = b64decode(data["image/png"])
            self.parts.append(f"![what the cell above draws]({name})")
        elif output.output_type == "stream" and output.name == "stdout":
            self.parts.append(_fenced(output.text))
        elif "text/plain" in data:
            self.parts.append(_fenced(data["text/plain"]))


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add a page for every notebook with its pictures; the notebook itself stays, to be downloaded."""
    for file in [file for file in files if file.src_uri.endswith(".ipynb")]:
        logging.getLogger("mkdocs").info("notebook %s: executed, unless a copy of this code is kept", file.src_uri)
        source = Path(config.docs_dir, file.src_uri)
        text, pictures = page_text(source.name, executed(source))
        folder = Path(file.src_uri).parent
        files.append(File.generated(config, str(folder / f"{source.stem}.md"), content=text))
        for name, content in pictures.items():
            files.append(File.generated(config, str(folder / name), content=content))
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:  # noqa: ARG001
    """Lead the links of other pages to the page of a notebook instead of to its file."""
    return markdown if page.file.generated_by else LINK.sub(r"\1.md)", markdown)


def page_text(file: str, notebook: Any) -> tuple[str, dict[str, bytes]]:
    """Return an executed notebook as Markdown, after its title a link to the file, and its pictures by name."""
    page = NotebookPage(Path(file).stem)
    heading, _, first = notebook.cells[0].source.partition("\n")
    page.parts += [heading, f"[{file}]({file}) is this page as a notebook.", first.strip()]
    for cell in notebook.cells[1:]:
        page.add_cell(cell)
    return "\n\n".join(page.parts) + "\n", page.pictures


def _fenced(text: str) -> str:
    return f"```text\n{COLOUR.sub('', text).rstrip()}\n```"
