"""Commands on sets that are not what they should be: exit code 2, what is wrong and where, and the way out."""

from __future__ import annotations

import json
import shutil
import sys
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from diagnostics.cli.app import main
from diagnostics.indicators.classifier_table import table_notes
from siggen.columns.record import SimulatedRecord
from siggen.dataset.seal import sealed
from siggen.gearbox.design import SetDesign
from siggen.gearbox.plan import planned_record
from tests.dataset.fake_set import fake_config, fake_record, write_fake_set
from tests.dataset.resealed_set import reseal

COMMANDS = {
    "indicators": ("--out", "out"),
    "table": ("--out", "out.parquet"),
    "report": ("--no-cnn", "--out", "out"),
    "audit": ("--out", "out"),
}
CHANNEL = "bearing_vertical"
Edit = Callable[[Path], object]


def turning(config: SetDesign, record_ids: Sequence[int]) -> list[SimulatedRecord]:
    """Stand in for the physics, with ten pulses: nine revolutions of the pinion, three of the gear."""
    found = [fake_record(config, planned_record(config, i)) for i in record_ids]
    return [replace(record, tacho_s=np.arange(10) / 30.0 + 0.001) for record in found]


@pytest.fixture(scope="session")
def good_set(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Eight gearboxes in three states, one record each."""
    folder = tmp_path_factory.mktemp("sets") / "good"
    config = fake_config(
        specimens=8,
        fs_hz=12_800.0,
        duration_s=0.32,
        operating_points=[{"speed_hz": 30.0, "torque_nm": 60.0}],
        splits={"train": 10, "validation": 4, "test": 6},
    )
    write_fake_set(folder, config, simulation=turning)
    return folder


def run(monkeypatch: pytest.MonkeyPatch, command: str, *arguments: str) -> int:
    monkeypatch.setattr(sys, "argv", ["siggen-diagnostics", command, *arguments])
    try:
        main()
    except SystemExit as stop:
        return int(stop.code or 0)
    return 0


def rewritten(folder: Path, change: Callable[[pa.Table], pa.Table], kinds: Iterable[str] = ("data",)) -> None:
    for kind in kinds:
        files = [folder / "labels.parquet"] if kind == "labels" else sorted((folder / kind).glob("*.parquet"))
        for file in files:
            pq.write_table(change(pq.read_table(file)), file)
    reseal(folder)


def samples(change: Callable[[np.ndarray, np.ndarray], None]) -> Edit:
    """Return an edit of the samples (rows, n) of one channel, which also sees the record ids."""

    def changed(table: pa.Table) -> pa.Table:
        place = table.schema.get_field_index(f"accel_{CHANNEL}_m_s2")
        kind = table.schema.field(place).type
        values = np.array(table.column(place).combine_chunks().flatten()).reshape(-1, kind.list_size)
        change(values, table.column("record_id").to_numpy())
        array = pa.FixedSizeListArray.from_arrays(pa.array(values.ravel(), pa.float32()), type=kind)
        return table.set_column(place, table.schema.field(place), array)

    return lambda folder: rewritten(folder, changed)


def column(name: str, value: object, kinds: Iterable[str] = ("data",)) -> Edit:
    def changed(table: pa.Table) -> pa.Table:
        place = table.schema.get_field_index(name)
        kind = table.schema.field(place).type
        return table.set_column(place, pa.field(name, kind), pa.array([value] * table.num_rows, kind))

    return lambda folder: rewritten(folder, changed, kinds)


def some_rows(wanted: Callable[[dict[str, object]], bool]) -> Edit:
    def changed(table: pa.Table) -> pa.Table:
        labels = table.select(["state", "specimen_id"]).to_pylist()
        return table.filter(pa.array([wanted(row) for row in labels], pa.bool_()))

    return lambda folder: rewritten(folder, changed, ("data", "labels"))


def not_a_number(values: np.ndarray, record_ids: np.ndarray) -> None:
    values[record_ids == 3, 5:8] = np.nan


def constant(values: np.ndarray, record_ids: np.ndarray) -> None:
    values[record_ids == 3] = 0.5


def clipped(values: np.ndarray, record_ids: np.ndarray) -> None:
    np.clip(values, -10.0, 10.0, out=values)


def clipped_once(values: np.ndarray, record_ids: np.ndarray) -> None:
    values[record_ids == 3] = np.clip(values[record_ids == 3], -10.0, 10.0)


def first_shard(folder: Path) -> Path:
    return min((folder / "data").glob("*.parquet"))


def truncated(folder: Path) -> None:
    content = first_shard(folder).read_bytes()
    first_shard(folder).write_bytes(content[: len(content) // 2])


def emptied(folder: Path) -> None:
    shutil.rmtree(folder)
    folder.mkdir()


def photos(folder: Path) -> None:
    emptied(folder)
    (folder / "photo.jpg").write_bytes(b"x")


def at_no_rate(folder: Path) -> None:
    manifest = json.loads((folder / "manifest.json").read_bytes())
    manifest.pop("digest")
    (folder / "manifest.json").write_bytes(sealed({**manifest, "fs_hz": None}))


ONE = ("table",)
"""A mistake in samples goes to all commands but `indicators`, which leaves records out, the others to one."""
BAD: dict[str, tuple[Edit, tuple[str, ...], tuple[str, ...]]] = {
    "nan": (samples(not_a_number), ("channel bearing_vertical", "not finite", "3"), ("table", "report", "audit")),
    "constant": (samples(constant), ("channel bearing_vertical", "constant", "3"), ONE),
    "clipped": (samples(clipped), ("channel bearing_vertical", "clipped", "range_m_s2"), ONE),
    "few revolutions": (column("tacho_s", [0.1, 0.13]), ("1 whole turns of the first shaft", "duration_s"), ONE),
    "no pulses": (column("tacho_s", []), ("0 whole turns of the first shaft", "--speed"), ONE),
    "pulses backwards": (column("tacho_s", [0.1, 0.05, 0.2, 0.3]), ("not finite and increasing", "tacho_s"), ONE),
    "unknown teeth": (
        column("teeth_gear", None, ("data", "labels")), ("its column teeth_gear holds nulls", "siggen verify"), ONE,
    ),
    "too few teeth": (column("teeth_pinion", 2, ("data", "labels")), ("received 2, 47", "from 3 on"), ONE),
    "no rate": (at_no_rate, ("fs_hz: received None", "a valid number"), ONE),
    "truncated shard": (truncated, ("data/test-00000.parquet has ", "bytes instead of", "siggen verify"), ONE),
    "missing shard": (lambda folder: first_shard(folder).unlink(), ("test-00000.parquet is missing",), ONE),
    "no manifest": (lambda folder: (folder / "manifest.json").unlink(), ("not finished", "siggen generate"), ONE),
    "broken manifest": (lambda folder: (folder / "manifest.json").write_text("{"), ("manifest.json",), ONE),
    "empty folder": (emptied, ("no data set here",), ONE),
    "photos": (photos, ("not a siggen data set",), ONE),
    "no rows": (some_rows(lambda row: False), ("no ", "records"), ("table", "indicators", "audit")),
    "no healthy": (
        some_rows(lambda row: row["state"] != "healthy"), ("no healthy records", "--out FILE.parquet"), ("indicators",),
    ),
    "healthy only": (some_rows(lambda row: row["state"] == "healthy"), ("no damaged records",), ("indicators",)),
}  # fmt: skip
"""What is wrong: how it is made, what the message has to say besides the set's name, and which commands refuse it."""


@pytest.mark.parametrize(
    ("what", "command"), [(what, command) for what, (_, _, commands) in BAD.items() for command in commands]
)
def test_a_bad_set_ends_with_2_what_is_wrong_and_the_way_out(
    what: str,
    command: str,
    good_set: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    folder = tmp_path / "bad_set"
    shutil.copytree(good_set, folder)
    edit, parts, _ = BAD[what]
    edit(folder)
    monkeypatch.chdir(tmp_path)
    program = {"table": "indicators"}.get(command, command)
    assert run(monkeypatch, program, str(folder), *COMMANDS[command]) == 2
    error = capsys.readouterr().err
    assert error.startswith("siggen-diagnostics: ")
    for part in ("bad_set", *parts):
        assert part in error
    assert "Traceback" not in error
    assert not list(tmp_path.glob("out*")), "a refused command leaves nothing behind"


@pytest.mark.parametrize(
    ("wanted", "parts"),
    [
        (lambda row: row["state"] == "slight", ("healthy records of 0", "`healthy: {}`")),
        (lambda row: row["state"] != "healthy", ("healthy records of 0", "`healthy: {}`")),
        (lambda row: row["state"] == "healthy", ("damaged records of 0", "Add a state with `damage`")),
        (lambda row: row["specimen_id"] == 0, ("of 1 gearbox and", "`--set specimens=N`")),
    ],
    ids=["single state", "no healthy", "no damaged", "one gearbox"],
)
def test_the_report_of_a_set_that_judges_nothing_says_what_it_lacks_and_ends_with_4(
    wanted: Callable[[dict[str, object]], bool],
    parts: tuple[str, ...],
    good_set: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    folder = tmp_path / "bad_set"
    shutil.copytree(good_set, folder)
    some_rows(wanted)(folder)
    assert run(monkeypatch, "report", str(folder), "--no-cnn", "--out", str(tmp_path / "out")) == 4
    metrics = json.loads((tmp_path / "out" / "metrics.json").read_text(encoding="utf-8"))
    assert metrics["headline"].startswith("No answer: ")
    for part in parts:
        assert part in metrics["headline"].replace("\xa0", " ")
    areas = [area for entry in metrics["separability"]["features"] for area in entry["auc"].values()]
    assert all(area["value"] is None for area in areas), "a comparison within one gearbox, or with nothing, is no score"


def test_a_single_clipped_record_is_noted_and_used(
    good_set: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    folder, out = tmp_path / "set", tmp_path / "features.parquet"
    shutil.copytree(good_set, folder)
    samples(clipped_once)(folder)
    assert run(monkeypatch, "indicators", str(folder), "--out", str(out)) == 0
    assert "note: channel bearing_vertical is clipped" in capsys.readouterr().err
    assert [note for note in table_notes(pq.read_table(out)) if "1 record (3)" in note]


def test_a_good_set_passes_without_a_note(
    good_set: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(monkeypatch, "indicators", str(good_set), "--out", str(tmp_path / "features.parquet")) == 0
    assert capsys.readouterr().err == ""
