"""One record twice: integrated by siggen, and by scipy from an exported model (docs/reference/exported_model.md)."""

import sys
import tempfile
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicHermiteSpline

FIGURE = Path(__file__).resolve().parents[1] / "figures" / "exported_model.png"


def table(values, place):
    """Return a table's value `place` intervals from its first point, linear between points, kept beyond its ends."""
    return np.interp(place, np.arange(len(values)), values)


def between(rows, place):
    """Return the same of a table of rows."""
    place = min(max(place, 0.0), len(rows) - 1.0)
    cell = min(int(place), len(rows) - 2)
    return rows[cell] * (cell + 1 - place) + rows[cell + 1] * (place - cell)


def linear_force(model, approach, rate, pitches):
    """Return the mesh force of the law linear: stiffness of all pairs times the approach beyond half the backlash."""
    gap, side = model["law.half_backlash_m"], np.sign(approach)
    if gap > 0 and abs(approach) <= gap:
        return 0.0
    stiffness = 0.0
    for n in range(int(np.floor(pitches)), int(np.floor(pitches - model["law.contact_ratio"])), -1):
        teeth_1, teeth_2 = model["law.table_of_pair"].shape
        row = model["law.table_of_pair"][n % teeth_1, n % teeth_2]
        stiffness += table(model["law.stiffness"][row], (pitches - n) * model["law.intervals_per_pitch"])
    return stiffness * (approach - side * gap) + model["law.damping_n_s_per_m"] * rate


def pair_force(model, approach, rate, pitches, tilt=0.0, tilt_rate=0.0):
    """Return mesh force and moment of the law pairs on the drive flank, without friction, squeezed film, coupling."""
    before, after = model["law.reach_before"], model["law.reach_after"]
    first = int(np.floor(pitches + before))
    touching = []
    for n in range(first, int(np.floor(pitches - model["law.contact_ratio"] - after)), -1):
        one, two = n % model["law.offset_1"].size, n % model["law.offset_2"].size
        missing = model["law.offset_1"][one] + model["law.offset_2"][two]
        missing += model.get("law.slices.lead_m", 0.0) + model.get("law.contact.lead_m", 0.0)
        at = (pitches - n + before) * model["law.missing_intervals_per_pitch"]
        missing += table(model["law.missing_1"][model["law.kind_of_tooth_1"][one]], at)
        missing += table(model["law.missing_2"][model["law.kind_of_tooth_2"][two]], at)
        row, place = model["law.table_of_pair"][one, two], (pitches - n) * model["law.intervals_per_pitch"]
        found = spring(model, row, place, approach - missing, tilt)
        if found[0] > 0.0:
            touching.append(found)
    total = sum(tangent for _, tangent, *_ in touching)
    damping = model["law.damping_root_kg"] / np.sqrt(total) if touching else 0.0
    force = moment = 0.0
    for elastic, tangent, turned, cross, turning in touching:
        normal = elastic + damping * (tangent * rate + cross * tilt_rate)
        if normal > 0.0:
            force, moment = force + normal, moment + turned + damping * (cross * rate + turning * tilt_rate)
    return force, moment


def spring(model, row, place, penetration, tilt):
    """Return force, stiffness, moment and its two derivatives; with slices groups of the face touch one by one."""
    whole = table(model["law.stiffness"][row], place)
    if penetration <= 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    if "law.contact.curves" in model:
        return face_spring(model, row, place, penetration, tilt)
    if "law.slices.sink_m" not in model:
        return whole * penetration, whole, 0.0, 0.0, 0.0
    sinks = between(model["law.slices.sink_m"][row], place)
    flush, contact = table(model["law.slices.flush"][row], place), table(model["law.slices.contact_n_per_m"], place)
    # Springs in the order in which they touch: what is flush, then groups that stand for 1, 3, 5 ... parts of the rest.
    parts = contact * (1.0 - flush) * (2 * np.arange(sinks.size) + 1) / sinks.size**2
    stiffness = np.cumsum(np.append(contact * flush, parts))
    preload = np.cumsum(np.append(0.0, parts * sinks))
    compliance = 1.0 / whole - 1.0 / contact
    # The force is the largest of those with the first 1, 2, 3, ... springs in contact.
    forces = (stiffness * penetration - preload) / (1.0 + compliance * stiffness)
    last = int(np.argmax(forces))
    return forces[last], stiffness[last] / (1.0 + compliance * stiffness[last]), 0.0, 0.0, 0.0


def face_spring(model, row, place, penetration, tilt):
    """Return the same from the table of the contact across the face."""
    approach = penetration - table(model["law.contact.touch_m"][row], place)
    if approach <= 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    place = min(max(place, 0.0), model["law.contact.column"].shape[1])
    cell = min(int(place), model["law.contact.column"].shape[1] - 1)
    column = model["law.contact.column"][row, cell] + model["law.contact.gain"][row, cell] * (place - cell)
    curve = between(model["law.contact.curves"], column)
    nodes = model["law.contact.reach_m"] * (np.arange(len(curve)) / (len(curve) - 1)) ** 2
    if approach > nodes[-1]:
        raise ValueError(
            f"an approach of {approach} m lies beyond the last node; this script does not go on from there"
        )
    force, slope, _ = cubic(nodes, curve[:, 0:2], approach)
    if curve.shape[1] == 4:
        return force, slope, 0.0, 0.0, 0.0
    moment, cross, bend = cubic(nodes, curve[:, 4:6], approach)
    turning, turning_slope, turning_bend = cubic(nodes, curve[:, 6:8], approach)
    force += tilt * cross + 0.5 * tilt**2 * turning_slope
    slope += tilt * bend + 0.5 * tilt**2 * turning_bend
    return max(force, 0.0), max(slope, 0.0), moment + turning * tilt, cross + turning_slope * tilt, turning


