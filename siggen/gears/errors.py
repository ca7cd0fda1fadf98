"""Errors of gears as they are made: how they run over teeth and flanks, and what teeth miss by them.

GearErrors: the manufacturing errors of one gear, of which a measuring machine would find just what is allowed.

Derived. A gear whose teeth sit eccentrically by e on its shaft moves them along the line of action by e cos(Θ + φ) with
the shaft's angle Θ: continuously, within a tooth too, and all pairs in mesh alike. A machine that measures about the
shaft's axis finds it as a runout of 2 e, a cumulative pitch of 2 e/cos α on the arc and a slope of the profiles. So the
eccentricity is the first harmonic of the pitch deviations: it is never added to them a second time. (A radial runout
F_r = 2 e moves the line of action by ± F_r/2, not by F_r sin α: the tangential part of a turning eccentricity counts.)

Scaled in turn: eccentricity to a share of the runout allowed, the other pitch deviations until single or cumulative
pitch reaches its limit, slopes and waves until they reach theirs, both together until the whole profile does.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import pi

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.face_shares import FaceShares
from siggen.gears.gear_pair import GearPair
from siggen.gears.missing_material import MissingMaterial, MissingTables
from siggen.gears.tolerances import FlankTolerances
from siggen.names import Side
from siggen.uniform_spline import UniformSpline

# ErrorShapes: how the errors of one gear run over its teeth and flanks, before they are scaled to a tolerance.
#
# Derived, in the form usual for simulated gears. Cumulative pitch: two harmonics over the teeth, of machines that
# index teeth one by one, and a random part; eccentricity goes on within a tooth and is kept apart. What both make
# together is held to the limits, so no harmonic of a real gear counts twice. Profile: a slope, since cutters and
# settings are wrong alike for all teeth, with a scatter of 10 % between them; a wave of a few cycles with a phase of
# its own on every tooth; noise down to L/30 of the length L of the flank, where the profile filter of the standard
# ends what is measured, and as smooth as that filter leaves it. Waves are freed of their straight line, as the
# standard does before it calls the rest form.

Draws = Callable[[str], np.random.Generator]
"""Generator that belongs to a name, so that a new name shifts no other draw."""

FLANK_POINTS = 241
"""Points from the root end to the tip of the active flank: 68 per cycle of the shortest usual wave."""
NOISE_POINTS = 61
"""Two per shortest wavelength that is measured, a thirtieth of the flank."""
NOISE_SHARE = 0.05
"""Standard deviation of the noise over the amplitude of the wave: 0.1 to 0.4 µm beside waves of 3 to 8 µm."""
HARMONICS = ((1, 1.0), (2, 0.5))
"""Orders of the indexing errors over a revolution, with the largest amplitude of each; the least is 30 % of it."""
RANDOM_PLACE = 0.15
"""Standard deviation of the random places beside them: single and cumulative pitch then come near their limits."""
TOOTH_SCATTER = 0.1
"""Relative standard deviation of slopes and waves between the teeth of a gear."""


@dataclass(frozen=True, slots=True)
class ErrorShapes:
    """Shapes without a scale, missing material positive.

    `phase_rad`: of the eccentricity; `pitch` (z,), of mean 0; `slope` (z,): change from root to tip; `form` (z,
    FLANK_POINTS): over the active flank, without mean and straight line.
    """

    phase_rad: float
    pitch: FloatArray
    slope: FloatArray
    form: FloatArray


def error_shapes(waves: FloatArray, draws: Draws) -> ErrorShapes:
    """Return the shapes of a gear.

    Parameters
    ----------
    waves : (z,)
        Cycles of the profile's wave on every tooth.
    draws : callable
        Gives a generator by name: eccentricity, pitch, slope, form.
    """
    teeth = waves.size
    return ErrorShapes(
        phase_rad=2.0 * np.pi * float(draws("eccentricity").random()),
        pitch=_pitch(teeth, draws("pitch")),
        slope=_slope(teeth, draws("slope")),
        form=_form(waves, draws("form")),
    )


def _pitch(teeth: int, rng: np.random.Generator) -> FloatArray:
    angle = 2.0 * np.pi * np.arange(teeth) / teeth
    shape = np.zeros(teeth)
    for order, weight in HARMONICS:
        shape += weight * rng.uniform(0.3, 1.0) * np.cos(order * angle + 2.0 * np.pi * rng.random())
    shape += RANDOM_PLACE * rng.standard_normal(teeth)
    return np.asarray(shape - shape.mean())


def _slope(teeth: int, rng: np.random.Generator) -> FloatArray:
    sign = 1.0 if rng.random() < 0.5 else -1.0
    return sign * (1.0 + TOOTH_SCATTER * rng.standard_normal(teeth))


def _form(waves: FloatArray, rng: np.random.Generator) -> FloatArray:
    place = np.linspace(0.0, 1.0, FLANK_POINTS)
    form, noise = np.empty((waves.size, FLANK_POINTS)), np.empty((NOISE_POINTS, waves.size))
    # Tooth by tooth, so that further teeth leave those before them as they are.
    for tooth, cycles in enumerate(waves):
        phase, amplitude = 2.0 * np.pi * rng.random(), 1.0 + TOOTH_SCATTER * rng.standard_normal()
        noise[:, tooth] = NOISE_SHARE * rng.standard_normal(NOISE_POINTS)
        form[tooth] = amplitude * np.sin(2.0 * np.pi * cycles * place + phase)
    return without_line(form + UniformSpline(0.0, 1.0 / (NOISE_POINTS - 1), noise)(place).T)


def without_line(profiles: FloatArray) -> FloatArray:
    """Return profiles (z, FLANK_POINTS) without mean and least-squares line."""
    level = profiles.mean(axis=1, keepdims=True)
    return np.asarray(profiles - level - slopes(profiles)[:, None] * _centred())


def slopes(profiles: FloatArray) -> FloatArray:
    """Return the change (z,) of the least-squares line of profiles (z, FLANK_POINTS) from root end to tip."""
    centred = _centred()
    return np.asarray(profiles @ centred / (centred @ centred))


def _centred() -> FloatArray:
    return np.linspace(-0.5, 0.5, FLANK_POINTS)


@dataclass(frozen=True, slots=True)
class GearErrors:
    """What the teeth of one gear miss against perfect ones, per tooth and along the flank.

    Only differences between places matter to the teeth; 0 is the mean tooth in the middle of its active flank, where a
    machine touches it to measure the pitch.

    `eccentricity_m`, `phase_rad`: e and its angle at tooth 0 of the shaft's position in which a pair of tooth 0 enters;
    `pitch_m` (z,): place of the teeth on the reference circle's arc without what the eccentricity adds, of mean 0;
    `slope_m` (z,): change of the profile from the root end to the tip of the active flank; `form_m` (z, FLANK_POINTS).
    """

    eccentricity_m: float
    phase_rad: float
    pitch_m: FloatArray
    slope_m: FloatArray
    form_m: FloatArray


@dataclass(frozen=True, slots=True)
class FlankDeviations:
    """What a measuring machine finds about the shaft's axis, with the names of `FlankTolerances`.

    Per tooth (z,) [m]: `cumulative_pitch_m` from the mean tooth, `pitch_m` from the tooth before, `profile_slope_m`,
    `profile_form_m`, `profile_m`; `runout_m`: 2 e.
    """

    cumulative_pitch_m: FloatArray
    pitch_m: FloatArray
    profile_slope_m: FloatArray
    profile_form_m: FloatArray
    profile_m: FloatArray
    runout_m: float

    @property
    def largest(self) -> dict[str, float]:
        """Return the deviations that tolerances of the same name limit [m]."""
        return {
            "pitch_m": float(np.abs(self.pitch_m).max()),
            "cumulative_pitch_m": float(np.ptp(self.cumulative_pitch_m)),
            "runout_m": self.runout_m,
            "profile_slope_m": float(np.abs(self.profile_slope_m).max()),
            "profile_form_m": float(self.profile_form_m.max()),
            "profile_m": float(self.profile_m.max()),
        }


def gear_errors(
    pair: GearPair, side: Side, shapes: ErrorShapes, limits: FlankTolerances, runout_share: float
) -> GearErrors:
    """Return errors of these shapes that stay within the limits, and reach those that bind.

    Parameters
    ----------
    pair : GearPair
    side : Side
    shapes : ErrorShapes
    limits : FlankTolerances, largest deviations allowed, as a share of a class's tolerances
    runout_share : float
        Runout over its limit; less where eccentricity alone would already pass another limit (few teeth).
    """
    teeth = pair.member(side).teeth
    eccentricity = _eccentricity(pair, side, shapes, limits, runout_share)
    alone = GearErrors(eccentricity, shapes.phase_rad, *_nothing(teeth))
    turned = deviations(pair, side, alone).cumulative_pitch_m
    pitch = shapes.pitch * min(
        _largest_factor(turned, shapes.pitch, lambda c: np.abs(_steps(c)).max(), limits.pitch_m),
        _largest_factor(turned, shapes.pitch, np.ptp, limits.cumulative_pitch_m),
    )
    slope, form = _profile(eccentric_profiles_m(pair, side, alone), shapes, limits)
    return GearErrors(eccentricity, shapes.phase_rad, pitch, slope, form)


def off_axis(errors: GearErrors, eccentricity_m: float, phase_rad: float) -> GearErrors:
    """Return the errors of the same gear with its axis off its shaft's: both eccentricities add as vectors (derived).

    Nothing else moves, whatever the tolerances; 0 changes no bit.
    """
    if eccentricity_m == 0.0:
        return errors
    total = errors.eccentricity_m * np.exp(1j * errors.phase_rad) + eccentricity_m * np.exp(1j * phase_rad)
    return replace(errors, eccentricity_m=float(abs(total)), phase_rad=float(np.angle(total)))


def deviations(pair: GearPair, side: Side, errors: GearErrors) -> FlankDeviations:
    """Return what a measuring machine finds of a gear."""
    cosine = float(np.cos(pair.member(side).pressure_angle_rad))
    middle = 0.5 * (pair.contact_start_m + pair.contact_end_m)
    cumulative = errors.pitch_m + eccentric_m(pair, side, errors, np.array([middle]))[:, 0] / cosine
    profiles = profiles_m(pair, side, errors)
    return FlankDeviations(
        cumulative_pitch_m=cumulative,
        pitch_m=_steps(cumulative),
        profile_slope_m=slopes(profiles),
        profile_form_m=np.ptp(without_line(profiles), axis=1),
        profile_m=np.ptp(profiles, axis=1),
        runout_m=2.0 * errors.eccentricity_m,
    )


def profiles_m(pair: GearPair, side: Side, errors: GearErrors) -> FloatArray:
    """Return what every tooth misses (z, FLANK_POINTS) from the root end to the tip, up to its place [m]."""
    return eccentric_profiles_m(pair, side, errors) + _lines(errors.slope_m) + errors.form_m


def eccentric_m(pair: GearPair, side: Side, errors: GearErrors, position_m: FloatArray) -> FloatArray:
    """Return what eccentricity takes from every tooth (z, k) at positions s (k,) of its pair [m]."""
    gear = pair.member(side)
    tooth = 2.0 * np.pi * np.arange(gear.teeth) / gear.teeth
    turned = (position_m - pair.contact_start_m) / gear.base_radius_m
    return np.asarray(errors.eccentricity_m * np.cos(tooth[:, None] + turned[None, :] + errors.phase_rad))


def eccentric_profiles_m(pair: GearPair, side: Side, errors: GearErrors) -> FloatArray:
    """Return the same (z, FLANK_POINTS) from the root end to the tip of the active flank."""
    ends = (pair.contact_start_m, pair.contact_end_m)
    first, last = ends if side == Side.DRIVER else ends[::-1]
    return eccentric_m(pair, side, errors, np.linspace(first, last, FLANK_POINTS))


def _eccentricity(
    pair: GearPair, side: Side, shapes: ErrorShapes, limits: FlankTolerances, runout_share: float
) -> float:
    """Return e: the wanted share of the runout, or what another limit leaves; everything measured is linear in e."""
    unit = GearErrors(1.0, shapes.phase_rad, *_nothing(pair.member(side).teeth))
    found = deviations(pair, side, unit).largest
    wanted = 0.5 * runout_share * limits.runout_m
    return float(min(wanted, *(getattr(limits, name) / found[name] for name in found)))


def _profile(turned: FloatArray, shapes: ErrorShapes, limits: FlankTolerances) -> tuple[FloatArray, FloatArray]:
    """Return slopes (z,) and forms (z, FLANK_POINTS) beside what eccentricity does to the profiles."""
    lines = _lines(shapes.slope)
    slope = _largest_factor(turned, lines, lambda p: np.abs(slopes(p)).max(), limits.profile_slope_m)
    form = _largest_factor(turned, shapes.form, lambda p: np.ptp(without_line(p), axis=1).max(), limits.profile_form_m)
    both = _largest_factor(
        turned, slope * lines + form * shapes.form, lambda p: np.ptp(p, axis=1).max(), limits.profile_m
    )
    both = min(both, 1.0)
    return both * slope * shapes.slope, both * form * shapes.form


def _largest_factor(
    fixed: FloatArray, varying: FloatArray, measure: Callable[[FloatArray], float], limit: float
) -> float:
    """Return the largest factor f from 0 with measure(fixed + f varying) <= limit; a norm, met by `fixed` alone."""
    size = float(measure(varying))
    if size == 0.0:
        return 0.0
    low, high = 0.0, (limit + float(measure(fixed))) / size
    # Convex in the factor, so the allowed ones are an interval; 60 halvings leave rounding alone.
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if float(measure(fixed + middle * varying)) <= limit else (low, middle)
    return low


def _steps(cumulative: FloatArray) -> FloatArray:
    return cumulative - np.roll(cumulative, 1)


def _lines(slope: FloatArray) -> FloatArray:
    return slope[:, None] * np.linspace(-0.5, 0.5, FLANK_POINTS)[None, :]


def _nothing(teeth: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    return np.zeros(teeth), np.zeros(teeth), np.zeros((teeth, FLANK_POINTS))


# Helix: how the flanks of one gear run across the face, alike on all its teeth: crowning, slope and form.
#
# Derived. Crowning is meant: a parabola that takes C_β at both ends of the face and nothing in the middle (ISO 21771).
# What is not meant is held to ISO 1328-1: the slope f_Hβ, the change of the mean line over the face; the form f_fβ,
# the range of what is left about that line; the total F_β, the range of both. The form is a low wave without its
# straight line, as the standard takes it away before it calls the rest form. All count along the line of action, as
# the standard measures them, and positive where material is missing.

HELIX_POINTS = 201
"""Over the face: 100 per cycle of a wave of two cycles."""


@dataclass(frozen=True, slots=True)
class Helix:
    """One gear across the face.

    `crowning_m`: C_β; `slope_m`: f_Hβ with its sign, positive where the far end misses material; `form_m`
    (HELIX_POINTS,): from the near to the far end, of mean 0 and without slope.
    """

    crowning_m: float
    slope_m: float
    form_m: FloatArray

    @property
    def straight(self) -> bool:
        """Whether nothing is missing anywhere."""
        return self.crowning_m == 0.0 and self.slope_m == 0.0 and not np.any(self.form_m)

    def missing_m(self, place: FloatArray) -> FloatArray:
        """Return what is missing at places (k,) across the face, 0 at the near and 1 at the far end [m]."""
        form = np.interp(place, np.linspace(0.0, 1.0, HELIX_POINTS), self.form_m)
        return np.asarray(self.crowning_m * (2.0 * place - 1.0) ** 2 + self.slope_m * (place - 0.5) + form)


def straight_helix(crowning_m: float = 0.0) -> Helix:
    """Return a helix without errors."""
    return Helix(crowning_m, 0.0, np.zeros(HELIX_POINTS))


def drawn_helix(crowning_m: float, slope: float, waves: float, phase_rad: float, limits: FlankTolerances) -> Helix:
    """Return a helix within limits; both errors shrink alike where their total would pass its own.

    Parameters
    ----------
    crowning_m : C_β [m]
    slope : f_Hβ over its limit, -1 to 1
    waves, phase_rad : cycles of the form over the face, and where they begin
    limits : FlankTolerances, as a share of a class's tolerances; the form uses all of its limit
    """
    place = np.linspace(-0.5, 0.5, HELIX_POINTS)
    shape = np.sin(2.0 * pi * waves * place + phase_rad)
    shape -= shape.mean()
    shape -= place * float(place @ shape / (place @ place))
    form, line = shape * limits.helix_form_m / float(np.ptp(shape)), slope * limits.helix_slope_m
    total = float(np.ptp(line * place + form))
    share = min(1.0, limits.helix_m / total) if total > 0.0 else 0.0
    return Helix(crowning_m, share * line, share * form)


# Missing material of gears with manufacturing errors: one row of the tables per tooth, a place for each of them.
#
# Derived. To what all teeth of a gear miss (relief, corners) come its own slope and form, counted from the middle of
# the active flank, and the way that eccentricity moves it while it is in mesh; the offset is where the tooth stands
# when it is touched in that middle: pitch deviations times cos α, since they are arcs, and eccentricity. Beyond root
# end and tip of a flank its last deviation holds; eccentricity goes on. Offsets shift the back flank too, as teeth
# that stand in a wrong place do; for the radial part of an eccentricity (its share sin α) this is an approximation.
#
# Slices of helical teeth meet slope and form each at its own place, and the pair sees their mean over the load
# (`face_shares`). Eccentricity and place are those of the whole gear. All counts along the transverse line of action,
# as the standard measures it.


def with_errors(
    missing: MissingMaterial,
    pair: GearPair,
    pinion: GearErrors,
    gear: GearErrors,
    shares: FaceShares | None = None,
) -> MissingMaterial:
    """Return the missing material of the same teeth with errors; `shares` of helical teeth alone.

    Errors of size zero change no bit of any force. Tables may have rows per kind already; then every tooth keeps that
    of its kind.
    """
    return replace(
        missing,
        pinion=_with_errors(missing, missing.pinion, pair, Side.DRIVER, pinion, shares),
        gear=_with_errors(missing, missing.gear, pair, Side.DRIVEN, gear, shares),
    )


def _with_errors(
    missing: MissingMaterial,
    teeth: MissingTables,
    pair: GearPair,
    side: Side,
    errors: GearErrors,
    shares: FaceShares | None,
) -> MissingTables:
    position = np.linspace(missing.start_m, missing.end_m, teeth.profile_m.shape[1])
    middle = np.array([0.5 * (pair.contact_start_m + pair.contact_end_m)])
    standing = eccentric_m(pair, side, errors, middle)
    if shares is None:
        profile = _profiles(pair, side, errors, position)
    else:
        profile = shares.mean(position, lambda place: _profiles(pair, side, errors, place))
    profile = profile - _profiles(pair, side, errors, middle)
    profile += eccentric_m(pair, side, errors, position) - standing
    cosine = float(np.cos(pair.member(side).pressure_angle_rad))
    return MissingTables(
        profile_m=teeth.profile_m[teeth.kind_of_tooth] + profile,
        kind_of_tooth=np.arange(len(profile), dtype=np.int32),
        offset_m=teeth.offset_m + cosine * errors.pitch_m + standing[:, 0],
    )


def _profiles(pair: GearPair, side: Side, errors: GearErrors, position_m: FloatArray) -> FloatArray:
    """Return slope and form of every tooth (z, k) at positions s (k,) [m]; the gear's flank runs against s."""
    place = (position_m - pair.contact_start_m) / (pair.contact_end_m - pair.contact_start_m)
    place = np.clip(place if side == Side.DRIVER else 1.0 - place, 0.0, 1.0)
    form = UniformSpline(0.0, 1.0 / (FLANK_POINTS - 1), errors.form_m.T)(place)
    return np.asarray(errors.slope_m[:, None] * place[None, :] + form.T)
