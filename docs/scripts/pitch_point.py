"""Figure and tables of docs/understand/pitch_point.md: `python docs/scripts/pitch_point.py`.

Published beside ours: the regression of Xu, Kahraman, Anderson and Maddock 2007 to their elastohydrodynamic
computations, and Schlenk's mean coefficient of measured gears (ISO/TR 14179-2), both with the numbers that a doctoral
thesis prints. Neither original was read.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from math import exp, log10
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from siggen.checks.loading import load_config
from siggen.config import Config, read_yaml
from siggen.dynamics.friction.asperity_share import masjedi_khonsari_ratio
from siggen.dynamics.friction.contact_kinematics import (
    entrainment_speed,
    hertz_half_width,
    hertz_pressure,
    relative_radius,
    sliding_speed,
)
from siggen.dynamics.friction.film_traction import BOUNDARY_FRICTION, film_traction
from siggen.dynamics.friction.friction import FrictionLaw
from siggen.dynamics.friction.lubrication import LubricatedMesh, masjedi_khonsari_central
from siggen.dynamics.friction.reversal import TURN_OVER_SLIP_SPEED, presliding_m, slip_speed
from siggen.gears.geometry.gear_pair import GearPair
from siggen.planning.plan import planned_record
from siggen.planning.specimen import OperatingPoint, draw_specimen
from siggen.record.quantities import internal_quantities
from siggen.record.simulation import record_response
from siggen.record.specimen_state import specimen_state
from siggen.specimen import motion
from siggen.specimen.friction import composite_roughness_m, lubricated_mesh, pitch_point
from siggen.specimen.gears import gear_pair

CONFIG = Path(__file__).resolve().parents[2] / "configs" / "paper_b.yaml"
FIGURES = Path(__file__).resolve().parents[1] / "figures"
SPEEDS_HZ, TORQUE_NM = (5.0, 10.0, 20.0, 40.0), 40.0
FIXED_FILM, FIXED_SLIP_M_S = 0.02, 0.02
# Perfect gears on stiff shafts: nothing but mesh lines. The middles of the ranges of configs/paper_b.yaml.
CONSTANTS = [
    "specimens=1", "manufacture=null", "dynamics.shafts=null", "mesh_harmonics=5", "duration_s=2", "fs_hz=54000",
    "dynamics.mesh_damping_ratio=0.07", "dynamics.mesh.damping=constant", "dynamics.backlash_um=80",
    "dynamics.mesh.tip_relief_um=8", "dynamics.friction.oil_temperature_c=50", "dynamics.friction.roughness_um=0.4",
    "dynamics.friction.pit_roughness_um=2.0",
    *(f"dynamics.{gear}.bearing_stiffness_{axis}_n_per_m=2e8" for gear in ("pinion", "gear") for axis in "xy"),
    *(f"dynamics.pinion.bearing_damping_{axis}_n_s_per_m=850" for axis in "xy"),
    *(f"dynamics.gear.bearing_damping_{axis}_n_s_per_m=1470" for axis in "xy"),
    "housing.bolts.shear_stiffness_n_per_m=8e7", "housing.bolts.axial_stiffness_n_per_m=1.5e8",
    "housing.bolts.damping_ratio=0.04",
]  # fmt: skip


def configured(*overrides: str) -> Config:
    """Return the gearbox, healthy, at the four speeds."""
    points = [{"speed_hz": speed, "torque_nm": TORQUE_NM} for speed in SPEEDS_HZ]
    raw = {**read_yaml(CONFIG), "states": [{"name": "healthy"}], "operating_points": points}
    return load_config(raw, [*CONSTANTS, *overrides])


@dataclass(frozen=True)
class Contact:
    """A pair, its oil at a speed, its force and roughness."""

    pair: GearPair
    mesh: LubricatedMesh
    force_n: float
    rough_m: float

    def slide_to_roll(self, places_m: np.ndarray) -> np.ndarray:
        """Return the sliding speed over the mean rolling speed."""
        speeds = self.mesh.line_m, self.mesh.speed_1_rad_s, self.mesh.speed_2_rad_s
        return np.asarray(sliding_speed(places_m, *speeds, 0.0) / entrainment_speed(places_m, *speeds))

    def share(self, places_m: np.ndarray | float) -> Any:
        """Return what the asperities carry."""
        return np.minimum(masjedi_khonsari_ratio(self.mesh.groups(places_m, self.force_n, self.rough_m)), 1.0)

    def parts(self, places_m: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return what asperities and film add to the coefficient."""
        share = self.share(places_m)
        film = film_traction(self.mesh, places_m, self.force_n, self.rough_m, share)
        return share * BOUNDARY_FRICTION, (1.0 - share) * np.minimum(film, BOUNDARY_FRICTION)


