"""The page of a set: complete, self-contained, small, and safe against any name."""

from __future__ import annotations

import base64
import shutil
import subprocess
from collections.abc import Iterator
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pytest

from diagnostics.explore.payload import BYTES_PER_POINT, page_detail
from diagnostics.explore.set_page import LIMIT, LookOptions, predicted_labels, set_look, write_set_page
from diagnostics.explore.set_source import chosen_records, overlaid_records
from diagnostics.indicators.registry import columns, indicator_definitions, indicator_titles
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.indicators.table import RecordTable
from diagnostics.judging.of_split import Training
from diagnostics.prediction.released_model import load_model
from siggen.errors import UsageError
from tests.diagnostics.conftest import CHANNELS, MemoryDataset, memory_dataset
from tests.diagnostics.explore.unpacked import DATA, held, listed, rows, steps

BROWSER = next(
    (found for name in ("chromium", "chromium-browser", "google-chrome") if (found := shutil.which(name))), ""
)
NAMES = {
    "healthy": "</script><script>window.broken=1</script>",
    "slight": "<img src=x onerror=alert(1)>&amp;\"' \u202eright to left\u2066 ",
    "severe": "long " * 60 + "{{ 7*7 }}\u2028<!--",
}


class Read(HTMLParser):
    """Elements with what they reach for."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.reached: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.reached += [str(value) for name, value in attributes if name in ("src", "href", "action")]


def renamed(dataset: MemoryDataset, names: dict[str, str] | None = None) -> MemoryDataset:
    names = names or NAMES
    place = dataset.table.schema.get_field_index("state")
    states = [names[state] for state in dataset.table.column("state").to_pylist()]
    dataset.table = dataset.table.set_column(place, "state", pa.array(states))
    dataset.manifest = {**dataset.manifest, "name": names["healthy"]}
    return dataset


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("explore") / "new" / "page.html"
    return write_set_page(renamed(memory_dataset(("train", "test"))), path).read_text(encoding="utf-8")


def test_names_of_a_set_stay_text_wherever_they_stand(page: str) -> None:
    found = Read(page)
    assert found.tags.count("script") == 1 + 6 + 2  # the list, six records, two programs
    assert "img" not in found.tags
    assert {record["state"] for record in listed(held(page)["look-data"])} == set(NAMES.values())
    data = "".join(text for _, text in DATA.findall(page))
    assert not set("<>&\u2028\u202e") & set(data)


def test_the_page_reaches_for_nothing_outside_itself(page: str) -> None:
    assert Read(page).reached == []
    assert "default-src 'none'" in page
    assert "@import" not in page
    assert "Permission is hereby granted" in page  # the licence of the library goes along with every copy of it


def test_the_page_holds_every_record_with_all_its_views(page: str) -> None:
    found = held(page)
    data = found["look-data"]
    for row in range(6):
        detail = found[f"look-record-{row}"]
        assert set(detail["channels"]) == set(CHANNELS)
        for view in detail["channels"].values():
            assert {"wave", "spectrum", "envelope", "averages"} <= set(view)
    assert rows(data["overlay"]) == [None, 0, 0, None, 3, 3]
    titles = {indicator["title"] for indicator in data["indicators"]}
    assert {"FM4, pinion", "Sideband amplitude, gear, mesh harmonic 1, upper sideband 1", "RMS [m/s²]"} <= titles


def test_a_model_names_every_record_and_a_report_folder_holds_one(
    dataset: MemoryDataset, measured: RecordTable, training: Training, models_folder: Path, tmp_path: Path
) -> None:
    """Of the records of the test split, and of two gearboxes that the model was trained on."""
    split, specimen = (dataset.table.column(name).to_numpy(False) for name in ("split", "specimen_id"))
    dataset = replace(dataset, table=dataset.table.filter(pa.array((split == "test") | (specimen < 2))))
    shutil.copytree(models_folder, tmp_path / "report" / "models")
    model = load_model(tmp_path / "report")
    options = LookOptions(model=model)
    text = write_set_page(dataset, tmp_path / "page.html", options).read_text(encoding="utf-8")
    data = held(text)["look-data"]
    records = listed(data)
    said = {record["record_id"]: record["predicted"] for record in records if record["split"] == "test"}
    judged = next(found for found in training.judged if found.name == "indicators").predictions
    ids = dataset.labels("test").column("record_id").to_pylist()
    assert [said[record] for record in ids] == [judged.classes[k] for k in judged.predicted]
    assert {record["named"] for record in records} <= {"rightly", "wrongly"}
    assert all((record["named"] == "rightly") == (record["predicted"] == record["state"]) for record in records)
    assert ["predicted", "Predicted"] in data["filters"]
    assert all((record["seen"] == "seen in training") == (record["split"] != "test") for record in records)
    seen = sum(record["split"] != "test" for record in records)
    assert f"learnt from the gearboxes of {seen} of {len(records)}, marked" in data["seen"]
    table, another = measured, replace(dataset, manifest={"identity": "another set"})
    assert set(predicted_labels(table, another, model)["seen"]) == {"no"}
    other = SimpleNamespace(labels=dict, names=lambda: ("rms__elsewhere",), channels=("elsewhere",))
    with pytest.raises(UsageError, match="columns that the set does not have"):
        predicted_labels(other, dataset, model)  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of a set with plain names."""
    return write_set_page(memory_dataset(("train", "test")), tmp_path_factory.mktemp("plain") / "page.html")


