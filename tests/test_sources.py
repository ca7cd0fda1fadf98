"""The digest of the sources: of their names and contents alone, wherever the package lies."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from siggen.dataset.environment import MAKES_RECORDS
from siggen.sources import PACKAGE, sources_digest
from tests.house.source_tree import imports, modules

SAY = "import sys; from siggen.sources import sources_digest; print(sources_digest(tuple(sys.argv[1:])))"


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Copy the package as a wheel has it: the same files elsewhere, with compiled ones and presets beside them."""
    folder = tmp_path_factory.mktemp("site")
    shutil.copytree(PACKAGE, folder / "siggen", ignore=shutil.ignore_patterns("*.nbi", "*.nbc"))
    (folder / "siggen" / "presets").mkdir()
    return folder


def digest(folder: Path) -> str:
    command = [sys.executable, "-c", SAY, *MAKES_RECORDS]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True).stdout.strip()


def test_a_wheel_and_a_checkout_of_the_same_sources_have_the_same_digest(installed: Path) -> None:
    assert digest(installed) == sources_digest(MAKES_RECORDS)


@pytest.mark.parametrize(
    ("file", "counts"),
    [
        ("motion/runge_kutta.py", True),
        ("config/config.py", True),
        ("record/simulation.py", True),
        ("seeding.py", True),
        ("cli/app.py", False),
        ("views/record.py", False),
        ("workers/clusters.py", False),
        ("publication/publish.py", False),
    ],
)
def test_what_can_change_a_record_counts_and_nothing_else(installed: Path, file: str, counts: bool) -> None:
    path = installed / "siggen" / file
    content = path.read_bytes()
    path.write_bytes(content + b"# changed\n")
    try:
        assert (digest(installed) != sources_digest(MAKES_RECORDS)) == counts
    finally:
        path.write_bytes(content)


def test_every_pattern_matches_a_file() -> None:
    assert all(any(PACKAGE.glob(pattern)) for pattern in MAKES_RECORDS)


def test_whatever_the_simulation_imports_counts() -> None:
    tree = modules("siggen")
    known = set(tree)
    reached, left = set[str](), {"siggen.record.simulation"}
    while left:
        module = left.pop()
        reached.add(module)
        left |= (imports(tree[module], known) & known) - reached - {"siggen"}
    counted = {path for pattern in MAKES_RECORDS for path in PACKAGE.glob(pattern)}
    messages_and_digests = {"siggen.errors", "siggen.sources"}
    assert {m for m in reached if tree[m] not in counted} - messages_and_digests == set()