def contact(config: Config, speed_hz: float, roughness_um: float = 0.4, oil_c: float = 50.0) -> Contact:
    """Return the contact of a pair that carries alone."""
    pair = gear_pair(config.gears)
    changed = {"roughness_um": roughness_um, "oil_temperature_c": oil_c}
    section = config.dynamics.friction.model_copy(update=changed)
    mesh = lubricated_mesh(section, pair, OperatingPoint(speed_hz, TORQUE_NM))
    return Contact(pair, mesh, TORQUE_NM / pair.pinion.base_radius_m, composite_roughness_m(section)[0])


def xu_kahraman(found: Contact, place_m: float) -> float:
    """Return the regression's coefficient; roughness in it is the composite rms [µm], pressure in GPa, oil in cP."""
    slip = abs(float(found.slide_to_roll(np.array(place_m))))
    radius = float(relative_radius(place_m, found.mesh.line_m))
    peak = float(hertz_pressure(found.force_n / found.mesh.contact_length_m, radius, found.mesh.effective_modulus_pa))
    speeds = found.mesh.line_m, found.mesh.speed_1_rad_s, found.mesh.speed_2_rad_s
    roll, oil, gpa = float(entrainment_speed(place_m, *speeds)), found.mesh.viscosity_pa_s * 1e3, peak * 1e-9
    b1, b2, b3, b4, b5 = -8.916465, 1.03303, 1.036077, -0.354068, 2.812084
    b6, b7, b8, b9 = -0.100601, 0.752755, -0.390958, 0.620305
    group = slip * gpa * log10(oil)
    power = b1 + b4 * group + b5 * exp(-group) + b9 * exp(found.rough_m * 1e6)
    return exp(power) * gpa**b2 * slip**b3 * roll**b6 * oil**b7 * radius**b8


def schlenk(found: Contact) -> float:
    """Return the measured mean coefficient; its roughness is the arithmetic mean, 0.8 of the rms of either flank."""
    pair, gear = found.pair, found.mesh
    radius_mm = float(relative_radius(pair.pitch_point_m, gear.line_m)) * 1e3
    roll = 2.0 * float(entrainment_speed(pair.pitch_point_m, gear.line_m, gear.speed_1_rad_s, gear.speed_2_rad_s))
    group = found.force_n / (gear.contact_length_m * 1e3) / (roll * radius_mm)
    rough_um = 0.8 * found.rough_m / np.sqrt(2.0) * 1e6
    return float(0.048 * group**0.2 * (gear.viscosity_pa_s * 1e3) ** -0.05 * rough_um**0.25 * 0.846)


def over_the_path(found: Contact) -> float:
    """Return our mean coefficient, weighted by the sliding power, of a pair that carries alone."""
    places = np.linspace(found.pair.contact_start_m, found.pair.contact_end_m, 400)
    weight = np.abs(places - found.pair.pitch_point_m)
    return float(sum(found.parts(places)) @ weight / weight.sum())


def ramps(config: Config) -> None:
    """Print which speeds rule the turn of the friction."""
    print("| pinion [Hz] | share La | film [µm] | δ [µm] | whole turn √(4aδ) [mm/s] | v_0 [mm/s] | "
          "film half way [mm/s] | Carter [mm/s] | Heathcote [mm/s] | mean μ | Schlenk |")  # fmt: skip
    print("|---" * 11 + "|")
    for speed in SPEEDS_HZ:
        found = contact(config, speed)
        mesh, place = found.mesh, found.pair.pitch_point_m
        point = pitch_point(found.pair, mesh)
        slip = slip_speed(mesh, point, found.force_n, found.rough_m)
        radius = float(relative_radius(place, mesh.line_m))
        half = float(hertz_half_width(found.force_n / mesh.contact_length_m, radius, mesh.effective_modulus_pa))
        roll, spin = (
            float(entrainment_speed(place, mesh.line_m, mesh.speed_1_rad_s, mesh.speed_2_rad_s)),
            mesh.speed_1_rad_s + mesh.speed_2_rad_s,
        )
        film = float(masjedi_khonsari_central(mesh.groups(place, found.force_n, found.rough_m)))
        along = np.linspace(place, found.pair.contact_end_m, 2000)
        shear = film_traction(mesh, along, found.force_n, found.rough_m, found.share(along))
        half_way = spin * (along[np.argmax(shear > 0.5 * shear.max())] - place)
        bend = abs(1.0 / place - 1.0 / (mesh.line_m - place))
        print(
            f"| {speed:g} | {found.share(place):.2f} | {film * 1e6:.2f} | "
            f"{presliding_m(mesh, point, found.force_n, found.rough_m) * 1e6:.2f} | "
            f"{TURN_OVER_SLIP_SPEED * slip * 1e3:.1f} | {slip * 1e3:.1f} | {half_way * 1e3:.0f} | "
            f"{0.11 * half / radius * roll * 1e3:.1f} | {spin * half**2 * bend / 4.0 * 1e3:.3f} | "
            f"{over_the_path(found):.3f} | {schlenk(found):.3f} |"
        )


