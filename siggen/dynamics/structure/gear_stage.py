"""GearStage: the numbers of a motor, two gears on their bearings and a load, in SI."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

import numpy as np


@dataclass(frozen=True, slots=True)
class Bearing:
    """Both bearings of one shaft together, along the centre line (x) and vertical (y).

    `stiffness_xy_n_per_m`: force along one axis per way along the other, of bearings that are stiffer along a slanted
    load. `stiffness_z_n_per_m`: along the shaft, where helical teeth push.
    """

    stiffness_x_n_per_m: float
    stiffness_y_n_per_m: float
    damping_x_n_s_per_m: float
    damping_y_n_s_per_m: float
    stiffness_xy_n_per_m: float = 0.0
    stiffness_z_n_per_m: float = 1e8

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
    def line_of_action_m(self) -> float:
        """Distance T of the base tangent points [m]."""
        radii = self.pinion.base_radius_m + self.gear.base_radius_m
        return float(radii * np.tan(self.working_pressure_angle_rad))

    @property
    def equivalent_mesh_mass_kg(self) -> float:
        """J_1 J_2 / (J_1 R_b2² + J_2 R_b1²) [kg]."""
        pinion, gear = self.pinion, self.gear
        return 1.0 / (pinion.base_radius_m**2 / pinion.inertia_kg_m2 + gear.base_radius_m**2 / gear.inertia_kg_m2)
