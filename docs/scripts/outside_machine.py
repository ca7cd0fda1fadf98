"""A hidden machine that siggen did not simulate: only its masses, springs and gear geometry are of an exported model.

Written here and sharing no code with siggen: the law of the contact, errors of the teeth, damage, course of the speed,
housing and background. So what a detector learns from siggen meets the errors of another model.

* Contact: two or three pairs, each of SLICES springs across the face, stiffness a parabola over the path of contact.
* Errors: place, slope and three waves of every tooth, relief at both ends of the path, lead and crowning.
* Damage: the other flank rests on both edges, so it sinks by d²/(2 rho) at a distance d from the nearer one.
* Friction: constant coefficient.
* Housing: modes of random frequency, damping and shape, a rigid mass, a mounting.
* Background: noise at the bearings that a shaft and chance modulate, noise of sensors, lines of shafts and of others.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit

import siggen
from siggen.views.exported_model import exported_model

FS_HZ, TEETH, SUBSTEPS, SLICES, POINTS = 25_600.0, (18, 47), 4, 6, 256
DURATION_S, SETTLED_S = 1.0, 0.25
SPEEDS_HZ, TORQUES_NM = (33.0, 36.0), (25.0, 45.0)
SIZES = {"small": (0.6, 0.25), "partial": (1.0, 0.4)}
"""Length along the profile [mm] and share of the face."""
DEPTH_M, FRICTION, SLIP_M_S = 60e-6, 0.05, 0.02


@dataclass(frozen=True)
class Recording:
    """Channels [m/s²] of one record and the times at which turns of the pinion end."""

    channels: dict[str, np.ndarray]
    tacho_s: np.ndarray


def exported(rng: np.random.Generator) -> dict[str, Any]:
    """Return the model of a machine with bearings, masses and inertias of its own."""

    def log(low: float, high: float) -> float:
        return float(np.exp(rng.uniform(np.log(low), np.log(high))))

    def rotor(mass: float, inertia: float) -> dict[str, float]:
        kg, k = mass * log(0.6, 1.7), log(0.7e8, 5e8)
        damping = 2.0 * rng.uniform(0.02, 0.05) * np.sqrt(k * kg)
        axes = {f"bearing_stiffness_{axis}_n_per_m": k * rng.uniform(0.7, 1.4) for axis in "xy"}
        damped = {f"bearing_damping_{axis}_n_s_per_m": float(damping) for axis in "xy"}
        return {"mass_kg": kg, "inertia_kg_m2": inertia * log(0.6, 1.7), **axes, **damped}

    config = {
        "extends": "quickstart",
        "specimens": 1,
        "states": [{"name": "healthy"}],
        "operating_points": [{"speed_hz": 34.5, "torque_nm": 35.0}],
        "background": None,
        "manufacture": None,
        "variation": {},
        "sensors": [{"name": "bearing", "place": "pinion_bearing", "axes": ["vertical"]}],
        "dynamics": {
            "model": "8dof",
            "shafts": None,
            "friction": {"model": "constant", "coefficient": FRICTION},
            "pinion": rotor(1.0, 1.6e-4),
            "gear": rotor(3.0, 6.4e-3),
        },
    }
    return dict(exported_model(siggen.load_config(config), 0))


class Flanks:
    """Missing material [m] of every tooth over the path of contact, and across the face; stiffness of a slice [N/m]."""

    def __init__(self, model: dict[str, Any], rng: np.random.Generator) -> None:
        self.ratio = float(model["mesh.0.law.contact_ratio"])
        place = np.linspace(0.0, 1.0, POINTS)
        level_um = rng.uniform(0.3, 1.2)  # of the errors, about their rms
        self.teeth = [1e-6 * level_um * self._drawn(count, place, rng) for count in TEETH]
        length, tip_um = rng.uniform(0.2, 0.35), rng.uniform(3.0, 15.0)
        ends = np.maximum(np.maximum(length - place, place - 1.0 + length) / length, 0.0)
        self.teeth[0] += 1e-6 * tip_um * ends ** rng.uniform(1.3, 2.0)
        across = np.linspace(-1.0, 1.0, SLICES)
        lead = 1e-6 * (rng.uniform(-3.0, 3.0) * across + rng.uniform(0.0, 4.0) * across**2)
        self.lead = lead - lead.min()
        mean = float(model["mesh.0.reference_stiffness_n_per_m"]) / 1.55 * rng.uniform(0.85, 1.15)
        self.stiffness = mean / SLICES * (1.12 - rng.uniform(0.3, 0.45) * (2.0 * place - 1.0) ** 2)

    @staticmethod
    def _drawn(count: int, place: np.ndarray, rng: np.random.Generator) -> np.ndarray:
        """Return errors (teeth, POINTS) of about rms 1."""
        turn = 2.0 * np.pi * np.arange(count) / count
        pitch = rng.standard_normal(count) + 1.5 * np.cos(turn + rng.uniform(0.0, 2.0 * np.pi))
        slope = 0.4 * rng.standard_normal() + 0.3 * rng.standard_normal(count)
        found = pitch[:, None] + slope[:, None] * (place - 0.5)
        for waves in (1.0, 2.3, 4.1):
            own = 0.4 / waves * (rng.standard_normal() + 0.5 * rng.standard_normal(count))
            found = found + own[:, None] * np.cos(2.0 * np.pi * waves * place + rng.uniform(0.0, 2.0 * np.pi))
        return np.asarray(found)


def damage(model: dict[str, Any], size: str | None, centre_m: float) -> np.ndarray:
    """Return what is missing (SLICES, POINTS) [m] on the damaged tooth of the pinion; nothing without a size."""
    missing = np.zeros((SLICES, POINTS))
    if size is None:
        return missing
    length_mm, share = SIZES[size]
    law = {name: float(model[f"mesh.0.law.{name}"]) for name in ("start_m", "base_pitch_m", "line_of_action_m")}
    s = law["start_m"] + np.linspace(0.0, float(model["mesh.0.law.contact_ratio"]), POINTS) * law["base_pitch_m"]
    base_m = float(np.abs(model["mesh.0.vector"][3]))
    along = 0.5 * (s**2 - centre_m**2) / base_m  # of the profile, an involute, from the centre of the damage
    edge = np.maximum(0.5e-3 * length_mm - np.abs(along), 0.0)
    radius = s * (law["line_of_action_m"] - s) / law["line_of_action_m"]
    missing[: max(1, round(share * SLICES))] = np.minimum(edge**2 / (2.0 * radius), DEPTH_M)
    return missing


@njit  # type: ignore[untyped-decorator]
def _contact(approach, rate, pitches, teeth_1, teeth_2, lead, spall, stiffness, ratio, root, sliding, per_m):  # type: ignore[no-untyped-def]
    """Return normal force, friction, and its moment about the pitch point's place."""
    total, rubbing, moment = 0.0, 0.0, 0.0
    number = int(np.floor(pitches))
    while number > pitches - ratio:
        place = (pitches - number) / ratio * (POINTS - 1)
        cell = min(int(place), POINTS - 2)
        w = place - cell
        one, two = teeth_1[number % TEETH[0]], teeth_2[number % TEETH[1]]
        error = one[cell] + two[cell] + w * (one[cell + 1] + two[cell + 1] - one[cell] - two[cell])
        k = stiffness[cell] + w * (stiffness[cell + 1] - stiffness[cell])
        force, touching = 0.0, 0.0
        for i in range(SLICES):
            gap = error + lead[i]
            if number % TEETH[0] == 0:
                gap += spall[i, cell] + w * (spall[i, cell + 1] - spall[i, cell])
            if approach > gap:
                force += k * (approach - gap)
                touching += k
        force = max(force + root * np.sqrt(touching) * rate, 0.0) if touching > 0.0 else 0.0
        s = per_m[0] + (pitches - number) * per_m[1]
        rub = FRICTION * force * np.tanh((sliding[0] + s * sliding[1]) / SLIP_M_S)
        total += force
        rubbing += rub
        moment += s * rub
        number -= 1
    return total, rubbing, moment