def cubic(nodes, values, at):
    """Return value and two derivatives of the cubic of Hermite with values and slopes (n, 2)."""
    spline = CubicHermiteSpline(nodes, values[:, 0], values[:, 1])
    return float(spline(at)), float(spline(at, 1)), float(spline(at, 2))


def integrate(model, times):
    """Return approach and mesh force at `times`, from the start of the transient on."""
    untold = [key for key in ("law.coupling_m_per_n", "law.damping_film_root_kg") if key in model]
    if untold or model.get("law.rubs", False):
        raise ValueError(f"this script knows no friction, coupling or damping by asperity share: {untold}")
    n, p = len(model["coordinates"]), model["mesh_vector"]
    law = {"linear": linear_force, "pairs": pair_force}[str(model["law"])]
    inverse = np.linalg.inv(model["mass"])

    turn = model.get("tilt_vector", np.zeros(n))

    def mesh(t, z):
        pitches = (model["start_angle_rad"] + 2 * np.pi * model["speed_hz"] * t) * model["pitches_per_rad"]
        tilt = (model["static_tilt_rad"] + turn @ z[:n], turn @ z[n:]) if "tilt_vector" in model else ()
        found = law(model, model["static_approach_m"] + p @ z[:n], p @ z[n:], pitches, *tilt)
        return found if isinstance(found, tuple) else (found, 0.0)

    def rate(t, z):
        force, moment = mesh(t, z)
        moved = model["stiffness"] @ z[:n] + model["damping"] @ z[n:] + p * (force - model["static_force_n"])
        return np.concatenate([z[n:], -inverse @ (moved + turn * moment)])

    # A step must not pass over a whole engagement: a tenth of one at most.
    longest = 0.1 / (model["speed_hz"] * 2 * np.pi * model["pitches_per_rad"])
    found = solve_ivp(
        rate,
        (model["start_s"], times[-1]),
        model["start_state"],
        "RK45",
        times,
        rtol=1e-7,
        atol=1e-14,
        max_step=longest,
    )
    return model["static_approach_m"] + p @ found.y[:n], np.array(
        [mesh(t, z)[0] for t, z in zip(times, found.y.T, strict=True)]
    )


def compare(config, overrides, samples=600, record=0):
    """Return times [s], then approach [m] and mesh force [N] by siggen and by scipy."""
    from siggen.checks.loading import load_config
    from siggen.record.internals import internals_table
    from siggen.views.exported_model import exported_model, write_model

    loaded = load_config(config, [*overrides, f"duration_s={samples / 51200}"])
    with tempfile.TemporaryDirectory() as folder:
        write_model(exported_model(loaded, record), Path(folder) / "model.npz")
        with np.load(Path(folder) / "model.npz") as file:
            model = {name: value[()] for name, value in file.items()}  # [()]: plain numbers instead of 0-d arrays
    inner = internals_table(loaded, record)
    times = np.arange(samples) / model["fs_hz"]
    own = (inner["approach_m"].to_numpy(), inner["mesh_force_n"].to_numpy())
    return times, own, integrate(model, times)


FRICTIONLESS = ["dynamics.friction.model=off", "dynamics.mesh.damping=constant"]
FRICTIONLESS += ["dynamics.integrator=runge_kutta", "dynamics.steps_per_sample=16"]
IDEAL = ["manufacture=null", "dynamics.shafts=null", "dynamics.mesh.contact=slices"]
SPALL = (
    "states.5.damage={kind: spall, gear: pinion, teeth: 1, centre_height_mm: pitch, face_length_mm: 20.0, "
    "depth_mm: 0.2, profile_length_mm: {kind: uniform, low: 0.8, high: 1.0}}"
)
CASES = {
    "8 degrees of freedom, law linear": ("configs/paper_a.yaml", ["dynamics.steps_per_sample=16"], 600, 0),
    "casing, law pairs without friction": ("configs/paper_b.yaml", [*FRICTIONLESS, *IDEAL], 600, 0),
    # The pinion turns once within 2200 samples, at 25 Hz: the spalled tooth is among them.
    "the same, spall through the face": ("configs/paper_b.yaml", [*FRICTIONLESS, *IDEAL, SPALL], 2200, 16),
}


def main():
    """Print the largest differences and draw both solutions over each other."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9, 9), layout="constrained")
    axes = figure.subplots(3, 2)
    for row, (name, arguments) in zip(axes, CASES.items(), strict=False):
        times, own, other = compare(*arguments)
        for axis, quantity, unit, scale, a, b in zip(
            row, ("approach", "mesh force"), ("µm", "N"), (1e6, 1.0), own, other, strict=False
        ):
            error = np.abs(a - b).max() / np.ptp(a)
            print(f"{name}, {quantity}: largest difference {error:.1e} of the swing of {scale * np.ptp(a):.4g} {unit}")
            axis.plot(1e3 * times, scale * a, color="tab:blue", lw=2.5, alpha=0.5, label="siggen")
            axis.plot(1e3 * times, scale * b, color="black", lw=0.8, ls="--", label="scipy, from the exported model")
            axis.set(
                xlabel="time [ms]",
                ylabel=f"{quantity} [{unit}]",
                title=f"{name}\nlargest difference {error:.0e} of the swing",
            )
            axis.grid(alpha=0.3)
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=2)
    figure.savefig(FIGURE, dpi=110)


if __name__ == "__main__":
    sys.exit(main())
