"""Numbers of machines in SI: gears on their bearings, shafts, a planetary set, a casing on its bolts, a base."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import cos, pi, sqrt

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.spur_gear import SpurGear

Point = tuple[float, float]
"""Horizontal and vertical distance from the casing's centre of gravity [m]."""
PLACES = (1.0 / 3.0, 2.0 / 3.0)
"""Of both gears between the bearings of their shaft (assumed)."""


@dataclass(frozen=True, slots=True)
class Bearing:
    """Both bearings of one shaft together, along the centre line (x) and vertical (y).

    `stiffness_xy_n_per_m`: force along one axis per way along the other, of bearings that are stiffer along a slanted
    load. `stiffness_z_n_per_m`: along the shaft, where helical teeth push. `damping_time_s`: damping over stiffness,
    which it follows with the load; None: damping is the same at any load.
    """

    stiffness_x_n_per_m: float
    stiffness_y_n_per_m: float
    damping_x_n_s_per_m: float
    damping_y_n_s_per_m: float
    stiffness_xy_n_per_m: float = 0.0
    stiffness_z_n_per_m: float = 1e8
    damping_time_s: float | None = None

    @property
    def along_axis(self) -> tuple[float, float]:
        """Stiffness [N/m] and damping [N s/m] along the shaft, whose damping ratio is that across (assumed)."""
        across = 0.5 * (self.stiffness_x_n_per_m + self.stiffness_y_n_per_m)
        damping = 0.5 * (self.damping_x_n_s_per_m + self.damping_y_n_s_per_m)
        return self.stiffness_z_n_per_m, damping * sqrt(self.stiffness_z_n_per_m / across)


@dataclass(frozen=True, slots=True)
class Coupling:
    """A torsional shaft with its coupling."""

    stiffness_nm_per_rad: float
    damping_nm_s_per_rad: float


@dataclass(frozen=True, slots=True)
class Rotor:
    """One gear with its bearings."""

    base_radius_m: float
    mass_kg: float
    inertia_kg_m2: float
    bearing: Bearing


@dataclass(frozen=True, slots=True)
class GearStage:
    """Numbers of a motor, a pinion, a gear and a load; the 6-DOF variant uses only the gears.

    `base_helix_rad`: helix angle on the base cylinders, positive where the pinion is right-handed; 0 for spur gears.
    """

    working_pressure_angle_rad: float
    pinion: Rotor
    gear: Rotor
    motor_inertia_kg_m2: float
    load_inertia_kg_m2: float
    input_coupling: Coupling
    output_coupling: Coupling
    base_helix_rad: float = 0.0

    @property
    def ratio(self) -> float:
        """Torque at the load per torque at the motor, z_2/z_1."""
        return self.gear.base_radius_m / self.pinion.base_radius_m

    @property
    def centre_distance_m(self) -> float:
        """Distance of the axes [m]."""
        return (self.pinion.base_radius_m + self.gear.base_radius_m) / cos(self.working_pressure_angle_rad)


@dataclass(frozen=True, slots=True)
class Shaft:
    """A round shaft of one diameter between two bearings.

    Parameters
    ----------
    span_m : float
        Distance of the bearings, above 0.
    gear_share : float
        Place of the gear's middle from bearing a, as a share of the span, between 0 and 1.
    diameter_m : float
    youngs_modulus_pa, poisson_ratio : float
    tilt_inertia_kg_m2 : float
        Moment of inertia of the gear about a diameter.
    """

    span_m: float
    gear_share: float
    diameter_m: float
    youngs_modulus_pa: float
    poisson_ratio: float
    tilt_inertia_kg_m2: float

    @property
    def levers_m(self) -> dict[str, float]:
        """Where the bearings a and b lie from the middle of the gear [m]."""
        return {"a": -self.gear_share * self.span_m, "b": (1.0 - self.gear_share) * self.span_m}


def cantilever_compliance_m_per_n(shaft: Shaft, length_m: float) -> float:
    """Return how far the end of a piece of the shaft gives way per force on it [m/N], clamped in the gear."""
    area, inertia = 0.25 * pi * shaft.diameter_m**2, pi * shaft.diameter_m**4 / 64.0
    poisson = shaft.poisson_ratio
    shear_modulus = shaft.youngs_modulus_pa / (2.0 * (1.0 + poisson))
    effective = 6.0 * (1.0 + poisson) / (7.0 + 6.0 * poisson) * area
    bending = length_m**3 / (3.0 * shaft.youngs_modulus_pa * inertia)
    return bending + length_m / (shear_modulus * effective)


