"""Progress of commands whose stderr is a file: the log of a job says how far they are."""

from __future__ import annotations

import re
import sys
import time

import pytest

from diagnostics.base.progress import terminal_stage
from siggen.cli import working


def test_a_log_gets_a_plain_line_now_and_then_and_a_short_stage_none(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    with terminal_stage("saving", 1) as advance:
        advance()
    assert capsys.readouterr().err == ""
    monkeypatch.setattr(working, "LINE_EVERY_S", 0.01)
    said = ""
    with terminal_stage("indicators", 7) as advance:
        for _ in range(3):
            advance()
        while "\n" not in said:
            time.sleep(0.01)
            sys.stderr.flush()
            said += capsys.readouterr().err
    assert re.match(r"indicators: [0-3] of 7, 0 s\n", said)
    assert "\x1b" not in said
    assert "\r" not in said