@pytest.mark.skipif(not BROWSER, reason="needs a browser")
@pytest.mark.parametrize(
    ("asked", "shown", "opened"),
    [("state=severe&indicator=fm4_pinion", 2, 2), ("record=4", 6, 4), ("state=%3Cb%3E&record=99", 6, 0)],
)
def test_an_address_chooses_records(plain: Path, tmp_path: Path, asked: str, shown: int, opened: int) -> None:
    command = [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path / 'profile'}"]
    address = f"{plain.as_uri()}#{asked}"
    done = subprocess.run([*command, "--dump-dom", address], capture_output=True, text=True, timeout=120, check=True)
    assert f"{shown} of 6 records shown" in done.stdout
    assert done.stdout.count('class="uplot') >= 7  # histogram, scatter, and what the record shows
    assert f"Record {opened}: <bdi>" in done.stdout
    assert ("Record 99 is not on this page" in done.stdout) == ("99" in asked)
    assert (f"FM4, pinion ({CHANNELS[0]})</button>" in done.stdout) == ("fm4" in asked)


def test_a_set_without_healthy_records_says_so(tmp_path: Path) -> None:
    dataset = memory_dataset(("train",))
    dataset.table = dataset.table.filter(pc.not_equal(dataset.table.column("fault"), "healthy"))
    text = write_set_page(dataset, tmp_path / "page.html").read_text(encoding="utf-8")
    assert "No healthy records" in text
    assert "Neither transmission error nor mesh force" in text
    assert rows(held(text)["look-data"]["overlay"]) == [None, None]


def test_a_set_without_damaged_records_says_that_no_flank_is_drawn(tmp_path: Path) -> None:
    dataset = memory_dataset(("train",))
    dataset.table = dataset.table.filter(pc.equal(dataset.table.column("fault"), "healthy"))
    text = write_set_page(dataset, tmp_path / "page.html").read_text(encoding="utf-8")
    assert "no flank is drawn" in text


class WithInternals(MemoryDataset):
    """Stores the transmission error of records 0 and 2: a ramp of as many metres as the record's number."""

    @property
    def internal_columns(self) -> tuple[SimpleNamespace, ...]:
        return (SimpleNamespace(name="transmission_error_m", unit="m"),)

    def internals(self, columns: list[str], batch_rows: int) -> Iterator[pa.RecordBatch]:
        samples = round(self.fs_hz * self.duration_s)
        rows = [{"record_id": k, "transmission_error_m": np.linspace(0.0, k, samples)} for k in (0, 2)]
        yield pa.RecordBatch.from_pylist(rows).select(columns)


def test_stored_quantities_that_no_sensor_sees_stand_at_their_records(tmp_path: Path) -> None:
    plain = memory_dataset(("train",))
    text = write_set_page(WithInternals(plain.table), tmp_path / "page.html").read_text(encoding="utf-8")
    data = held(text)
    assert [quantity["name"] for quantity in data["look-data"]["quantities"]] == ["transmission_error_m"]
    internals = [data[f"look-record-{row}"]["internals"] for row in range(3)]
    assert [set(found) for found in internals] == [{"transmission_error_m"}, set(), {"transmission_error_m"}]
    assert steps(internals[2]["transmission_error_m"]).max() == pytest.approx(2.0e6)  # shown in um
    assert "Neither transmission error" not in text