@dataclass(frozen=True, slots=True)
class CommonShaft:
    """A round shaft on two bearings that carries a driven gear and the pinion of the next mesh."""

    span_m: float
    diameter_m: float
    youngs_modulus_pa: float
    poisson_ratio: float

    @property
    def torsional_stiffness_nm_per_rad(self) -> float:
        """Stiffness of the piece between both gears: G J over its length."""
        shear = 0.5 * self.youngs_modulus_pa / (1.0 + self.poisson_ratio)
        return shear * pi * self.diameter_m**4 / 32.0 / (self.span_m * (PLACES[1] - PLACES[0]))

    @property
    def bending_m_per_n(self) -> FloatArray:
        """Deflection (2, 2) of the places of both gears by forces there, on stiff bearings."""
        a, b = (self.span_m * place for place in PLACES)
        length, rigidity = self.span_m, self.youngs_modulus_pa * pi * self.diameter_m**4 / 64.0

        def deflection(at: float, force_at: float) -> float:
            low, beyond = min(at, force_at), length - max(at, force_at)
            return low * beyond * (length**2 - low**2 - beyond**2) / (6.0 * rigidity * length)

        return np.array([[deflection(a, a), deflection(a, b)], [deflection(b, a), deflection(b, b)]])


@dataclass(frozen=True, slots=True)
class NextStage:
    """A mesh behind another one: its gears, the shaft that its pinion shares, the direction to its gear [rad].

    Without a shaft its pinion is the gear in front itself, an idler.
    """

    working_pressure_angle_rad: float
    pinion: Rotor
    gear: Rotor
    shaft: CommonShaft | None
    direction_rad: float


@dataclass(frozen=True, slots=True)
class PlanetaryBody:
    """A member with its support, alike in all directions; `turning_stiffness_nm_per_rad` holds the ring."""

    base_radius_m: float
    mass_kg: float
    inertia_kg_m2: float
    stiffness_n_per_m: float
    damping_n_s_per_m: float
    turning_stiffness_nm_per_rad: float = 0.0
    turning_damping_nm_s_per_rad: float = 0.0


@dataclass(frozen=True, slots=True)
class PlanetaryStage:
    """Numbers of a set whose ring is held; the carrier's base radius is not read.

    Working pressure angles of the meshes with the sun and with the ring [rad]; places of the planets [turns]; the
    support of a planet is its pin's.
    """

    sun_angle_rad: float
    ring_angle_rad: float
    centre_distance_m: float
    sun: PlanetaryBody
    planet: PlanetaryBody
    ring: PlanetaryBody
    carrier: PlanetaryBody
    places_turns: tuple[float, ...]
    motor_inertia_kg_m2: float
    load_inertia_kg_m2: float
    input_coupling: Coupling
    output_coupling: Coupling

    @property
    def ratio(self) -> float:
        """Turns of the sun per turn of the carrier, 1 + R_br/R_bs."""
        return 1.0 + self.ring.base_radius_m / self.sun.base_radius_m


@dataclass(frozen=True, slots=True)
class Bolts:
    """Bolts between casing and ground: horizontal stiffness by shear, vertical by the bolt's axis.

    All are alike, but the first has a share of its stiffness left where it is loose: softer, and never off the ground.
    """

    shear_stiffness_n_per_m: float
    axial_stiffness_n_per_m: float
    damping_ratio: float
    places_m: tuple[Point, ...]
    loose_share: float = 1.0


@dataclass(frozen=True, slots=True)
class Casing:
    """A rigid casing, and where pinion and sensors stand on it."""

    mass_kg: float
    inertia_kg_m2: float
    bolts: Bolts
    pinion_place_m: Point
    sensor_places_m: Mapping[str, Point] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Base:
    """A rigid base; `natural_hz` along x, along y and in rocking are those of the base alone on its mounts."""

    mass_kg: float
    inertia_kg_m2: float
    natural_hz: tuple[float, float, float]
    damping_ratio: float


# A gear as a solid steel disc of its pitch circle with its bore.

STEEL_DENSITY_KG_M3 = 7850.0


def disc_mass_kg(gear: SpurGear, face_width_m: float) -> float:
    """Return its mass [kg]."""
    return STEEL_DENSITY_KG_M3 * pi * (gear.pitch_radius_m**2 - gear.bore_radius_m**2) * face_width_m


def disc_inertia_kg_m2(gear: SpurGear, face_width_m: float) -> float:
    """Return its moment of inertia about its axis [kg m^2]."""
    return 0.5 * disc_mass_kg(gear, face_width_m) * (gear.pitch_radius_m**2 + gear.bore_radius_m**2)
