"""One record twice: integrated by siggen, and by scipy from an exported model (docs/reference/exported_model.md)."""

import sys
import tempfile
from pathlib import Path

import numpy as np
from exported_law import LAWS, State, between, place_in
from scipy.integrate import solve_ivp

FIGURE = Path(__file__).resolve().parents[1] / "figures" / "exported_model.png"


def integrate(model, times, rtol=1e-6):
    """Return approach [m], mesh force [N] and tilt [rad] at `times`, from the start of the transient on.

    `rtol` of every step. The absolute tolerance is that of displacements of 1 µm (or µrad) and of 20 mm/s, such as
    vibrations of some kHz have: small coordinates must not force small steps.
    """
    n, p = len(model["coordinates"]), model["mesh_vector"]
    law = LAWS[str(model["law"])](model)
    inverse = np.linalg.inv(model["mass"])
    turn, turn_x = model.get("tilt_vector", np.zeros(n)), model.get("tilt_friction_vector", np.zeros(n))
    static_tilt = model.get("static_tilt_rad", 0.0)
    sums = np.stack([p, *model["sliding_vectors"], turn, turn_x])
    pushed, moved = inverse @ sums.T, -inverse @ np.hstack([model["stiffness"], model["damping"]])
    rolling = rigid_sliding(model)
    drive = Drive(model, inverse)

    def forces(t, z):
        pitches, speed_ratio, _ = drive.at(t)
        displaced, moving = (sums @ z[:n]).tolist(), (sums @ z[n:]).tolist()
        slides = [v + speed_ratio * r for v, r in zip(moving[1:3], rolling, strict=True)]
        return law.forces(
            State(model["static_approach_m"] + displaced[0], moving[0], *slides, static_tilt + displaced[3], moving[3]),
            pitches,
        )

    def rate(t, z):
        found = forces(t, z)
        loads = [found.normal - model["static_force_n"], found.friction, found.friction_moment]
        loads += [found.across, found.friction_across]
        return np.concatenate([z[n:], moved @ z - pushed @ loads + drive.at(t)[2]])

    # A step must not pass over a whole engagement: a tenth of one at most.
    longest = 0.1 / (model["speed_hz"] * 2 * np.pi * model["pitches_per_rad"])
    found = solve_ivp(
        rate,
        (model["start_s"], times[-1]),
        model["start_state"],
        "RK45",
        times,
        rtol=rtol,
        atol=rtol * np.repeat([1e-6, 2e-2], n),
        max_step=longest,
    )
    mesh = np.array([forces(t, z).normal for t, z in zip(times, found.y.T, strict=True)])
    return model["static_approach_m"] + p @ found.y[:n], mesh, static_tilt + turn @ found.y[:n]


def rigid_sliding(model):
    """Return both parts of the sliding speed of the rigid rotation: that of a pair at s is the first + s the second."""
    names, p = list(model["coordinates"]), model["mesh_vector"]
    pinion, gear = names.index("theta_1"), names.index("theta_2")
    rolling = np.zeros(len(names))
    rolling[pinion], rolling[gear] = 1.0, -p[pinion] / p[gear]
    return (model["sliding_vectors"] @ rolling * 2 * np.pi * model["speed_hz"]).tolist()


class Drive:
    """The pinion's angle in base pitches, its speed over the nominal one, and accelerations by other forces."""

    def __init__(self, model, inverse):
        self.model, self.none = model, np.zeros(len(inverse))
        if "inputs" in model:
            self.pushed = inverse @ model["input_vectors"].T

    def at(self, t):
        """Return all three at a time; what varies is linear between the steps of siggen."""
        model = self.model
        if "inputs" not in model:
            angle = model["start_angle_rad"] + 2 * np.pi * model["speed_hz"] * t
            return angle * model["pitches_per_rad"] + model["ahead_pitches"], 1.0, self.none
        cell, weight = place_in(len(model["pitches"]), (t - model["start_s"]) / model["step_s"])
        inputs = between(model["inputs"], cell, weight)
        ratio = 1.0 if model["speed_input"] < 0 else 1.0 + inputs[model["speed_input"]]
        return between(model["pitches"], cell, weight), ratio, self.pushed @ inputs


def compare(config, overrides, samples=600, record=0, rtol=1e-6):
    """Return times [s], then approach [m], mesh force [N] and, where gears tilt, tilt [rad] by siggen and by scipy."""
    from siggen.checks.loading import load_config
    from siggen.config import by_reference
    from siggen.record.internals import internals_table
    from siggen.views.exported_model import exported_model, write_model

    fs_hz = load_config(config, overrides).fs_hz
    loaded = load_config(config, [*overrides, f"duration_s={samples / fs_hz}"])
    if loaded.dynamics.mesh.law == "pairs":  # the same steps in both: Runge-Kutta
        loaded = loaded.model_copy(update={"dynamics": by_reference(loaded.dynamics)})
    with tempfile.TemporaryDirectory() as folder:
        write_model(exported_model(loaded, record), Path(folder) / "model.npz")
        with np.load(Path(folder) / "model.npz") as file:
            model = {name: value[()] for name, value in file.items()}  # [()]: plain numbers instead of 0-d arrays
    inner = internals_table(loaded, record)
    times = np.arange(samples) / model["fs_hz"]
    names = ["approach_m", "mesh_force_n", *(["mesh_tilt_rad"] if "tilt_vector" in model else [])]
    own = tuple(inner[name].to_numpy() for name in names)
    return times, own, integrate(model, times, rtol)[: len(own)]


IDEAL = ["manufacture=null", "dynamics.shafts=null"]
SPALL = (
    "states.5.damage={kind: spall, gear: pinion, teeth: 1, centre_height_mm: pitch, face_length_mm: 20.0, "
    "depth_mm: 0.2, profile_length_mm: {kind: uniform, low: 0.8, high: 1.0}}"
)
FINE = ["dynamics.steps_per_sample=8"]
MISALIGNED = [*FINE, "manufacture.lead_misalignment_um=5"]
CASES = {
    "paper_a, law linear": ("configs/paper_a.yaml", ["dynamics.steps_per_sample=16"], 600, 0, 1e-7),
    # The pinion turns once within 2200 samples, at 25 Hz: the spalled tooth is among them.
    "paper_b, spall through the face": (
        "configs/paper_b.yaml",
        [*IDEAL, SPALL, "dynamics.steps_per_sample=16"],
        2200,
        16,
        1e-5,
    ),
    "bench, spall over 80 % of the face, misaligned": ("configs/bench.yaml", MISALIGNED, 800, 5, 1e-5),
}
QUANTITIES = (("approach", "µm", 1e6), ("mesh force", "N", 1.0), ("tilt", "µrad", 1e6))


def main():
    """Print the largest differences and draw approach and mesh force of both over each other."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9, 9), layout="constrained")
    axes = figure.subplots(len(CASES), 2)
    for row, (name, arguments) in zip(axes, CASES.items(), strict=True):
        times, own, other = compare(*arguments)
        for column, ((quantity, unit, scale), a, b) in enumerate(zip(QUANTITIES, own, other, strict=False)):
            error, swing = np.abs(a - b).max() / np.ptp(a), scale * np.ptp(a)
            print(f"{name}, {quantity}: largest difference {error:.1e} of the swing of {swing:.4g} {unit}", flush=True)
            if column == len(row):
                continue
            axis = row[column]
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
