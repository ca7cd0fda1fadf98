"""What a planetary set presses its housing with, as its channels hear it: forces on held seats, set free (derived).

Seats that modes beyond those of the machine let give way by R lie in series with the springs, K = (1/k + R)^-1. A force
F_0 on one of them stretches that chain by R F_0, which passes K R F_0 back to the body.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.dynamics.structure.drivetrain import Modes
from siggen.dynamics.structure.makers import SEATS_OF_SET, Housing, supports_of_set
from siggen.dynamics.structure.structure import Structure
from siggen.gearbox.specimen import Specimen
from siggen.specimen.background import mean_meshes
from siggen.specimen.forced_ways import ChannelWay, Forcing, forced_ways
from siggen.specimen.structure import linear_structure, linear_train, specimen_body


def forces_through_housing(
    specimen: Specimen, channels: Mapping[str, ChannelWay], frequency_hz: FloatArray
) -> dict[str, ComplexArray]:
    """Return channel -> response (`SEATS_OF_SET`, k) at frequencies (k,) to what a set presses held seats with.

    Raises
    ------
    ValueError
        If a channel shows what the machine does not have.
    """
    housing, assembled = specimen_body(specimen), linear_structure(linear_train(specimen))
    assert housing is not None
    assert specimen.planets is not None
    supports = supports_of_set(specimen.planets.stage, None)
    forcing = _on_seats(assembled, housing, np.concatenate([np.diag(one.stiffness) for one in supports]))
    return forced_ways((assembled, mean_meshes(specimen, assembled)), forcing, channels, frequency_hz)


def _on_seats(assembled: Structure, housing: Housing, stiffness: FloatArray) -> Forcing:
    """Return unit forces on the seats of a housing whose springs have a stiffness (seats,)."""
    split = [name.split("/") for name in SEATS_OF_SET]
    seats = np.array([assembled.drivetrain.row(housing.seats[place], along) for place, along in split])
    flexibility = np.zeros((len(seats), len(seats)))
    if isinstance(housing.body, Modes):
        order = [housing.body.seats.index(name) for name in SEATS_OF_SET]
        flexibility = housing.body.give_m_per_n[np.ix_(order, order)]
    pulled = np.array([assembled.bearing_forces[name][0] for name in SEATS_OF_SET])
    back = np.linalg.solve(np.diag(1.0 / stiffness) + flexibility, flexibility)
    rows, shares = seats + flexibility @ pulled, np.eye(len(seats)) - back
    pressed = [dict(zip(SEATS_OF_SET, own, strict=True)) for own in shares.T.tolist()]
    return Forcing(dict(zip(SEATS_OF_SET, rows, strict=True)), dict(zip(SEATS_OF_SET, pressed, strict=True)))