@pytest.mark.parametrize("channels", [1, 2, 8])
@pytest.mark.parametrize(("full", "most"), [(False, 1.65e6), (True, 27.5e6)])
def test_signals_of_all_records_that_a_page_holds_fit(channels: int, full: bool, most: float) -> None:
    detail = page_detail(LIMIT * channels, 38_400, 81, full=full)
    assert LIMIT * channels * detail.points(81) * BYTES_PER_POINT < most
    assert detail.fine_samples > 200


def test_all_records_are_listed_and_the_signals_of_as_many_as_are_wanted_are_kept(tmp_path: Path) -> None:
    dataset = memory_dataset(("train", "test", "test"))
    found = held(write_set_page(dataset, tmp_path / "page.html", LookOptions(limit=4, first=[1])))
    assert [row["specimen_id"] for row in listed(found["look-data"])] == [0, 0, 0, 1, 1, 1, 2, 2, 2]
    assert set(found) == {"look-data", "look-record-3", "look-record-4", "look-record-5"}
    (rms,) = (one for one in found["look-data"]["indicators"] if one["name"] == f"rms__{CHANNELS[0]}")
    signals = [dataset.record(k)[f"accel_{CHANNELS[0]}_m_s2"].astype(np.float64) for k in range(9)]
    expected = [np.sqrt(np.mean(signal**2)) for signal in signals]
    np.testing.assert_allclose(np.frombuffer(base64.b64decode(rms["data"]), "<f4"), expected, rtol=1e-6)


def test_the_code_to_copy_gives_the_values_of_the_page(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    dataset = memory_dataset(("train", "test"))
    data = set_look(dataset, LookOptions()).live.data["look-data"]
    column = next(one for one in data["indicators"] if one["name"] == f"fm4_pinion__{CHANNELS[0]}")
    monkeypatch.setattr("siggen.open", lambda path: {str(dataset.path): dataset}[path])
    scope: dict[str, object] = {}
    exec(data["code"].replace("COLUMN", column["name"]), scope)
    shown = np.frombuffer(base64.b64decode(column["data"]), "<f4")
    np.testing.assert_array_equal(np.asarray(scope["values"], "<f4"), shown)
    healthy = np.array([record["fault"] == "healthy" for record in listed(data)])
    # one of twenty healthy records may be above it, of two none; the page holds single precision
    assert scope["limit"] == pytest.approx(shown[healthy].max(), rel=1e-6)
    assert capsys.readouterr().out.startswith("[")


def test_gearboxes_beyond_the_limit_are_left_out_whole_and_evenly() -> None:
    labels = {"specimen_id": np.repeat(np.arange(10), 5)}
    assert chosen_records(labels, 50).tolist() == list(range(50))
    assert np.unique(labels["specimen_id"][chosen_records(labels, 19)]).tolist() == [0, 4, 9]
    assert chosen_records(labels, 3).size == 3
    assert np.unique(labels["specimen_id"][chosen_records(labels, 19, [7, 3])]).tolist() == [0, 3, 7]
    assert np.unique(labels["specimen_id"][chosen_records(labels, 10, [7, 3, 4, 11])]).tolist() == [3, 7]


def test_a_record_is_laid_over_its_own_gearbox_at_its_own_operating_point() -> None:
    labels = {
        "specimen_id": np.array([1, 1, 1, 1, 2]),
        "operating_point_id": np.array([0, 1, 1, 1, 1]),
        "repeat": np.array([0, 0, 1, 1, 1]),
        "fault": np.array(["healthy", "healthy", "healthy", "pitting", "pitting"]),
    }
    assert overlaid_records(labels) == [None, 2, 1, 2, None]


def test_every_indicator_has_a_title_and_a_definition_of_its_own() -> None:
    settings = IndicatorSettings()
    titles, definitions = indicator_titles(settings), indicator_definitions(settings)
    assert set(columns(settings)) <= set(titles)
    assert set(titles) == set(definitions)
    assert len(set(titles.values())) == len(titles)
