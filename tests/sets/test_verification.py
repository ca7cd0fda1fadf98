"""Verification: one flipped byte in any file shows, and so does a record that is not what the simulation gives."""

from __future__ import annotations

import shlex
import shutil
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from typer.testing import CliRunner

import siggen.sets.verification
from siggen.cli.app import app
from siggen.columns.record import RecordFailure, SimulatedRecord
from siggen.dataset.environment import environment
from siggen.errors import EXIT_MISMATCH, DatasetError
from siggen.gearbox.design import SetDesign
from siggen.sets.verification import CLOSE, EXACT, verify
from tests.dataset.fake_set import (
    FAKE_FILES,
    STEP_M_S2,
    fake_physics,
    file_bytes,
    simulate,
    verify_fake_set,
    write_fake_set,
)
from tests.dataset.resealed_set import reseal


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("sets") / "reference"
    write_fake_set(path)
    return path


@pytest.fixture
def folder(reference: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(reference, tmp_path / "set"))


def flip(path: Path, place: int, bit: int) -> None:
    content = bytearray(path.read_bytes())
    content[place] ^= 1 << bit
    path.write_bytes(content)


def test_an_untouched_set_is_as_promised(reference: Path) -> None:
    found = verify_fake_set(reference, 30)
    assert found.mismatches == ()
    assert found.files == len(FAKE_FILES)
    assert found.records == tuple(range(30))
    assert found.comparison == EXACT


