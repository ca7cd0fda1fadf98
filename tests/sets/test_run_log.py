"""What a run tells: events with the documented fields, whatever the executor, and where its time went."""

from __future__ import annotations

import importlib.util
import json
import os
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from siggen.cli.app import app
from siggen.cli.run_display import RunDisplay, run_shown
from siggen.errors import EngineError, UsageError
from siggen.sets.run_journal import EVENTS, stamped
from tests.dataset.fake_set import simulate_with_a_bug, simulate_with_failures, write_fake_set

ROOT = Path(__file__).parents[2]
Told = list[Mapping[str, Any]]


def told(path: Path, **how: Any) -> Told:
    events: Told = []
    write_fake_set(path, events=events.append, **how)
    return events


def of(events: Told, name: str) -> Told:
    return [event for event in events if event["event"] == name]


def test_a_run_tells_its_start_every_shard_every_failure_and_its_end(tmp_path: Path) -> None:
    events = told(tmp_path, simulation=simulate_with_failures)
    assert (events[0]["event"], events[-1]["event"]) == ("run_started", "run_ended")
    assert {key: events[0][key] for key in ("name", "records", "shards", "workers")} == {
        "name": "fake",
        "records": 30,
        "shards": 5,
        "workers": 1,
    }
    assert [(event["record_id"], event["status"]) for event in of(events, "record_failed")] == [
        *((3, "diverged"), (8, "diverged"), (10, "not_finite")),
    ]
    done = of(events, "shard_done")
    assert [event["records_done"] for event in done] == [6, 12, 18, 24, 30]
    assert [event["rows"] + event["failures"] for event in done] == [6] * 5
    assert done[-1]["left_s"] == 0.0
    ended = events[-1]
    assert [ended[key] for key in ("outcome", "records_made", "failures")] == ["done", 30, 3]


def test_every_event_has_the_documented_fields_and_is_json(tmp_path: Path) -> None:
    events = told(tmp_path, simulation=simulate_with_failures)
    (tmp_path / "manifest.json").unlink()
    events += told(tmp_path)
    assert {event["event"] for event in events} == set(EVENTS) - {"said"}
    page = (ROOT / "docs/reference/run_log.md").read_text()
    for event in events:
        assert json.loads(json.dumps(event)) == event
        row = re.search(rf"^\| `{event['event']}` \| (.*) \|$", page, re.MULTILINE)
        assert row is not None
        documented = tuple(re.findall(r"`(\w+)`", row[1]))
        assert documented == EVENTS[event["event"]] == tuple(event)[2:]


@pytest.mark.parametrize(
    ("executor", "workers"),
    [
        pytest.param("processes", 2, marks=pytest.mark.slow),
        pytest.param("dask", 2, marks=pytest.mark.slow),
        pytest.param("ray", 2, marks=pytest.mark.slow),
    ],
)
@pytest.mark.filterwarnings("ignore")
def test_every_executor_tells_the_same(tmp_path: Path, executor: str, workers: int) -> None:
    for package, name in (("distributed", "dask"), ("ray", "ray")):
        if executor == name and importlib.util.find_spec(package) is None:
            pytest.skip(f"{package} is not installed")
    events = told(tmp_path, executor=executor, workers=workers, simulation=simulate_with_failures)
    serial = told(tmp_path.with_name(f"{tmp_path.name}_serial"), simulation=simulate_with_failures)
    assert [run[place]["event"] for run in (events, serial) for place in (0, -1)] == ["run_started", "run_ended"] * 2
    # shards are told as they are there: how many records are done by then is nobody's promise
    timing = {"time", "seconds", "records_per_s", "left_s", "stages", "path", "executor", "workers", "records_done"}
    kept = [[{key: value for key, value in e.items() if key not in timing} for e in run] for run in (events, serial)]
    assert sorted(map(str, kept[0])) == sorted(map(str, kept[1]))
    assert of(events, "shard_done")[-1]["records_done"] == 30
    assert set(events[-1]["stages"]["worker_cpu_s"]) == {"other", "rows", "files"}


def test_a_run_that_goes_on_tells_what_it_took_over_and_a_finished_set_that_there_is_nothing_to_do(
    tmp_path: Path,
) -> None:
    with pytest.raises(EngineError):
        told(tmp_path, simulation=simulate_with_a_bug)
    events = told(tmp_path)
    assert [event["shard"] for event in of(events, "shard_taken_over")] == ["train-00000"]
    assert (events[-1]["outcome"], events[-1]["shards_taken_over"]) == ("done", 1)
    assert [event["outcome"] for event in told(tmp_path)] == ["finished before"]


def test_a_run_that_fails_says_why_in_its_last_event(tmp_path: Path) -> None:
    events: Told = []
    with pytest.raises(EngineError):
        write_fake_set(tmp_path, simulation=simulate_with_a_bug, events=events.append)
    assert events[-1]["outcome"] == "failed"
    assert "record 8 raised ZeroDivisionError" in str(events[-1]["message"])


def test_a_log_holds_one_object_per_line_is_added_to_and_never_ends_a_run(tmp_path: Path, capsys: Any) -> None:
    log = tmp_path / "run.log"
    failure = {"shard": 0, "record_id": 1, "status": "failed", "reason": "line\nbreak"}
    for _ in range(2):
        with run_shown(str(log)) as shown:
            shown.events(stamped("record_failed", failure))
            assert shown.failures == 1
    assert [json.loads(line)["reason"] for line in log.read_text().splitlines()] == ["line\nbreak"] * 2
    with run_shown("-") as shown:
        shown.say("a sentence")
    assert json.loads(capsys.readouterr().err)["sentence"] == "a sentence"
    with Path("/dev/full").open("wb", buffering=0) as full:
        display = RunDisplay(lambda *_: None, lambda line: full.write(line.encode()))
        display.events({"event": "run_started"})
        display.events({"event": "run_ended"})
    assert capsys.readouterr().err.count("the run goes on") == 1
    missing = tmp_path / "missing" / "run.log"
    with pytest.raises(UsageError, match=r"--log-json: .* cannot be written"), run_shown(str(missing)):
        pass


@pytest.mark.parametrize("said", ["set", "set/config.yaml", "set/new.log", "aside/../set/new.log"])
@pytest.mark.parametrize("command", [["generate", "quickstart", "--out"]])
def test_a_log_in_the_folder_of_the_set_is_refused_and_nothing_is_written(
    command: list[str], said: str, tmp_path: Path
) -> None:
    write_fake_set(tmp_path / "set")
    before = {file: file.read_bytes() for file in (tmp_path / "set").rglob("*") if file.is_file()}
    result = CliRunner().invoke(app, [*command, str(tmp_path / "set"), "--log-json", str(tmp_path / said)])
    assert isinstance(result.exception, UsageError)
    assert "which holds the set alone" in str(result.exception)
    assert {file: file.read_bytes() for file in (tmp_path / "set").rglob("*") if file.is_file()} == before


@pytest.mark.parametrize(
    "held", ["name: mine\n", '{"name": "mine"}\n', "[1]\n", "\n", '{"event": ["said"], "time": 1}']
)
def test_a_log_is_not_added_to_what_is_no_log(held: str, tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text(held)
    with pytest.raises(UsageError, match="does not begin with an event"), run_shown(str(file)):
        pass
    assert file.read_text() == held


def test_a_pipe_without_a_reader_and_a_folder_are_refused_at_once(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", tmp_path, Path("/dev/null")):
        with pytest.raises(UsageError, match="is no regular file"), run_shown(str(path)):
            pass
