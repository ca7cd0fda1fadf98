"""One record twice: integrated by siggen, and by scipy from an exported model (docs/reference/exported_model.md)."""

import sys
import tempfile
from pathlib import Path

import numpy as np
from exported_law import LAWS, State, between, place_in
from scipy.integrate import solve_ivp

FIGURE = Path(__file__).resolve().parents[1] / "figures" / "exported_model.png"


def integrate(model, times, rtol=1e-6):
    """Return approach [m], mesh force [N] and, where gears tilt, tilt [rad] of every mesh at `times`.

    `rtol` of every step. The absolute tolerance is that of displacements of 1 µm (or µrad) and of 20 mm/s, such as
    vibrations of some kHz have: small coordinates must not force small steps.
    """
    n = len(model["coordinates"])
    meshes = meshes_of(model)
    inverse = np.linalg.inv(model["mass"])
    moved = -inverse @ np.hstack([model["stiffness"], model["damping"]])
    pushed = inverse @ np.vstack([mesh.pushed for mesh in meshes]).T
    drive = Drive(model, inverse)

    def rate(t, z):
        angle, speed_ratio, other = drive.at(t)
        loads = np.concatenate([mesh.loads(z, angle, speed_ratio) for mesh in meshes])
        return np.concatenate([z[n:], moved @ z - pushed @ loads + other])

    # A step must not pass over a whole engagement: a tenth of one at most.
    longest = 0.1 / (model["speed_hz"] * 2 * np.pi * max(mesh.own["pitches_per_rad"] for mesh in meshes))
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
    return [values for mesh in meshes for values in mesh.seen(times, found.y.T, drive)]


def meshes_of(model):
    """Return the meshes of a model in the order of power."""
    return [Mesh(model, number) for number in range(int(model["meshes"]))]


class Mesh:
    """One mesh: what it sees of a state, and what it pushes."""

    def __init__(self, model, number):
        beginning = f"mesh.{number}."
        own = {name.removeprefix(beginning): value for name, value in model.items() if name.startswith(beginning)}
        self.own, self.law = own, LAWS[str(model["law"])](own)
        names, p = list(model["coordinates"]), own["vector"]
        none = np.zeros(len(names))
        turn, turn_x = own.get("tilt_vector", none), own.get("tilt_friction_vector", none)
        self.tilts, self.static_tilt = "tilt_vector" in own, own.get("static_tilt_rad", 0.0)
        self.rows = np.stack([p, *own["sliding_vectors"], turn, turn_x])
        self.pushed = np.stack([p, *own["friction_vectors"], turn, turn_x])
        # Sliding speed by the rigid rotation: that of a pair at s is the first + s the second.
        turning = [name in own["rotations"] for name in names]
        speed = 2 * np.pi * model["speed_hz"] * np.where(turning, model["rolling"], 0.0)
        self.rolling = (own["sliding_vectors"] @ speed).tolist()

    @property
    def names(self):
        """What siggen calls the quantities of `seen`."""
        before = f"{self.own['name']}_" if self.own["name"] else ""
        return [before + name for name in ("approach_m", "mesh_force_n", "mesh_tilt_rad")[: 3 if self.tilts else 2]]

    def forces(self, z, angle, speed_ratio):
        """Return the forces in a state z, at an angle of the first shaft."""
        own, n = self.own, self.rows.shape[1]
        displaced, moving = (self.rows @ z[:n]).tolist(), (self.rows @ z[n:]).tolist()
        slides = [v + speed_ratio * r for v, r in zip(moving[1:3], self.rolling, strict=True)]
        tilt = self.static_tilt + displaced[3], moving[3]
        state = State(own["static_approach_m"] + displaced[0], moving[0], *slides, *tilt)
        return self.law.forces(state, angle * own["pitches_per_rad"] + own["begins_pitches"])

    def loads(self, z, angle, speed_ratio):
        """Return what acts along its rows, beyond the static force."""
        found = self.forces(z, angle, speed_ratio)
        excess = found.normal - self.own["static_force_n"]
        return [excess, found.friction, found.friction_moment, found.across, found.friction_across]

    def seen(self, times, states, drive):
        """Return approach, force and, where gears tilt, tilt."""
        moved = states[:, : self.rows.shape[1]]
        pushes = (self.forces(z, *drive.at(t)[:2]).normal for t, z in zip(times, states, strict=True))
        found = [self.own["static_approach_m"] + moved @ self.rows[0], np.array([*pushes])]
        return [*found, self.static_tilt + moved @ self.rows[3]] if self.tilts else found


class Drive:
    """The first pinion's angle, its speed over the nominal one, and accelerations by other forces."""

    def __init__(self, model, inverse):
        self.model, self.none = model, np.zeros(len(inverse))
        if "inputs" in model:
            self.pushed = inverse @ model["input_vectors"].T

    def at(self, t):
        """Return all three at a time; what varies is linear between the steps of siggen."""
        model = self.model
        if "inputs" not in model:
            return model["start_angle_rad"] + 2 * np.pi * model["speed_hz"] * t, 1.0, self.none
        cell, weight = place_in(len(model["angle_rad"]), (t - model["start_s"]) / model["step_s"])
        inputs = between(model["inputs"], cell, weight)
        ratio = 1.0 if model["speed_input"] < 0 else 1.0 + inputs[model["speed_input"]]
        return between(model["angle_rad"], cell, weight), ratio, self.pushed @ inputs


def compare(config, overrides, samples=600, record=0, rtol=1e-6):
    """Return times [s], then approach [m], mesh force [N] and tilt [rad] of every mesh by siggen and by scipy."""
    from siggen.checks.loading import load_config
    from siggen.config import by_reference
    from siggen.gearbox.plan import planned_record
    from siggen.record.internals import internals_table
    from siggen.views.exported_model import exported_model, write_model

    fs_hz = load_config(config, overrides).fs_hz
    loaded = load_config(config, [*overrides, f"duration_s={samples / fs_hz}"])
    if loaded.config.dynamics.mesh.law == "pairs":  # the same steps in both: Runge-Kutta
        loaded = loaded.with_sections(dynamics=by_reference(loaded.config.dynamics))
    planned = planned_record(loaded, record)
    drawn = loaded.gearbox(planned.specimen_id), planned
    with tempfile.TemporaryDirectory() as folder:
        write_model(exported_model(*drawn), Path(folder) / "model.npz")
        with np.load(Path(folder) / "model.npz") as file:
            model = {name: value[()] for name, value in file.items()}  # [()]: plain numbers instead of 0-d arrays
    inner = internals_table(*drawn)
    times = np.arange(samples) / model["fs_hz"]
    own = tuple(inner[name].to_numpy() for mesh in meshes_of(model) for name in mesh.names)
    return times, own, integrate(model, times, rtol)


IDEAL = ["manufacture=null", "dynamics.shafts=null"]
SPALL = (
    "states.spalled_through.damage={kind: spall, gear: pinion, teeth: 1, centre_height_mm: pitch, "
    "face_length_mm: 20.0, depth_mm: 0.2, profile_length_mm: [0.8, 1.0]}"
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
