"""Which loss of mesh stiffness the report shows."""

from __future__ import annotations

from types import SimpleNamespace

import pyarrow as pa
import pytest

from diagnostics.report.drawing import loss_of_specimens

TABLE = pa.table(
    {
        "state": ["healthy", "severe", "severe", "healthy", "severe"],
        "specimen_id": [0, 0, 0, 1, 1],
        "mesh_stiffness_loss": [0.0, 1.0, 1.0, 0.0, 1.0],
        "mesh_stiffness_loss_as_simulated": [0.0, 0.6, 0.8, 0.0, 0.7],
    }
)


def dataset(table: pa.Table) -> SimpleNamespace:
    return SimpleNamespace(labels=lambda columns=None: table if columns is None else table.select(columns))


def test_the_loss_as_simulated_goes_first_and_the_largest_of_a_specimen_counts() -> None:
    losses, meaning = loss_of_specimens(dataset(TABLE))
    assert losses["healthy"].tolist() == [0.0, 0.0]
    assert losses["severe"].tolist() == pytest.approx([0.8, 0.7])  # specimen 0 at its lighter torque
    assert "as simulated" in meaning


def test_an_earlier_set_shows_what_it_has_and_says_what_that_is() -> None:
    losses, meaning = loss_of_specimens(dataset(TABLE.drop_columns(["mesh_stiffness_loss_as_simulated"])))
    assert losses["severe"].tolist() == [1.0, 1.0]
    assert "by potential energy" in meaning
