"""The built site, opened from its folder: complete, found by its search, with the examples as pages and notebooks."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.house.source_tree import ROOT

pytestmark = [pytest.mark.slow, pytest.mark.timeout(3600)]  # builds the whole site
BROWSER = next(
    (found for name in ("chromium", "chromium-browser", "google-chrome") if (found := shutil.which(name))), ""
)
TYPED = """<script>
addEventListener("load", () => setTimeout(() => {
  document.querySelector(".md-search__button").click();
  const search = [...document.querySelectorAll("*")].find((one) => one.shadowRoot).shadowRoot;
  const field = search.querySelector("input");
  field.value = "spall face";
  field.dispatchEvent(new Event("input", { bubbles: true }));
  setInterval(() => { document.body.dataset.found = search.querySelector("[role=status]")?.textContent; }, 100);
}, 1000));
</script></body>"""
"""What a reader does: a click on the search, two words into its field. What is said goes where --dump-dom sees it."""
FETCHED = re.compile(r"<(?:script|img)[^>]*\ssrc=\"?https?:|<link[^>]*stylesheet[^>]*href=\"?https?:")


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("built") / "site"
    command = [sys.executable, str(ROOT / "docs/scripts/documentation_site.py"), str(folder)]
    built = subprocess.run(command, capture_output=True, text=True, check=False)
    assert built.returncode == 0, built.stdout + built.stderr
    return folder


def test_the_site_builds_without_warnings_and_fetches_nothing(site: Path) -> None:
    pages = list(site.rglob("*.html"))
    assert len(pages) > 40
    assert [page for page in pages if FETCHED.search(page.read_text(encoding="utf-8"))] == []


def test_every_example_has_a_page_with_its_picture_and_a_notebook(site: Path) -> None:
    for example in (ROOT / "examples").glob("*.py"):
        page = (site / "examples" / f"{example.stem}.html").read_text(encoding="utf-8")
        assert f'src="../figures/examples/{example.stem}.png"' in page
        notebook = json.loads((site / "examples" / f"{example.stem}.ipynb").read_text(encoding="utf-8"))
        code = notebook["cells"][1]["source"]
        compile(code, example.name, "exec")
        assert "sys." not in code, example.name
        assert notebook["cells"][1]["outputs"]


@pytest.mark.skipif(not BROWSER, reason="no chromium or chrome on this machine")
def test_the_search_works_without_a_server(site: Path, tmp_path: Path) -> None:
    page = site / "start" / "typed.html"
    page.write_text((site / "start" / "demo.html").read_text(encoding="utf-8").replace("</body>", TYPED))
    command = [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path}"]
    command += ["--virtual-time-budget=20000", "--dump-dom", page.as_uri()]
    shown = subprocess.run(command, capture_output=True, text=True, check=True, timeout=300).stdout
    found = re.search(r'data-found="(\d+) results"', shown)
    assert found is not None
    assert int(found[1]) > 3
