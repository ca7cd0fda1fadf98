"""What siggen prints and says about installing brings siggen, or a known program, and never that of a stranger.

No package index has siggen under a name of ours, so every line that installs it names a checkout or a wheel's file.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

from siggen.errors import DISTRIBUTION, how_to_install
from tests.house.source_tree import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
EXTRAS = PROJECT["optional-dependencies"]
FOLDERS = (".github", "benchmarks", "configs", "diagnostics", "docs", "locks", "siggen", "tests")
OURS = {"siggen", "diagnostics", "siggen-diagnostics", DISTRIBUTION}
OTHERS = {"axe-core-python", "build", "cyclonedx-bom", "isatools", "pip-audit", "plotly", "ross-rotordynamics", "uv"}
"""Names that a page may install beside the dependencies of pyproject.toml: tools that check or build."""
INSTALLS = re.compile(
    r"(?:(?:pip3?|conda|mamba|pipx|micropip)[ .]install|pipx run|uvx|uv (?:add|pip install|tool (?:run|install)))[ (]"
    r"(?P<operands>[^\n`;)#|&]*)"
)
FILE_OPTIONS = {"-c", "-r", "--constraint", "--requirement", "--wheel-dir"}
NAMED = re.compile(rf"\b({'|'.join(OURS)})\[({'|'.join(EXTRAS)})\b")


def name(requirement: str) -> str:
    """Return the name of a requirement, as "scikit-learn" of "scikit_learn>=1.4", in lower case."""
    return re.split(r"[\[<>=!~ ;]", requirement, maxsplit=1)[0].lower().replace("_", "-")


KNOWN = OTHERS | {name(one) for one in (*PROJECT["dependencies"], *(r for rows in EXTRAS.values() for r in rows))}


def strangers(text: str) -> Iterator[str]:
    """Yield what lines of a text install by a name that is not known, and every mention of an extra of such a name."""
    yield from (match[0] for match in NAMED.finditer(text))
    # Lists of arguments in Python, and strings of notebooks and messages, read as the command that they are.
    line_by_line = re.sub(r"['\"], ['\"]", " ", text).replace('"]', ";").replace("\\n", "\n").replace('\\"', '"')
    for match in INSTALLS.finditer(line_by_line):
        given = re.sub(r"""['"\]]*$|['",](?= |$)|(?<= )['"]|^['"]""", "", match["operands"].strip()).split()
        files = {i + 1 for i, part in enumerate(given) if part in FILE_OPTIONS}
        for i, part in enumerate(given):
            is_file = i in files or part.startswith(("-", "WHEEL")) or part[0] in "./$*{"
            if not is_file and "/" not in part and name(part) not in KNOWN:
                yield f"{part} in: {match[0].strip()}"


def pages() -> list[Path]:
    """Return every text of the checkout but this one, which holds lines that must be found."""
    inside = [path for folder in FOLDERS for path in (ROOT / folder).rglob("*") if path.is_file()]
    top = [path for path in ROOT.iterdir() if path.is_file()]
    kinds = {".cff", ".html", ".ipynb", ".md", ".py", ".toml", ".txt", ".yaml", ".yml", ""}
    return [path for path in (*top, *inside) if path.suffix in kinds and path != Path(__file__)]


def test_no_page_or_message_installs_a_program_of_somebody_else() -> None:
    found = {}
    for path in pages():
        text = path.read_text(encoding="utf-8", errors="replace")
        if bad := sorted(set(strangers(text))):
            found[str(path.relative_to(ROOT))] = bad
    assert not found


def test_no_list_of_requirements_names_siggen_itself() -> None:
    lists = [*(ROOT / "locks").iterdir(), ROOT / "constraints.txt"]
    named = {name(line) for path in lists for line in path.read_text(encoding="utf-8").splitlines()}
    assert "numpy" in named
    assert not (named | KNOWN) & OURS


@pytest.mark.parametrize(
    "line",
    [
        "pip install --upgrade siggen",
        "install with: pip install 'siggen[dask]'",
        'pip install "diagnostics"',
        f"python -m pip install -c constraints.txt {DISTRIBUTION}==0.3.0",
        f"uv add {DISTRIBUTION}",
        "uvx siggen plan quickstart",
        "%pip install numpy siggen",
        'subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "siggen"])',
        '    "!pip install siggen-gear\\n",',
        "needs the extra siggen[cnn]",
        "`pip install nunpy`",
    ],
)
def test_a_line_that_brings_a_stranger_is_noticed(line: str) -> None:
    assert list(strangers(line))


@pytest.mark.parametrize(
    "line",
    [
        how_to_install("cnn,dask"),
        ".venv/bin/python -m pip install -c constraints.txt -e '.[diagnostics,cnn]'",
        "pip install --no-deps dist/siggen_gears-0.3.0-py3-none-any.whl",
        "RUN python -m pip install --no-cache-dir --require-hashes -r /locks/siggen.txt",
        "`pip install ross-rotordynamics 'plotly<6'`",
        "python -m pip install scikit_learn   # siggen is there",
    ],
)
def test_a_line_that_installs_from_here_or_a_known_program_is_not(line: str) -> None:
    assert not list(strangers(line))


def test_the_distribution_has_the_name_that_messages_say() -> None:
    assert PROJECT["name"] == DISTRIBUTION