def draw(config: Config) -> None:
    """Draw coefficient over slide-to-roll ratio: ours, what was fixed before, and what was published."""
    figure = Figure(figsize=(10, 3.6), layout="constrained")
    axes = figure.subplots(1, 3, sharey=True)
    cases = [("20 Hz, 50 °C, flanks of 0.4 µm", 20.0, 0.4, 50.0), ("40 Hz, 50 °C, flanks of 0.4 µm", 40.0, 0.4, 50.0),
             ("40 Hz, 90 °C, flanks of 0.1 µm", 40.0, 0.1, 90.0)]  # fmt: skip
    for axis, (title, *case) in zip(axes, cases, strict=True):
        found = contact(config, *case)
        places = found.pair.pitch_point_m + np.linspace(0.0, 1.0, 400) ** 2 * (
            found.pair.contact_end_m - found.pair.pitch_point_m
        )
        slip = found.slide_to_roll(places)
        asperities, film = found.parts(places)
        v_0 = slip_speed(found.mesh, pitch_point(found.pair, found.mesh), found.force_n, found.rough_m)
        speeds = found.mesh.line_m, found.mesh.speed_1_rad_s, found.mesh.speed_2_rad_s
        slide = np.asarray(sliding_speed(places, *speeds, 0.0))
        share = found.share(places)
        fixed = (share * BOUNDARY_FRICTION + (1 - share) * FIXED_FILM) * np.tanh(slide / FIXED_SLIP_M_S)
        axis.plot(slip, (asperities + film) * np.tanh(slide / v_0), "C0", label="siggen")
        axis.plot(slip, film * np.tanh(slide / v_0), "C0:", label="of it the film")
        axis.plot(slip, fixed, "C7--", label="siggen before: film 0.02, ramp 0.02 m/s")
        axis.plot(slip[1:], [xu_kahraman(found, place) for place in places[1:]], "C3", label="Xu and others 2007")
        axis.plot([slip[-1] * 0.45, slip[-1] * 0.75], [schlenk(found)] * 2, "k", lw=3, label="Schlenk, mean of gears")
        axis.set(title=title, xlabel="slide-to-roll ratio", xlim=(0.0, slip[-1]), ylim=(0.0, None))
    axes[0].set_ylabel("friction coefficient")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    figure.savefig(FIGURES / "pitch_point.png", dpi=110)


def law_as_before(*given: Any, film: bool, **more: Any) -> FrictionLaw | None:
    """Return the law with one ramp for all speeds as it was, and with `film` with the film as it was."""
    law = _lubricated(*given, **more)
    if law is None:
        return None
    table = law.table._replace(fluid=np.full_like(law.table.fluid, FIXED_FILM)) if film else law.table
    return law._replace(table=table, slip_speed_m_s=FIXED_SLIP_M_S)


_lubricated = motion.specimen_friction
LAWS = {
    "off": _lubricated, "before": partial(law_as_before, film=True),
    "ramp as before": partial(law_as_before, film=False), "now": _lubricated,
}  # fmt: skip


def strongest_lines(name: str) -> list[tuple[float, int, float]]:
    """Return the pinion's strongest bearing line [N], its number, and the casing's rms [m/s²], per speed."""
    config = configured(f"dynamics.friction.model={'off' if name == 'off' else 'mixed_ehl'}")
    motion.specimen_friction = LAWS[name]  # type: ignore[assignment]
    specimen = draw_specimen(config, 0)
    built, rows = specimen_state(config, specimen, 0), []
    for place, speed in enumerate(SPEEDS_HZ):
        response, _ = record_response(config, specimen, built, planned_record(config, place), internals=True)
        quantities = internal_quantities(specimen, response)
        names = [f"bearing_force_pinion_bearing_{axis}_n" for axis in ("vertical", "horizontal")]
        lines = np.array([mesh_lines(quantities[name], 54000 / speed) for name in names])
        shaking = float(np.std(quantities["clean_accel_casing_lid_vertical_m_s2"]))
        rows.append((float(lines.max()), int(np.argmax(lines.max(axis=0))) + 1, shaking))
    motion.specimen_friction = _lubricated
    return rows


def mesh_lines(signal: np.ndarray, samples_per_turn: float) -> np.ndarray:
    """Return single-sided amplitudes of the first ten mesh lines over whole turns."""
    turns = int(signal.size / samples_per_turn)
    held = signal[: round(turns * samples_per_turn)]
    return 2.0 / held.size * np.abs(np.fft.rfft(held))[18 * turns * np.arange(1, 11)]


def forces() -> None:
    """Print the strongest line of the bearing forces and the casing's vertical acceleration by law and speed."""
    found = {name: strongest_lines(name) for name in LAWS}
    print(f"\n| pinion [Hz] | {' | '.join(LAWS)} |\n|---{'|---' * len(LAWS)}|")
    for row, speed in enumerate(SPEEDS_HZ):
        rows = (found[name][row] for name in LAWS)
        cells = [f"{force:.1f} N, line {line}; {shaking:.2f} m/s²" for force, line, shaking in rows]
        print(f"| {speed:g} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    ramps(configured())
    draw(configured())
    forces()
