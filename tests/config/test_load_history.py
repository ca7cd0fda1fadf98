"""History of load from a file: what it becomes, and how files that no gearbox can run by are refused."""

from __future__ import annotations

from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import yaml

from siggen.checks.loading import load_config
from siggen.errors import ConfigError
from siggen.planning.gearbox import gearbox_life
from tests.config.minimal import minimal

LIFE = {"reference_torque_nm": 60.0, "scale": 0.03, "interval_h": 1.2, "most": 6, "history": {"file": "load.csv"}}
GOOD = "until_h,torque_nm,speed_hz\n1.0,60.0,30.0\n1.5,0.0,0.0\n3.0,42.0,20.0\n"


def written(folder: Path, content: str) -> Path:
    """Return a configuration of lives beside a history."""
    (folder / "load.csv").write_text(content)
    file = folder / "lives.yaml"
    file.write_text(yaml.safe_dump(minimal(states=[], life=LIFE, duration_s=0.05, fs_hz=20_000.0)))
    return file


def test_rows_of_a_file_wear_and_turn_as_they_say_and_begin_again_after_the_last(tmp_path: Path) -> None:
    clock = gearbox_life(load_config(written(tmp_path, GOOD)), 0).clock
    first, last = 3600.0 * 30.0, 3600.0 * 1.5 * 20.0 * 0.7**10
    assert clock.time(1.25) == pytest.approx(first / 0.03, rel=1e-12)  # standstill wears nothing
    assert clock.time(7.0) == pytest.approx((3 * first + 2 * last) / 0.03, rel=1e-12)  # two rounds, and an hour
    assert clock.turns(4.0) == pytest.approx(3600.0 * (2 * 30.0 + 1.5 * 20.0), rel=1e-12)
    for time in (0.3 * first / 0.03, (first + 0.5 * last) / 0.03, 2.6 * (first + last) / 0.03):
        assert clock.time(clock.age_h(time)) == pytest.approx(time, rel=1e-12)


def test_the_numbers_not_the_file_are_part_of_the_set(tmp_path: Path) -> None:
    loaded = load_config(written(tmp_path, GOOD))
    table = pa.table({"speed_hz": [30.0, 0.0, 20.0], "torque_nm": [60.0, 0.0, 42.0], "until_h": [1.0, 1.5, 3.0]})
    pq.write_table(table, tmp_path / "load.parquet")
    assert load_config(tmp_path / "lives.yaml", ["life.history.file=load.parquet"]).identity == loaded.identity
    (tmp_path / "load.csv").unlink()
    assert load_config(loaded.canonical()) == loaded


@pytest.mark.parametrize(
    ("content", "received", "allowed"),
    [
        (GOOD.replace("42.0", "-42.0"), "load.csv, line 4: torque_nm -42", "from 0 to"),
        (GOOD.replace("1.5,", "0.5,"), "load.csv, line 3: until_h 0.5", "above 1, the hour before"),
        (GOOD.replace("1.0,", "0,", 1), "load.csv, line 2: until_h 0", "above 0"),
        (GOOD.replace("60.0,", ","), "load.csv, line 2: torque_nm nothing", "a number"),
        (GOOD.replace("20.0", "fast"), "load.csv, line 4: speed_hz 'fast'", "a number"),
        (GOOD.replace("20.0", "nan"), "load.csv, line 4: speed_hz nan", "from 0 to"),
        (GOOD.replace("speed_hz", "speed"), "load.csv without a column speed_hz", "did you mean 'speed'?"),
        ("until_h,torque_nm,speed_hz\n", "load.csv with no rows", "1 to 10000 rows"),
        (GOOD + "\n".join(f"{4 + i},1,1" for i in range(10_000)), "load.csv with more than 10000 rows", "join rows"),
    ],
)
def test_a_file_that_no_gearbox_can_run_by_is_refused_by_key_and_line(
    tmp_path: Path, content: str, received: str, allowed: str
) -> None:
    with pytest.raises(ConfigError) as error:
        load_config(written(tmp_path, content))
    (problem,) = error.value.problems
    assert problem.path == "life.history.file"
    assert problem.received == received
    assert allowed in problem.allowed
    assert "line" in problem.where  # of the configuration


def test_a_file_that_is_missing_or_never_loads_is_refused(tmp_path: Path) -> None:
    with pytest.raises(
        ConfigError, match=r"life\.history\.file: received none\.csv, which cannot be read \(No such file"
    ):
        load_config(written(tmp_path, GOOD), ["life.history.file=none.csv"])
    with pytest.raises(ConfigError, match=r"life\.history: received no block with torque and speed above 0"):
        load_config(written(tmp_path, "until_h,torque_nm,speed_hz\n1,60,0\n2,0,30\n"))
