"""What reaches a channel that shows a force, and one that shows what the model does not give."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

import siggen
from siggen.checks.loading import load_config
from siggen.gearbox.mode_table import seats_of
from siggen.names import PAIR
from siggen.record.instrument import ChannelInstrument, channel_ways, settle_s
from siggen.sensing.inputs import FORCE, Input
from siggen.sensors.accelerometer import Accelerometer
from tests.config.minimal import minimal

INPUTS = seats_of(PAIR)


def test_a_force_that_also_comes_through_a_path_counts_twice() -> None:
    shown, bins = Input(FORCE, INPUTS[0]), 9
    channel = ChannelInstrument(
        load_config("tests/configs/ideal.yaml").gearbox(0).channels[0], seen={shown: 3.0},
        accelerance=np.full((len(INPUTS), bins), 2.0 + 0.0j), sensor_response=None,
        path_modes=0, path_rms_m_s2_per_n=0.0, forces=INPUTS,
    )  # fmt: skip
    found = channel_ways(channel, None, bins)
    assert {one: row[0] for one, row in found.items()} == {Input(FORCE, n): 2.0 for n in INPUTS} | {shown: 5.0}


def test_what_the_model_does_not_give_is_refused_by_the_name_of_the_sensor(monkeypatch: pytest.MonkeyPatch) -> None:
    def shows(*_: object) -> Mapping[Input, float]:
        return {Input("angle", "pinion"): 1.0}

    monkeypatch.setattr(Accelerometer, "shows", shows)
    config = siggen.load_config("tests/configs/ideal.yaml")
    with pytest.raises(ValueError, match=f"sensor {config.sensors[0].name}: shows angle pinion"):
        siggen.run(siggen.draw(config))


def test_nothing_settles_where_bearings_are_seats_and_no_path_was_measured() -> None:
    config = load_config(minimal(dynamics__model="8dof"))
    assert settle_s(config.gearbox(0)) == 0.0
