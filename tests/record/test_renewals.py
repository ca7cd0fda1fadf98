"""A record once more: its gearbox moves as it did, and what measures it is drawn anew."""

from __future__ import annotations

import numpy as np

from siggen.checks.loading import load_config
from siggen.columns.record import SimulatedRecord
from siggen.sets.drawn import simulated


def test_renewals_of_a_gearbox_in_its_background_keep_its_motion_and_place_of_sensors() -> None:
    design = load_config("quickstart", ["duration_s=0.1", "internals.quantities=[mesh_force_n]"])
    (alone,) = simulated(design, [0])
    made = list(simulated(design, [0], 2))
    assert all(isinstance(one, SimulatedRecord) for one in (alone, *made))
    assert [one.planned.renewal for one in made] == [0, 1, 2]
    assert made[0].labels == alone.labels
    for channel in alone.channels:
        assert np.array_equal(made[0].channels[channel], alone.channels[channel])
        signals = [one.channels[channel] for one in made]
        assert np.corrcoef(signals)[0, 1:].min() > 0.9
        assert not any(np.array_equal(signals[0], other) for other in signals[1:])
    for one in made[1:]:
        assert np.array_equal(one.tacho_s, alone.tacho_s)
        assert all(np.array_equal(values, one.internals[name]) for name, values in alone.internals.items())
        differing = {name for name, value in alone.labels.items() if one.labels[name] != value}
        assert all(name == "burst_count" or any(c in name for c in alone.channels) for name in differing)
        assert all(f"path_modes_{c}" not in differing for c in alone.channels)
    gearbox, frequency_hz = design.gearbox(0), np.linspace(100.0, 10_000.0, 50)
    for number in (1, 2):
        for own, other in zip(gearbox.channels, gearbox.renewed(number), strict=True):
            assert (own.name, own.shown.keys()) == (other.name, other.shown.keys())
            assert own.gain != other.gain
            assert not np.allclose(own.response(frequency_hz), other.response(frequency_hz), rtol=1e-3)
