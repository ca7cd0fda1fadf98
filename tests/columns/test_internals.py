"""Internal quantities as a second table: the same guarantees as the signals, and nothing new in sets without them."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

import siggen.sets.verification
from siggen.config import parse
from siggen.dataset.reading import open as open_set
from siggen.errors import UsageError
from siggen.gearbox.plan import planned_record
from siggen.sets.verification import EXACT, verify
from tests.config.minimal import minimal
from tests.dataset.fake_set import (
    FAKE_FILES,
    QUANTITIES,
    copy_fake_set,
    fake_config,
    simulate,
    simulate_with_longer_contact,
    simulate_with_thicker_films,
    verify_fake_set,
    write_fake_set,
)

ALL = {"internals": {}}
FILES = sorted(FAKE_FILES + [name.replace("data/", "internals/") for name in FAKE_FILES if name.startswith("data/")])


def config(section: dict = ALL):
    return fake_config(**section)


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("sets") / "reference"
    write_fake_set(path, config())
    return path


@pytest.fixture
def folder(reference: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(reference, tmp_path / "set"))


def test_rows_join_the_records_and_hold_their_series(reference: Path) -> None:
    dataset = open_set(reference)
    assert [column.name for column in dataset.internal_columns] == [q.name for q in QUANTITIES]
    ids = [i for batch in dataset.internals("train") for i in batch["record_id"].to_pylist()]
    assert ids == dataset.labels("train")["record_id"].to_pylist()
    for record_id in range(30):
        found = dataset.record_internals(record_id)
        assert found["mesh_force_n"].dtype == np.float32
        expected = (np.linspace(0.0, 1.0, 512) + record_id).astype(np.float32)
        np.testing.assert_array_equal(found["mesh_force_n"], expected)
        # A gearbox without a second pair in reach holds there no force, and a film that is not defined.
        is_odd = planned_record(config(), record_id).specimen_id % 2
        np.testing.assert_array_equal(found["pair_1_force_n"], 0.0 * expected if is_odd else -expected)
        undefined = np.isnan(found["pair_1_film_ratio"])
        assert undefined.all() if is_odd else (undefined == (np.arange(512) >= 256)).all()


@pytest.mark.parametrize("elsewhere", [False, True])
@pytest.mark.parametrize(
    ("simulation", "problem"),
    [
        (simulate, None),
        (simulate_with_thicker_films, "pair_1_film_ratio differs by up to "),
        (simulate_with_longer_contact, "pair_1_film_ratio differs in where it is NaN"),
    ],
)
def test_undefined_films_hide_no_difference(reference, monkeypatch, elsewhere, simulation, problem) -> None:
    if elsewhere:  # then records need only be close
        monkeypatch.setattr(siggen.sets.verification, "environment", lambda: {"cpu": "another"})
    mismatches = verify_fake_set(reference, 30, simulation=simulation).mismatches
    assert len(mismatches) == (0 if problem is None else 18)  # those of specimens 0, 2 and 4
    assert all(problem in mismatch.problem for mismatch in mismatches)


def test_the_signals_are_those_of_the_set_without_internals(reference: Path, tmp_path: Path) -> None:
    copy_fake_set(tmp_path)
    for record_id in (0, 17, 29):
        with_internals, without = (open_set(p).record(record_id) for p in (reference, tmp_path))
        for name, value in without.items():
            np.testing.assert_array_equal(with_internals[name], value)


def test_verification_reads_every_byte_and_simulates_internals_again(reference: Path, folder: Path) -> None:
    found = verify_fake_set(reference, 30)
    assert (found.mismatches, found.comparison, found.files) == ((), EXACT, len(FILES))
    file = folder / "internals/test-00000.parquet"
    content = bytearray(file.read_bytes())
    content[200] ^= 4
    file.write_bytes(content)
    assert [m.what for m in verify(folder).mismatches] == ["internals/test-00000.parquet"]


def simulate_other_forces(config, record_ids):
    results = simulate(config, record_ids)
    for record in results:
        record.internals["mesh_force_n"][7] += 1e-3
    return results


def test_another_internal_quantity_is_a_mismatch_of_its_record(reference: Path) -> None:
    found = verify_fake_set(reference, 2, simulation=simulate_other_forces)
    assert len(found.mismatches) == 2
    assert "internal quantity mesh_force_n differs" in found.mismatches[0].problem


def simulate_nan(config, record_ids):
    results = simulate(config, record_ids)
    results[0].internals["mesh_force_n"][0] = np.nan
    return results


def test_a_quantity_that_is_not_a_number_fails_its_record(tmp_path: Path) -> None:
    generation = write_fake_set(tmp_path, config(), simulation=simulate_nan)
    assert {failure.status for failure in generation.failures} == {"not_finite"}
    assert "internal quantity mesh_force_n has 1 value not finite" in generation.failures[0].reason


def test_a_set_without_internals_says_how_to_get_them(tmp_path: Path) -> None:
    copy_fake_set(tmp_path)
    dataset = open_set(tmp_path)
    assert dataset.internal_columns == ()
    for ask in (lambda: next(dataset.internals()), lambda: dataset.record_internals(0)):
        with pytest.raises(UsageError, match="siggen show"):
            ask()
    assert "internals" not in dataset.manifest


def test_mistakes_are_answered_with_what_is_allowed() -> None:
    parsed = parse(minimal(internals={"quantities": "some", "records": "last"}))
    lines = [str(problem) for problem in parsed.problems]
    assert len(lines) == 2
    assert any("internals.quantities" in line and "[all], or a list" in line for line in lines)
