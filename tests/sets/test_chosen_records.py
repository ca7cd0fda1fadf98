"""Single records of a set, simulated alone: the ones that the whole set holds, by whichever processes."""

from __future__ import annotations

from pathlib import Path

import siggen

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
