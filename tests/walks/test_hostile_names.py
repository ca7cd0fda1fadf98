"""Names that a stranger chose, through every command that prints or writes them: shown, never obeyed."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pytest

from siggen.printable import markdown, printable
from tests.command import Ended, command
from tests.diagnostics.cli.test_bad_sets import good_set, rewritten

__all__ = ("good_set",)
HOSTILE = "\x1b[31mred\x1b]0;title\x07<script>alert(1)</script>\u202eevil\x9b2J[/b]"
SHOWN = r"\x1b[31mred\x1b]0;title\x07<script>alert(1)</script>\u202eevil\x9b2J[/b]"


@pytest.fixture(scope="module")
def strange(good_set: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A set whose state, and whose folder, have a hostile name."""
    folder = tmp_path_factory.mktemp("strange") / HOSTILE.replace("/", "|")
    shutil.copytree(good_set, folder)

    def renamed(table: pa.Table) -> pa.Table:
        states = table["state"]
        return table.set_column(
            table.schema.get_field_index("state"),
            table.schema.field("state"),
            pc.if_else(pc.equal(states, "severe"), HOSTILE, states).cast(states.type),
        )

    rewritten(folder, renamed, ("data", "labels"))
    return folder


def test_a_text_is_shown_with_all_that_is_no_visible_sign_written_out() -> None:
    assert printable(HOSTILE) == SHOWN
    assert printable("two\nlines") == r"two\x0alines"
    assert printable("two\nlines é Ω 漢 N\N{NO-BREAK SPACE}m", lines=True) == "two\nlines é Ω 漢 N\N{NO-BREAK SPACE}m"
    assert printable("\ud800\u2028\U000e0041") == r"\ud800\u2028\U000e0041"
    assert "<" not in markdown(HOSTILE)
    assert markdown("a|b`c`[d](e)") == "a&#124;b&#96;c&#96;&#91;d&#93;(e)"


@pytest.mark.parametrize(
    "line",
    [
        "siggen show SET --record 2",
        "siggen verify SET --sample 0",
        "diagnostics indicators SET --out OUT/indicators",
        pytest.param("diagnostics audit SET --out OUT/audit", marks=pytest.mark.slow),
        pytest.param("diagnostics report SET --no-cnn --out OUT/report", marks=pytest.mark.slow),
        pytest.param("diagnostics explore SET --out OUT/page.html", marks=pytest.mark.slow),
    ],
)
def test_commands_on_a_set_show_its_names(line: str, strange: Path, tmp_path: Path) -> None:
    package, *rest = (part.replace("SET", str(strange)).replace("OUT", str(tmp_path)) for part in line.split())
    said = command(package, *rest)
    assert printable(said.stdout + said.stderr, lines=True) == said.stdout + said.stderr
    assert said.returncode in (0, 2, 4), said.stderr
    for file in tmp_path.rglob("*"):
        if file.suffix in (".md", ".html"):
            text = file.read_text(encoding="utf-8")
            assert "<script>alert" not in text
            assert "\x1b" not in text
        if file.suffix == ".md":
            assert "red\\x1b" in text


def test_commands_on_files_show_their_names_and_columns(tmp_path: Path) -> None:
    recording = tmp_path / f"{HOSTILE.replace('/', '|')}.csv"
    column = HOSTILE.replace(",", "")
    np.savetxt(recording, np.zeros((100, 1)), header=column, comments="")
    gears = ("--fs", "4096", "--teeth", "20,30", "--speed", "10,30")
    shown = re.escape(SHOWN.replace("/", "|"))
    runs: dict[str, Callable[[], Ended]] = {
        "indicators": lambda: command("diagnostics", "indicators", str(recording), *gears),
        "baseline": lambda: command(
            "diagnostics", "baseline", *[str(recording)] * 4, *gears, "-o", str(tmp_path / "m")
        ),
        "predict": lambda: command("diagnostics", "predict", str(recording), str(recording), *gears),
        "check": lambda: command("diagnostics", "check", str(recording), str(recording)),
        "score": lambda: command("diagnostics", "score", str(recording), str(recording)),
        "plan": lambda: command("siggen", "plan", str(recording)),
    }
    for name, run in runs.items():
        done = run()
        assert done.returncode == 2, (name, done.stderr)
        said = done.stdout + done.stderr
        assert printable(said, lines=True) == said, name
        assert re.search(shown, said), (name, said)
