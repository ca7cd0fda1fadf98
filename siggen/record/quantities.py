"""What no sensor sees, by name: clean accelerations, bearing forces, mesh force and stiffness, tooth pairs, motions."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.drivetrain.drive import Rotation
from siggen.gearbox.specimen import Specimen
from siggen.keys.column import Column
from siggen.mesh.contact_names import PAIR_PREFIX, is_of_contact_alone
from siggen.motion.response import Piece, Response, ResponsePieces, ResponseStream
from siggen.names import Names
from siggen.record.quantity_names import acceleration_name, angle_name, bearing_force_name

UNITS = {
    "_n_s_per_m": "N s/m", "_n_per_m": "N/m", "_nm": "N m", "_n": "N", "_m_s2": "m/s^2", "_m_s": "m/s", "_m": "m",
    "_rad": "rad", "_pa": "Pa",
}  # fmt: skip
"""Unit by the ending of a name, longer endings first."""

MEANINGS = {
    "mesh_force_n": "of all pairs along the line of action, positive on the drive flank",
    "mesh_stiffness_n_per_m": "sum of the stiffnesses of the pairs in contact",
    "mesh_damping_n_s_per_m": "damping of the pairs in contact",
    "approach_m": "R_b1 theta_1 - R_b2 theta_2 and the gears' shifts along the line of action; 0 in the "
    "middle of the backlash (law linear) or where perfect drive flanks touch (pairs)",
    "approach_rate_m_s": "rate of the approach",
    "transmission_error_m": "dynamic transmission error: approach_m (law pairs), or what exceeds the backlash (linear)",
    "friction_force_n": "friction of all pairs across the line of action",
    "friction_moment_{0.body}_nm": "moment of the friction about the axis of {0.called}",
    "friction_moment_{1.body}_nm": "moment of the friction about the axis of {1.called}",
    "mesh_tilt_rad": "tilt of the flanks of {0.called} against the other's in the plane of action, static "
    "tilt included",
    "mesh_moment_nm": "moment of all pairs across the face, positive with the load at the far end",
    "{0.body}_angle_rad": "angle of {0.called} within its revolution, from 0 to 2 pi",
}
"""Of a mesh, whose driver is 0 and whose driven gear is 1."""
OF_A_PAIR = {
    "force_n": "force of this pair along the line of action",
    "load_share": "force of this pair over that of all",
    "friction_n": "friction of this pair",
    "sliding_m_s": "sliding speed at the contact",
    "position_m": "place of the contact on the path of contact, from its start",
    "friction_moment_": "moment of the pair's friction about the axis of this gear",
    "friction_coefficient": "friction coefficient",
    "damping_n_s_per_m": "damping of the pair",
    "hertz_pressure_pa": "largest pressure in the contact",
    "central_film_m": "central film thickness",
    "film_ratio": "film thickness over the roughness of both flanks",
    "asperity_share": "share of the load that asperities carry",
}
"""By what stands behind the number of the pair, or its beginning."""
OF_MOTION = {
    "clean_accel_": "acceleration at this place without path, sensor and noise",
    "bearing_force_": "force on the housing at both bearings of this shaft",
    "support_moment_": "moment that keeps the ring from turning",
    "theta_": "rotation of this body about the mean rotation",
    "phi_casing": "rocking of the casing",
    "phi_": "tilt of this gear: how x or y of its flanks grows along the shaft",
    "x_": "horizontal motion of this body",
    "y_": "vertical motion of this body",
}
"""By the beginning of the name."""
OF_ITS_PAIR = re.compile(rf"(?:.*_)?{PAIR_PREFIX}\d+_(.*)")
TRANSMISSION_ERROR = "transmission_error_m"
APPROACH = "approach_m"
"""A planetary set, whose meshes share one load, has no transmission error."""


def internal_quantities(specimen: Specimen, response: Response) -> dict[str, FloatArray]:
    """Return name -> (n,) at the samples of a response that holds its internals."""
    inner, approach = response.internals, approach_name(specimen)
    return {
        angle_name(specimen.names): np.mod(response.angle_rad, 2.0 * np.pi),
        **{acceleration_name(place): a for place, a in response.acceleration_m_s2.items()},
        **{bearing_force_name(place): f for place, f in response.bearing_force_n.items()},
        **inner,
        **({TRANSMISSION_ERROR: transmission_error_m(inner[approach], specimen)} if approach in inner else {}),
    }


def approach_name(specimen: Specimen) -> str:
    """Return the name of the approach that the transmission error follows from, that of the first mesh."""
    return specimen.names.quantity(specimen.names.first, APPROACH) if specimen.planets is None else ""


def pinion_angle_rad(drive: Rotation, fs_hz: float, first: int, count: int) -> FloatArray:
    """Return the angle of the pinion within its revolution at `count` samples from sample `first` on."""
    return np.asarray(np.mod(drive.angle_rad(np.arange(first, first + count) / fs_hz), 2.0 * np.pi))


def quantity_column(name: str, names: Names) -> Column:
    """Return name, unit and meaning of a quantity as a column."""
    import pyarrow as pa

    unit = next((unit for ending, unit in UNITS.items() if name.endswith(ending)), "")
    meaning = _meanings(names).get(name) or _of_kind(name)
    if is_of_contact_alone(name):
        meaning += "; NaN while the pair does not touch on its drive flank"
    return Column(name, pa.float32(), unit, meaning)


def _of_kind(name: str) -> str:
    """Return the meaning of a quantity of a pair or of a place; its name where nothing more is known of it."""
    of_pair = OF_ITS_PAIR.fullmatch(name)
    quantity, known = (of_pair[1], OF_A_PAIR) if of_pair else (name, OF_MOTION)
    return next((meaning for beginning, meaning in known.items() if quantity.startswith(beginning)), name)


def _meanings(names: Names) -> dict[str, str]:
    """Return name -> meaning of the quantities of all meshes."""
    return {
        names.quantity(mesh, name.format(*mesh.gears)): meaning.format(*mesh.gears)
        for mesh in names.meshes
        for name, meaning in MEANINGS.items()
    } | {angle_name(names): MEANINGS["{0.body}_angle_rad"].format(*names.first.gears)}


def transmission_error_m(approach_m: FloatArray, specimen: Specimen) -> FloatArray:
    """Return the dynamic transmission error on the line of action: the approach beyond the backlash that it closed.

    x_m = R_b1 θ_1 - R_b2 θ_2 + y_1 - y_2, with what bearings give way along the line of action (reference: standard
    literature). The linear mesh law counts the approach from the middle of the backlash, tooth pairs from the touching
    drive flank: there both are one quantity.
    """
    if specimen.law.across_the_face:
        return approach_m
    half_backlash_m = 0.5 * specimen.law.backlash_m
    return np.asarray(approach_m - np.sign(approach_m) * np.minimum(np.abs(approach_m), half_backlash_m))


# StreamedInternals: what no sensor sees of a record, kept as float32 while its pieces pass by.


class StreamedInternals:
    """`pieces` of a `stream` that holds its internals; the stream's states are forgotten block after block.

    What is kept is what the configuration asks for, 0.1 MB per second and quantity at 25.6 kHz.
    """

    def __init__(self, specimen: Specimen, stream: ResponseStream, pieces: ResponsePieces) -> None:
        self.motions, self.places, self.before = pieces.motions, pieces.places, pieces.before
        self.readings = pieces.readings
        self._specimen, self._stream, self._pieces = specimen, stream, pieces
        self._accelerations = tuple(acceleration_name(motion) for motion in self.motions)
        self._forces = tuple(bearing_force_name(place) for place in self.places)
        self._inner = stream.run.motion.internal_names
        self._angle, self._approach = angle_name(specimen.names), approach_name(specimen)
        last = (TRANSMISSION_ERROR,) if self._approach in self._inner else ()
        names = (self._angle, *self._accelerations, *self._forces, *self._inner, *last)
        self._kept = {
            name: np.empty(stream.samples, dtype=np.float32) for name in dict.fromkeys(names) if specimen.stores(name)
        }

    @property
    def contact_loss_share(self) -> float:
        """Share of the record in which no teeth touched, once all pieces were taken."""
        return self._stream.contact_loss_share

    def pieces(self) -> Iterator[Piece]:
        """Yield all pieces in order."""
        heard, seen = -self.before, 0
        for piece in self._pieces.pieces():
            self._keep(heard, dict(zip(self._accelerations, piece.acceleration_m_s2, strict=True)))
            if self.places:
                self._keep(heard, dict(zip(self._forces, piece.bearing_force_n, strict=True)))
            heard += piece.acceleration_m_s2.shape[1]
            for block in self._stream.inner:
                self._keep_inner(seen, block)
                seen += len(block)
            self._stream.inner.clear()
            yield piece

    def quantities(self) -> dict[str, NDArray[np.float32]]:
        """Return name -> (n,), once all pieces were taken."""
        return self._kept

    def _keep_inner(self, first: int, block: FloatArray) -> None:
        """Keep the internals (k, names) at the samples from `first` on, and what follows from them."""
        named = dict(zip(self._inner, block.T, strict=True))
        angle = pinion_angle_rad(self._stream.run.drive, self._stream.run.fs_hz, first, len(block))
        self._keep(first, {self._angle: angle, **named})
        if self._approach in named:
            self._keep(first, {TRANSMISSION_ERROR: transmission_error_m(named[self._approach], self._specimen)})

    def _keep(self, first: int, named: Mapping[str, FloatArray]) -> None:
        """Keep what belongs to the record of values (k,) at the samples from `first` on."""
        for name, values in named.items():
            if name in self._kept:
                kept, behind = self._kept[name], values[max(-first, 0) :]
                start = max(first, 0)
                kept[start : start + behind.size] = behind[: max(kept.size - start, 0)]
