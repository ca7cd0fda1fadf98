"""The built site, opened from its folder: complete, found by its search, with what the notebooks print and draw."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.house.source_tree import ROOT

pytestmark = [pytest.mark.slow, pytest.mark.timeout(3600)]  # builds the whole site, executes all notebooks
BROWSER = next(
    (found for name in ("chromium", "chromium-browser", "google-chrome") if (found := shutil.which(name))), ""
)
FETCHED = re.compile(r"<(?:script|img)[^>]*\ssrc=\"?https?:|<link[^>]*stylesheet[^>]*href=\"?https?:")


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pytest.importorskip("nbclient")
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(folder)]
    built = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert built.returncode == 0, built.stderr
    return folder


def test_the_site_builds_without_warnings_and_fetches_nothing(site: Path) -> None:
    pages = list(site.rglob("*.html"))
    assert len(pages) > 40
    assert [page for page in pages if FETCHED.search(page.read_text(encoding="utf-8"))] == []


def test_notebooks_show_what_they_print_and_draw(site: Path) -> None:
    for notebook in (ROOT / "docs" / "notebooks").glob("*.ipynb"):
        page = (site / "notebooks" / f"{notebook.stem}.html").read_text(encoding="utf-8")
        assert page.count('class="language-text') >= 2, notebook.stem
        pictures = re.findall(rf'src="({notebook.stem}_\d+\.png)"', page)
        assert pictures or notebook.stem == "train_in_torch"
        assert all((site / "notebooks" / name).stat().st_size > 5_000 for name in pictures)


@pytest.mark.skipif(not BROWSER, reason="no chromium or chrome on this machine")
def test_the_search_works_without_a_server(site: Path, tmp_path: Path) -> None:
    page = (site / "start" / "demo.html").as_uri() + "?q=spall+face"
    command = [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path}"]
    command += ["--virtual-time-budget=20000", "--dump-dom", page]
    shown = subprocess.run(command, capture_output=True, text=True, check=True, timeout=300).stdout
    found = re.search(r"(\d+) matching documents", shown)
    assert found is not None
    assert int(found[1]) > 3
