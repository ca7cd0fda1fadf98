"""Progress of commands whose stderr is a file: the log of a job says how far they are."""

from __future__ import annotations

import pytest

from diagnostics.base import progress


def test_a_log_gets_a_line_now_and_then_and_a_short_stage_none(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    now_s = 100.0
    monkeypatch.setattr(progress.time, "monotonic", lambda: now_s)
    with progress.terminal_stage("indicators", 7) as advance:
        for _ in range(7):
            now_s += 12.0
            advance()
    with progress.terminal_stage("saving", 1) as advance:
        advance()
    assert capsys.readouterr().err == "indicators: 3 of 7\nindicators: 6 of 7\n"
