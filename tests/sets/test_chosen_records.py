"""Single records of a set, simulated alone: the ones that the whole set holds, by whichever processes."""

from __future__ import annotations

from pathlib import Path

import pytest

import siggen
from siggen.errors import UsageError
from siggen.gearbox.plan import record_ids_of

SHORT = ["specimens=2", "splits={train: 20, validation: 0, test: 0}", "duration_s=0.2"]


def test_chosen_records_are_those_of_the_set_whatever_process_made_them(tmp_path: Path) -> None:
    design = siggen.load_config("quickstart", SHORT)
    siggen.generate(design, tmp_path / "set", executor="serial")
    whole = siggen.open(tmp_path / "set")
    here, elsewhere = (siggen.simulate_records(design, [6, 1], workers) for workers in (0, 1))
    assert here.rows.equals(elsewhere.rows, check_metadata=True)
    for row, number in enumerate((6, 1)):
        signal = here.rows["accel_lid_vertical_m_s2"][row].values.to_numpy()
        assert (signal == whole.record(number)["accel_lid_vertical_m_s2"]).all()


@pytest.mark.parametrize(("number", "came"), [(-1, "-1"), (10, "10"), (1.5, "1.5"), ("0", "the text '0'")])
def test_a_record_that_the_set_does_not_hold_is_refused_with_those_that_it_holds(number: object, came: str) -> None:
    design = siggen.load_config("quickstart", SHORT)
    with pytest.raises(UsageError, match=f"record_ids: received {came}; allowed: a whole number from 0 to 9$"):
        siggen.simulate_records(design, [0, number], workers=0)  # type: ignore[list-item]


def test_a_record_after_the_end_of_its_gearbox_is_refused_with_those_before() -> None:
    design = siggen.load_config("fleet", ["specimens=4"])
    last, free = next(
        (ids[-1], ids[-1] + 1)
        for ids in (record_ids_of(design, one) for one in range(4))
        if (ids[-1] + 1) % design.records_per_specimen
    )
    with pytest.raises(UsageError, match=f"received {free}, but this gearbox fails.* to {last}, or those of another"):
        siggen.simulate_records(design, [free], workers=0)