@njit  # type: ignore[untyped-decorator]
def _integrated(start, angle, speed, moved, pushed, driven, rows, roll, seen, flanks, numbers):  # type: ignore[no-untyped-def]
    """Return bearing forces (samples, b): classical Runge-Kutta, SUBSTEPS a sample; speed is constant within one."""
    teeth_1, teeth_2, lead, spall, stiffness = flanks
    ratio, root, per_rad, begin, pitch = numbers
    n, step = pushed.shape[0], 1.0 / (FS_HZ * SUBSTEPS)
    z, found = start.copy(), np.empty((angle.size, seen.shape[0]))
    sliding, per_m = np.empty(2), np.array([begin, pitch])
    weights, parts = np.array([0.0, 0.5, 0.5, 1.0]), np.array([1.0, 2.0, 2.0, 1.0]) / 6.0
    for sample in range(angle.size):
        found[sample] = seen @ z
        for sub in range(SUBSTEPS):
            total, last = np.zeros(2 * n), np.zeros(2 * n)
            for stage in range(4):
                y = z + weights[stage] * step * last
                at = angle[sample] + speed[sample] * step * (sub + weights[stage])
                sliding[0] = rows[1] @ y[n:] + roll[0] * speed[sample]
                sliding[1] = rows[2] @ y[n:] + roll[1] * speed[sample]
                normal, rub, moment = _contact(
                    rows[0] @ y[:n], rows[0] @ y[n:], at * per_rad, teeth_1, teeth_2, lead, spall, stiffness,
                    ratio, root, sliding, per_m,
                )  # fmt: skip
                load = np.array([normal, rub, moment])
                last = np.concatenate((y[n:], moved @ y + driven[sample] - pushed @ load))
                total += parts[stage] * last
            z = z + step * total
    return found


