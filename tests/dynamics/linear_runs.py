"""The response under the linear mesh law at constant speed and motor torque, for tests."""

from __future__ import annotations

from siggen.drivetrain.drive import Drive
from siggen.drivetrain.structure import Structure
from siggen.mesh.mesh_tables import MeshTables
from siggen.motion.linear_motion import LinearMotion
from siggen.motion.response import Response, SampleGrid, Wanted, response_of


def simulate_response(
    structure: Structure,
    tables: MeshTables,
    *,
    torque_nm: float,
    speed_hz: float,
    start_angle_rad: float,
    mesh_damping_ratio: float,
    backlash_m: float,
    fs_hz: float,
    samples: int,
    steps_per_sample: int,
    integrator: str = "product",
    internals: bool = False,
) -> Response:
    """Return the stationary response; a negative torque loads the back flank, backlash 0 gives the linear model."""
    grid = SampleGrid(fs_hz, samples, steps_per_sample)
    motion = LinearMotion(
        structure, tables, torque_nm=torque_nm, mesh_damping_ratio=mesh_damping_ratio, backlash_m=backlash_m,
        step_s=1.0 / (fs_hz * steps_per_sample), integrator=integrator,
    )  # fmt: skip
    return response_of(motion, Drive(speed_hz, start_angle_rad), grid, wanted=Wanted(internals=internals))
