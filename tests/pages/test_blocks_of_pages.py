"""Every command and every script of README.md and docs runs as it stands there, and prints what the page says."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from tests.dataset.s3_server import s3_server
from tests.pages.blocks import PAGES, ROOT, Block, blocks_of, given
from tests.pages.given import READ_ALONE, SMALLER, STORE, Given
from tests.pages.running import failing, reader_environment, reader_folder

Followed = Callable[[Path, bool], str]

INSTALLS = "not run: installs from the package index"
NOT_RUN = {
    "README.md": ["not run: installs from the package index, and runs these tests"],
    "docs/start/cluster.md": [
        "not run: the keys are those of your store",
        "needs: distributed",
        "not run: needs a cluster",
        "needs: ray",
        "not run: needs a cluster",
    ],
    "docs/start/demo.md": [INSTALLS],
    "docs/start/install.md": [INSTALLS, INSTALLS, INSTALLS, "not run: needs a container tool"],
    "docs/understand/run_to_failure.md": ["not run: minutes", "not run: minutes"],
    "docs/understand/siggen_bench.md": [
        "not run: simulates for minutes; tests/diagnostics/bench calls the same on short records"
    ],
}
"""Page -> what no test runs of it, and why. Nothing is added here that a smaller set or a local server could run."""


def blocks(page: Path) -> list[Block]:
    return blocks_of(page.read_text(encoding="utf-8"))


def named(page: Path) -> str:
    return str(page.relative_to(ROOT))


def pages(*, slow: bool) -> list[Path]:
    """Return the pages with a block to run; those with a slow one are followed a second time, as a whole."""
    return [page for page in PAGES if any(b.is_run and b.title is None and b.is_slow == slow for b in blocks(page))]


@pytest.fixture(scope="module")
def things(tmp_path_factory: pytest.TempPathFactory) -> Given:
    return Given(tmp_path_factory.mktemp("given"))


@pytest.fixture
def wrong(things: Given, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Followed]:
    """Give the function that follows a page and says what is wrong."""
    with ExitStack() as open_until_the_end:

        def followed(page: Path, slow: bool) -> str:
            wanted = [block for block in blocks(page) if block.is_run and (slow or not block.is_slow)]
            there = [b for b in wanted if all(importlib.util.find_spec(name) for name in b.marked("needs"))]
            folder = reader_folder(tmp_path, there)
            for name in given(page.read_text(encoding="utf-8"), slow=slow):
                things.put(name, folder, SMALLER if slow else READ_ALONE)
                if name == STORE:
                    open_until_the_end.enter_context(s3_server(monkeypatch))
            return failing(there, folder, reader_environment())

        yield followed


@pytest.mark.parametrize("page", pages(slow=False), ids=named)
def test_a_page_runs(page: Path, wrong: Followed) -> None:
    assert wrong(page, False) == ""


@pytest.mark.slow  # what a page marks as slow, and what it builds on
@pytest.mark.timeout(3600)
@pytest.mark.parametrize("page", pages(slow=True), ids=named)
def test_a_page_runs_with_its_slow_blocks(page: Path, wrong: Followed) -> None:
    assert wrong(page, True) == ""


def test_what_no_test_runs_is_listed_here_with_the_reason() -> None:
    marks = {
        named(page): [m for block in blocks(page) for m in block.marks if m.startswith(("not run", "needs"))]
        for page in PAGES
    }
    assert {page: found for page, found in marks.items() if found} == NOT_RUN


def test_every_fence_is_a_block() -> None:
    """No block hides from these tests: an indented one, one without an end, one of another kind."""
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        outputs = text.count("\n```output\n")
        assert text.count("```") == 2 * (len(blocks(page)) + outputs), named(page)