class Machine:
    """One machine: model, flanks, housing and background, all from its number."""

    def __init__(self, number: int) -> None:
        rng = np.random.default_rng([2033, number])
        self.number, self.model = number, exported(rng)
        self.flanks = Flanks(self.model, rng)
        self.centre_m, self.damping = rng.uniform(6.5e-3, 9.2e-3), rng.uniform(0.03, 0.1)
        self.random_rms, self.once = np.exp(rng.uniform(np.log(1e-4), np.log(8e-4), 2))
        self.housing = Housing(rng, len(self.model["bearing_force_names"]))
        self.background = Background(rng)

    def recording(self, size: str | None, number: int) -> Recording:
        """Return a record with a damage, healthy without; one number, one record."""
        rng = np.random.default_rng([2034, self.number, number, [None, *SIZES].index(size)])
        angle = self._course(rng)
        forces = self._forces(size, angle, rng)
        kept = slice(round(SETTLED_S * FS_HZ), None)
        channels = self.housing.channels(forces, kept, lambda clean: self.background.added(clean, angle[kept], rng))
        turns = angle[kept] / (2.0 * np.pi)
        whole = np.arange(np.ceil(turns[0]), np.floor(turns[-1]) + 1.0)
        time_s = np.arange(turns.size) / FS_HZ
        return Recording(channels, np.interp(whole, turns, time_s))

    def _course(self, rng: np.random.Generator) -> np.ndarray:
        """Return the pinion's angle [rad]: a slow wander of the speed, and a wave once a turn."""
        count = round((DURATION_S + SETTLED_S) * FS_HZ)
        speed_hz = float(rng.uniform(*SPEEDS_HZ))
        knots = rng.standard_normal(2 + round(5.0 * (DURATION_S + SETTLED_S)))
        wander = np.interp(np.linspace(0.0, knots.size - 1.0, count), np.arange(knots.size), knots)
        base = np.cumsum(speed_hz * (1.0 + self.random_rms * wander)) / FS_HZ + rng.uniform(0.0, TEETH[1])
        return np.asarray(2.0 * np.pi * base + self.once * np.sin(2.0 * np.pi * base))

    def _forces(self, size: str | None, angle: np.ndarray, rng: np.random.Generator) -> np.ndarray:
        """Return the bearing forces (samples, b) [N]."""
        model, torque_nm = self.model, float(rng.uniform(*TORQUES_NM))
        inverse, n = np.linalg.inv(model["mass"]), len(model["coordinates"])
        rows = np.stack([model["mesh.0.vector"], *model["mesh.0.sliding_vectors"]])
        once = 1.0 + rng.uniform(0.002, 0.01) * np.sin(angle + rng.uniform(0.0, 6.3))
        driven = (inverse @ model["torque_vector"])[None] * torque_nm * once[:, None]
        start = np.concatenate([model["static_deflection"] * torque_nm / float(model["torque_nm"]), np.zeros(n)])
        turning = np.isin(model["coordinates"], model["mesh.0.rotations"])
        root = 2.0 * self.damping * np.sqrt(float(model["mesh.0.equivalent_mass_kg"]))
        flanks, law = self.flanks, {k: float(model[f"mesh.0.law.{k}"]) for k in ("start_m", "base_pitch_m")}
        per_rad = float(model["mesh.0.pitches_per_rad"])
        return np.asarray(
            _integrated(
                start,
                angle,
                np.gradient(angle) * FS_HZ,
                -inverse @ np.hstack([model["stiffness"], model["damping"]]),
                inverse @ rows.T,
                driven,
                rows,
                rows[1:] @ np.where(turning, model["rolling"], 0.0),
                np.hstack([model["bearing_force_stiffness_rows"], model["bearing_force_damping_rows"]]),
                (*flanks.teeth, flanks.lead, damage(model, size, self.centre_m), flanks.stiffness),
                (flanks.ratio, root, per_rad, law["start_m"], law["base_pitch_m"]),
            )
        )


