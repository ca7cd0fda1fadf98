"""The same record twice: integrated by siggen, and by scipy from an exported model (docs/exported_model.md)."""

import sys
import tempfile
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

FIGURE = Path(__file__).resolve().parents[1] / "figures" / "exported_model.png"


def table(values, place):
    """Return a table's value `place` intervals from its first point, linear between points, kept beyond its ends."""
    return np.interp(place, np.arange(len(values)), values)


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


def pair_force(model, approach, rate, pitches):
    """Return the mesh force of the law pairs on the drive flank, without friction and without a squeezed film."""
    before, after = model["law.reach_before"], model["law.reach_after"]
    first = int(np.floor(pitches + before))
    touching = []
    for n in range(first, int(np.floor(pitches - model["law.contact_ratio"] - after)), -1):
        one, two = n % model["law.offset_1"].size, n % model["law.offset_2"].size
        stiffness = model["law.stiffness"][model["law.table_of_pair"][one, two]]
        missing = model["law.offset_1"][one] + model["law.offset_2"][two]
        at = (pitches - n + before) * model["law.missing_intervals_per_pitch"]
        missing += table(model["law.missing_1"][model["law.kind_of_tooth_1"][one]], at)
        missing += table(model["law.missing_2"][model["law.kind_of_tooth_2"][two]], at)
        if approach > missing:
            k = table(stiffness, (pitches - n) * model["law.intervals_per_pitch"])
            touching.append((k, approach - missing))
    total = sum(k for k, _ in touching)
    damping = model["law.damping_root_kg"] / np.sqrt(total) if touching else 0.0
    return sum(max(0.0, k * (penetration + damping * rate)) for k, penetration in touching)


def integrate(model, times):
    """Return approach and mesh force at `times`, from the start of the transient on."""
    n, p = len(model["coordinates"]), model["mesh_vector"]
    law = {"linear": linear_force, "pairs": pair_force}[str(model["law"])]
    inverse = np.linalg.inv(model["mass"])

    def force(t, z):
        pitches = (model["start_angle_rad"] + 2 * np.pi * model["speed_hz"] * t) * model["pitches_per_rad"]
        return law(model, model["static_approach_m"] + p @ z[:n], p @ z[n:], pitches)

    def rate(t, z):
        moved = model["stiffness"] @ z[:n] + model["damping"] @ z[n:] + p * (force(t, z) - model["static_force_n"])
        return np.concatenate([z[n:], -inverse @ moved])

    # A step must not pass over a whole engagement: a tenth of one at most.
    longest = 0.1 / (model["speed_hz"] * 2 * np.pi * model["pitches_per_rad"])
    found = solve_ivp(
        rate, (model["start_s"], times[-1]), model["start_state"], "RK45", times, rtol=1e-7, atol=1e-14, max_step=longest
    )
    return model["static_approach_m"] + p @ found.y[:n], np.array([force(t, z) for t, z in zip(times, found.y.T)])


def compare(config, overrides, samples=600):
    """Return times [s], then approach [m] and mesh force [N] by siggen and by scipy."""
    from siggen.exported_model import exported_model, write_model
    from siggen.loading import load_config
    from siggen.record_internals import internals_table

    loaded = load_config(config, [*overrides, f"duration_s={samples / 51200}"])
    with tempfile.TemporaryDirectory() as folder:
        write_model(exported_model(loaded, 0), Path(folder) / "model.npz")
        with np.load(Path(folder) / "model.npz") as file:
            model = {name: value[()] for name, value in file.items()}  # [()]: plain numbers instead of 0-d arrays
    inner = internals_table(loaded, 0)
    times = np.arange(samples) / model["fs_hz"]
    own = (inner["approach_m"].to_numpy(), inner["mesh_force_n"].to_numpy())
    return times, own, integrate(model, times)


CASES = {
    "8 degrees of freedom, law linear": ("configs/paper_a.yaml", ["dynamics.steps_per_sample=16"]),
    "casing, law pairs without friction": (
        "configs/paper_b.yaml",
        ["dynamics.friction.model=off", "dynamics.steps_per_sample=16"],
    ),
}


def main():
    """Print the largest differences and draw both solutions over each other."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9, 6.5), layout="constrained")
    axes = figure.subplots(2, 2)
    for row, (name, (config, overrides)) in zip(axes, CASES.items()):
        times, own, other = compare(config, overrides)
        for axis, quantity, unit, scale, a, b in zip(
            row, ("approach", "mesh force"), ("µm", "N"), (1e6, 1.0), own, other
        ):
            error = np.abs(a - b).max() / np.ptp(a)
            print(f"{name}, {quantity}: largest difference {error:.1e} of the swing of {scale * np.ptp(a):.4g} {unit}")
            axis.plot(1e3 * times, scale * a, color="tab:blue", lw=2.5, alpha=0.5, label="siggen")
            axis.plot(1e3 * times, scale * b, color="black", lw=0.8, ls="--", label="scipy, from the exported model")
            axis.set(xlabel="time [ms]", ylabel=f"{quantity} [{unit}]", title=f"{name}\nlargest difference {error:.0e} of the swing")
            axis.grid(alpha=0.3)
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=2)
    figure.savefig(FIGURE, dpi=110)


if __name__ == "__main__":
    sys.exit(main())