@pytest.mark.parametrize("name", FAKE_FILES)
def test_a_flipped_bit_anywhere_in_any_file_is_found(folder: Path, name: str) -> None:
    size = (folder / name).stat().st_size
    rng = np.random.default_rng(FAKE_FILES.index(name))
    for place in {0, size // 2, size - 1, *rng.integers(0, size, 5).tolist()}:
        bit = int(rng.integers(8))
        flip(folder / name, place, bit)
        found = verify(folder)
        assert [mismatch.what for mismatch in found.mismatches] == [name], f"byte {place}, bit {bit}"
        flip(folder / name, place, bit)
    assert verify(folder).mismatches == ()


@pytest.mark.parametrize("damage", ["flipped", "cut", "missing"])
@pytest.mark.parametrize("name", [*FAKE_FILES, "data/train-00009.parquet"])
def test_the_printed_commands_repair_a_set(folder: Path, reference: Path, name: str, damage: str) -> None:
    path = folder / name
    if not path.exists():
        path.write_bytes(b"a stranger")
    elif damage == "flipped":
        flip(path, path.stat().st_size // 2, 0)
    elif damage == "cut" or name == "manifest.json":  # without a manifest it is no finished set
        path.write_bytes(path.read_bytes()[:-1])
    else:
        path.unlink()
    said = CliRunner().invoke(app, ["verify", str(folder)])
    assert said.exit_code == EXIT_MISMATCH
    assert name in said.stderr
    source = folder.parent / "source.yaml"
    source.write_bytes((reference / "config.yaml").read_bytes())
    for line in said.stderr.splitlines():
        words = shlex.split(line.removeprefix("to repair it: ").replace("CONFIG ", f"{source} "))
        if words[0] == "rm":
            for removed in words[1:]:
                Path(removed).unlink()
        elif words[:2] == ["siggen", "generate"]:
            with fake_physics():
                made = CliRunner().invoke(app, [*words[1:], "--workers", "0"])
            assert made.exit_code == 0, made.stderr
    assert CliRunner().invoke(app, ["verify", str(folder), "--sample", "0"]).exit_code == 0
    assert file_bytes(folder) == file_bytes(reference)


@pytest.mark.parametrize("name", ["data/train-00003.parquet", "internals/notes.txt", "life/old/units.parquet"])
def test_a_foreign_file_among_the_rows_is_found(folder: Path, name: str) -> None:
    (folder / name).parent.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(b"x")
    assert [(m.what, m.problem) for m in verify(folder).mismatches] == [(name, "not part of the set")]


def test_files_beside_the_set_are_fine(folder: Path) -> None:
    (folder / ".gitattributes").write_text("*.parquet filter=lfs")
    assert verify(folder).mismatches == ()


def test_a_folder_that_is_no_finished_set_is_no_mismatch_but_an_error(tmp_path: Path) -> None:
    with pytest.raises(DatasetError, match="no such folder"):
        verify(tmp_path / "nothing")


def shifted(config: SetDesign, ids: Sequence[int], by_m_s2: float) -> list[SimulatedRecord | RecordFailure]:
    results = []
    for record in simulate(config, ids):
        assert isinstance(record, SimulatedRecord)
        signal = record.channels["bearing_horizontal"].copy()
        signal[100] += np.float32(by_m_s2)
        results.append(replace(record, channels={**record.channels, "bearing_horizontal": signal}))
    return results


def elsewhere(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(siggen.sets.verification, "environment", lambda: {**environment(), "fingerprint": "another"})


def test_here_a_single_sample_that_differs_by_one_step_is_a_mismatch(reference: Path) -> None:
    found = verify_fake_set(reference, 3, simulation=lambda config, ids: shifted(config, ids, STEP_M_S2))
    assert len(found.mismatches) == 3
    assert "accel_bearing_horizontal_m_s2 differs by up to 0.0156 (allowed 0)" in found.mismatches[0].problem
    assert found.comparison == EXACT


def test_elsewhere_one_step_of_the_converter_is_allowed_and_two_are_not(
    reference: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    elsewhere(monkeypatch)
    one = verify_fake_set(reference, 3, simulation=lambda config, ids: shifted(config, ids, STEP_M_S2))
    assert one.mismatches == ()
    assert one.comparison.startswith(CLOSE)
    two = verify_fake_set(reference, 3, simulation=lambda config, ids: shifted(config, ids, 2 * STEP_M_S2))
    assert len(two.mismatches) == 3


@pytest.mark.parametrize(
    ("label", "value", "allowed_elsewhere"),
    [
        ("mesh_hz", 540.0 * (1 + 1e-9), True),
        ("mesh_hz", 540.1, False),
        ("damage_count", 77, False),
        ("fault", "x", False),
    ],
)
def test_labels_are_compared_too(
    reference: Path, monkeypatch: pytest.MonkeyPatch, label: str, value: object, allowed_elsewhere: bool
) -> None:
    def changed(config: SetDesign, ids: Sequence[int]) -> list[SimulatedRecord | RecordFailure]:
        return [replace(record, labels={**record.labels, label: value}) for record in simulate(config, ids)]

    assert len(verify_fake_set(reference, 2, simulation=changed).mismatches) == 2
    elsewhere(monkeypatch)
    assert (verify_fake_set(reference, 2, simulation=changed).mismatches == ()) == allowed_elsewhere


def test_a_record_that_now_fails_is_a_mismatch(reference: Path) -> None:
    def fails(config: SetDesign, ids: Sequence[int]) -> list[SimulatedRecord | RecordFailure]:
        return [RecordFailure(i, "diverged", "why not") for i in ids]

    found = verify_fake_set(reference, 1, simulation=fails)
    assert found.mismatches[0].problem == "now fails: diverged (why not)"


def test_workers_simulate_again_too_and_the_sample_is_repeatable(reference: Path) -> None:
    first = verify_fake_set(reference, 4, workers=1)
    assert first.mismatches == ()
    assert len(first.records) == 4
    assert verify_fake_set(reference, 4).records == first.records


def test_records_are_not_simulated_when_files_differ(folder: Path) -> None:
    flip(folder / "config.yaml", 10, 0)
    found = verify_fake_set(folder, 3)
    assert found.records == ()
    assert found.comparison == "none, since files differ"


def test_labels_that_a_stranger_sealed_beside_other_rows_are_found(folder: Path) -> None:
    table = pq.read_table(folder / "labels.parquet")
    place = table.schema.get_field_index("torque_nm")
    other = pa.array([61.0] * table.num_rows)
    pq.write_table(table.set_column(place, table.schema.field(place), other), folder / "labels.parquet")
    reseal(folder)
    found = verify(folder).mismatches
    assert len(found) == 5
    assert {one.problem for one in found} == {"says something else of its records than labels.parquet"}