class Housing:
    """Modes between bearing forces and two sensors."""

    CHANNELS = ("sensor_1_vertical", "sensor_2_horizontal")
    MODES = 16

    def __init__(self, rng: np.random.Generator, forces: int) -> None:
        self.mass_kg = float(np.exp(rng.uniform(np.log(8.0), np.log(50.0))))
        self.hz = np.exp(rng.uniform(np.log(250.0), np.log(11_000.0), self.MODES))
        self.ratio = np.exp(rng.uniform(np.log(0.006), np.log(0.04), self.MODES))
        self.into, self.out = (
            0.35 * rng.standard_normal((self.MODES, forces)),
            0.35 * rng.standard_normal((2, self.MODES)),
        )
        self.share = rng.uniform(0.15, 0.6, self.MODES)
        self.mounting_hz = rng.uniform(7_000.0, 14_000.0, 2)

    def response(self, hz: np.ndarray) -> np.ndarray:
        """Return accelerances (channels, forces, k) [1/kg]."""
        s = 1j * hz
        modes = s**2 / (s**2 + 2.0 * self.ratio[:, None] * self.hz[:, None] * s + self.hz[:, None] ** 2)
        found = np.einsum("cm,mf,mk->cfk", self.out, self.into, modes / (self.share * self.mass_kg)[:, None])
        rigid = np.array([[1.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 1.0]])[:, : self.into.shape[1], None] / self.mass_kg
        mounted = 1.0 / (1.0 + 0.12 * s / self.mounting_hz[:, None] + (s / self.mounting_hz[:, None]) ** 2)
        return np.asarray((found + rigid * s**2 / (s**2 + 24.0 * s + 400.0)) * mounted[:, None])

    def channels(self, forces: np.ndarray, kept: slice, added: Any) -> dict[str, np.ndarray]:
        """Return the channels under forces (samples, b), with what `added` makes of the clean ones."""
        spectrum = np.fft.rfft(forces - forces.mean(axis=0), axis=0).T
        through = self.response(np.fft.rfftfreq(len(forces), 1.0 / FS_HZ))
        clean = np.fft.irfft(np.einsum("cfk,fk->ck", through, spectrum), len(forces))[:, kept]
        return dict(zip(self.CHANNELS, added((clean, self)), strict=True))


class Background:
    """Noise and lines; levels are of the machine, what chance does is of the record."""

    def __init__(self, rng: np.random.Generator) -> None:
        self.noise_share = np.exp(rng.uniform(np.log(0.2), np.log(0.8)))
        self.corner_hz, self.fall = rng.uniform(15.0, 120.0), rng.uniform(0.0, 0.6)
        self.depth, self.level_std = rng.uniform(0.05, 0.4, 2), rng.uniform(0.1, 0.8)
        self.sensor_share = np.exp(rng.uniform(np.log(0.005), np.log(0.05), 2))
        self.shaft_share = np.exp(rng.uniform(np.log(0.003), np.log(0.1), (2, 2, 4)))
        self.line_order, self.line_share = rng.uniform(3.0, 120.0, 8), np.exp(rng.uniform(-5.0, -2.5, (2, 8)))

    def added(self, clean_and_housing: tuple[np.ndarray, Housing], angle: np.ndarray, rng: np.random.Generator) -> Any:
        """Return both channels with noise and lines."""
        clean, housing = clean_and_housing
        hz = np.fft.rfftfreq(angle.size, 1.0 / FS_HZ)
        shape = np.sqrt(1.0 + (self.corner_hz / np.maximum(hz, 2.0)) ** 2) * (1.0 + hz / 1000.0) ** -self.fall
        white = rng.standard_normal((housing.into.shape[1], angle.size)) * np.sqrt(self._strength(angle, rng))
        through = housing.response(hz) * shape
        noise = np.fft.irfft(np.einsum("cfk,fk->ck", through, np.fft.rfft(white, axis=1)), angle.size)
        level = clean.std(axis=1, keepdims=True)
        noise *= self.noise_share * level / noise.std(axis=1, keepdims=True) * 10.0 ** (rng.uniform(-1.0, 1.0) / 20.0)
        own = self.sensor_share[:, None] * level * rng.standard_normal(clean.shape)
        return clean + noise + own + level * self._lines(angle, rng)

    def _strength(self, angle: np.ndarray, rng: np.random.Generator) -> np.ndarray:
        turns = sum(d * np.cos(a + 1.0) for d, a in zip(self.depth, (angle, angle * TEETH[0] / TEETH[1]), strict=True))
        smooth = np.convolve(rng.standard_normal(angle.size + 160), np.hanning(160), "same")[80:-80]
        return np.asarray(np.maximum(1.0 + turns, 0.0) * np.exp(self.level_std * smooth / smooth.std()))

    def _lines(self, angle: np.ndarray, rng: np.random.Generator) -> np.ndarray:
        found = np.zeros((2, angle.size))
        for shaft, step in enumerate((1.0, TEETH[0] / TEETH[1])):
            for k in range(4):
                found += self.shaft_share[shaft, :, k, None] * np.cos((k + 1) * step * angle + k + shaft)
        for order, share in zip(self.line_order, self.line_share.T, strict=True):
            found += share[:, None] * np.cos(order * angle + rng.uniform(0.0, 2.0 * np.pi))
        return found
