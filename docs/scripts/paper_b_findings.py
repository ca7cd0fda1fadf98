"""Figures and tables of docs/understand/paper_b.md: speed, severity, friction and lubrication of its gearbox."""

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from siggen.checks.loading import load_config
from siggen.config import read_yaml
from siggen.gearbox.plan import planned_record
from siggen.record.quantities import internal_quantities
from siggen.record.simulation import record_response
from siggen.record.specimen_state import specimen_state
from siggen.views.modes import kinetic_shares, specimen_modes

FIGURES = Path(__file__).resolve().parents[1] / "figures"
CONFIG = Path(__file__).resolve().parents[2] / "configs" / "paper_b.yaml"
TEETH, GEAR_TEETH, SPEED_HZ, TORQUE_NM = 18, 47, 30.0, 30.0
PRESSURE_ANGLE = np.radians(20.0)
LID = {axis: f"clean_accel_casing_lid_{axis}_m_s2" for axis in ("vertical", "horizontal")}
BEARING = {axis: f"bearing_force_pinion_bearing_{axis}_n" for axis in ("vertical", "horizontal")}

# Perfect gears on stiff shafts, so that nothing but the damage shows beside the mesh lines; the
# middles of the ranges of configs/paper_b.yaml; bearings with 3 %, bolts with 4 % of critical damping.
CONSTANTS = [
    "specimens=1", "manufacture=null", "dynamics.shafts=null",
    "dynamics.mesh_damping_ratio=0.07", "dynamics.backlash_um=80", "dynamics.mesh.tip_relief_um=8",
    *(f"dynamics.{gear}.bearing.stiffness_n_per_m=2e8" for gear in ("pinion", "gear")),
    "dynamics.pinion.bearing.damping_n_s_per_m=850",
    "dynamics.gear.bearing.damping_n_s_per_m=1470",
    "housing.bolts.shear_stiffness_n_per_m=8e7", "housing.bolts.axial_stiffness_n_per_m=1.5e8",
    "housing.bolts.damping_ratio=0.04", "dynamics.mesh.structure_damping_ratio=0.04",
    "dynamics.mesh.film_damping_ratio=0.02", "dynamics.mesh.asperity_damping_ratio=0.055",
    "dynamics.friction.oil_temperature_c=50", "dynamics.friction.roughness_um=0.4",
    "dynamics.friction.pit_roughness_um=2.0", "dynamics.friction.boundary_friction=0.09",
]  # fmt: skip


def pits(count, spread_mm, severity, milder=None):
    """Return a state with round pits of 0.4 mm about the pitch line of tooth 0, and those of a milder one."""
    damage = {
        "kind": "clustered", "gear": "pinion", "teeth": [0], "count": count, "centre_height_mm": "pitch",
        "spread_profile_mm": spread_mm, "semi_axis_face_mm": 0.4, "semi_axis_profile_mm": 0.4, "depth_mm": 0.25,
        "floor": "dish",
    }  # fmt: skip
    return {"name": severity, "grows": milder, "damage": damage}


def spall(name, length_mm, width_mm):
    """Return a state with a rectangular spall on the pitch line of tooth 0, 0.2 mm deep."""
    damage = {
        "kind": "spall", "gear": "pinion", "teeth": [0], "centre_height_mm": "pitch", "depth_mm": 0.2,
        "profile_length_mm": length_mm, "face_length_mm": width_mm,
    }  # fmt: skip
    return {"name": name, "severity": "severe", "damage": damage}


HEALTHY = {"name": "healthy"}
PITTED = [
    pits(9, 0.3, "slight"),
    pits(18, 0.35, "moderate", "slight"),
    pits(36, 0.4, "severe", "moderate"),
]  # each holds the one before
PARTIAL, THROUGH = spall("spall_half_face", 1.5, 10.0), spall("through_1_0_mm", 1.0, 20.0)
SEVERITIES = [
    HEALTHY, *PITTED, PARTIAL,
    *(spall(f"through_{name}_mm", length, 20.0) for name, length in
      (("0_5", 0.5), ("0_8", 0.8), ("1_0", 1.0), ("1_5", 1.5))),
]  # fmt: skip


def said(name):
    """Return the name of a state in words."""
    words = {"spall_half_face": "spall 1.5 mm, half the face"}
    words |= {name: f"{name} pits" for name in ("slight", "moderate", "severe")}
    return words.get(name) or (
        f"spall {name[8:11].replace('_', '.')} mm through the face" if "through" in name else name
    )


def by_name(states):
    """Return states as a file gives them."""
    return {one["name"]: {key: value for key, value in one.items() if key != "name"} for one in states}


def runs(states, speeds_hz, duration_s, *overrides, fs_hz=54000.0):
    """Yield state, speed, rate and quantities by name of every record."""
    points = [{"speed_hz": speed, "torque_nm": TORQUE_NM} for speed in speeds_hz]
    raw = {
        **read_yaml(CONFIG),
        "states": by_name(states),
        "operating_points": points,
        "duration_s": duration_s,
        "fs_hz": fs_hz,
    }
    config = load_config(raw, [*CONSTANTS, "mesh_harmonics=5", *overrides])
    specimen = config.gearbox(0)
    for index, state in enumerate(states):
        built = specimen_state(specimen, index)
        for place, speed in enumerate(speeds_hz):
            record = planned_record(config, index * len(speeds_hz) + place)
            response, _ = record_response(specimen, built, record, internals=True)
            quantities = internal_quantities(specimen, response)
            quantities["angle_rad"], quantities["lost"] = response.angle_rad, response.contact_loss_share
            yield state["name"], speed, quantities


def revolution(signal):
    """Return one revolution, from tooth 0 on, as the mean over all; the records hold whole ones of 1800 samples."""
    return signal.reshape(-1, round(54000 / SPEED_HZ)).mean(axis=0)


def aligned(quantities, name):
    """Return one revolution of a quantity from the entry of tooth 0 on."""
    samples = round(54000 / SPEED_HZ)
    start = round(-quantities["angle_rad"][0] / (2.0 * np.pi) * samples) % samples
    return np.roll(revolution(quantities[name]), -start)


def without_mesh(one_revolution):
    """Return what does not repeat from tooth to tooth: the revolution without its mesh harmonics."""
    lines = np.fft.rfft(one_revolution)
    lines[::TEETH] = 0.0
    return np.fft.irfft(lines, one_revolution.size)


def rms(signal):
    """Return the root mean square about the mean."""
    return float(np.std(signal))


def along(quantities, names):
    """Return a vector's components along the line of action and across it, from vertical and horizontal."""
    vertical, horizontal = aligned(quantities, names["vertical"]), aligned(quantities, names["horizontal"])
    c, s = np.cos(PRESSURE_ANGLE), np.sin(PRESSURE_ANGLE)
    return c * vertical - s * horizontal, c * horizontal + s * vertical


def order_amplitudes(signal, angle_rad, orders):
    """Return single-sided amplitudes at orders of the shaft, by a Hann window over the record."""
    window = np.hanning(signal.size)
    weighted = (signal - signal.mean()) * window * (2.0 / window.sum())
    return np.abs(np.exp(-1j * np.outer(orders, angle_rad)) @ weighted)


def modes():
    """Return frequencies and names of the modes by what moves most, as `siggen inspect modes` lists them."""
    config = load_config(CONFIG, CONSTANTS)
    found = specimen_modes(config.gearbox(0))
    shares = kinetic_shares(found)
    names = [" ".join(found.coordinates[i] for i in np.argsort(-row)[:2] if row[i] > 0.2) for row in shares]
    print("\n| mode | frequency [Hz] | share of the mesh | moves most |\n|---|---|---|---|")
    for i, frequency in enumerate(found.modes.frequency_hz):
        print(f"| {i} | {frequency:.1f} | {found.modes.mesh_share[i]:.2f} | {names[i]} |")
    return list(zip(found.modes.frequency_hz[1:], names[1:], strict=True))


def speed_sweep():
    """Draw amplitudes over order and speed, and the mesh orders over their frequency."""
    speeds, orders = np.arange(10.0, 50.01, 0.5), np.arange(1, 163)
    maps = {name: np.zeros((speeds.size, orders.size)) for name in ("healthy", "through_1_0_mm")}
    level = {name: np.zeros(speeds.size) for name in maps}
    for name, speed, quantities in runs([HEALTHY, THROUGH], list(speeds), 0.5):
        row = int(np.flatnonzero(speeds == speed)[0])
        signal = quantities[LID["vertical"]]
        maps[name][row], level[name][row] = order_amplitudes(signal, quantities["angle_rad"], orders), rms(signal)
    named = modes()
    figure = Figure(figsize=(9.5, 11), layout="constrained")
    axes = figure.subplots(3, 1, height_ratios=(1, 1, 1))
    for axis, (name, amplitudes) in zip(axes, maps.items(), strict=False):
        shown = 20.0 * np.log10(np.maximum(amplitudes, 1e-4))
        mesh = axis.pcolormesh(
            orders, speeds, shown, cmap="magma_r", vmin=-60, vmax=20, shading="nearest", rasterized=True
        )
        for frequency, _ in named:
            axis.plot(frequency / speeds, speeds, color="tab:cyan", lw=0.9, ls="--")
        axis.set(
            xlim=(0.5, 162.5),
            ylim=(10, 50),
            ylabel="speed of the pinion [Hz]",
            xlabel="order of the pinion shaft",
            title=f"{said(name)}: casing, vertical; dashed: natural frequencies",
            xticks=TEETH * np.arange(1, 10),
        )
        figure.colorbar(mesh, ax=axis, label="amplitude [dB re 1 m/s²]")
    for harmonic in range(1, 6):
        axes[2].plot(
            harmonic * TEETH * speeds,
            maps["healthy"][:, harmonic * TEETH - 1],
            lw=1.4,
            label=f"order {harmonic * TEETH}",
        )
    for frequency, name in named:
        if 150 < frequency < 4500:
            axes[2].axvline(frequency, color="gray", lw=0.8, ls="--")
            aside = 0.985 if abs(frequency - 1397) < 10 else 1.015 if abs(frequency - 1428) < 10 else 1.0
            axes[2].text(
                frequency * aside,
                1.02,
                f"{frequency:.0f} {name}",
                rotation=90,
                ha="center",
                va="bottom",
                fontsize=7,
                transform=axes[2].get_xaxis_transform(),
            )
    axes[2].set(
        xlabel="frequency of the mesh harmonic [Hz]",
        ylabel="amplitude [m/s²]",
        yscale="log",
        xscale="log",
        xlim=(180, 4500),
        xticks=[200, 300, 500, 1000, 2000, 4000],
        xticklabels=[200, 300, 500, 1000, 2000, 4000],
    )
    axes[2].xaxis.set_minor_formatter(NullFormatter())
    axes[2].legend(ncols=5, fontsize=8)
    axes[2].grid(alpha=0.3)
    figure.savefig(FIGURES / "paper_b_speed.png", dpi=120)
    print("\n| rms of the casing, vertical [m/s²], at | " + " | ".join(f"{v:g} Hz" for v in speeds[::20]) + " |")
    print("|---|" + "---|" * speeds[::20].size)
    for name, values in level.items():
        print(f"| {said(name)} | " + " | ".join(f"{v:.3g}" for v in values[::20]) + " |")
    for name, values in level.items():
        print(
            f"{said(name)}: largest rms {values.max():.3g} m/s² at {speeds[values.argmax()]} Hz, "
            f"least {values.min():.3g} at {speeds[values.argmin()]} Hz"
        )


def severity_sweep():
    """Draw one revolution and its orders for every state; print levels, with damage as geometry alone besides."""
    found = {name: q for name, _, q in runs(SEVERITIES, [SPEED_HZ], 0.5)}
    alone = {name: q for name, _, q in runs(SEVERITIES, [SPEED_HZ], 0.5, "dynamics.mesh.damage=geometry")}
    print(
        "\n| state | rms [m/s²] | without mesh lines: rms, peak [m/s²] | horizontal: rms | "
        "geometry alone, vertical: rms | kurtosis | "
        "orders 10-26 but 18 [m/s²] | orders 28-44 but 36 | mesh force [N] | contact lost |\n"
        "|---|---|---|---|---|---|---|---|---|---|"
    )
    figure = Figure(figsize=(9.5, 14), layout="constrained")
    axes = figure.subplots(len(found), 2, sharex="col")
    milliseconds = np.arange(1800) / 54.0
    for row, (name, q) in zip(axes, found.items(), strict=True):
        signal = aligned(q, LID["vertical"])
        rest, force = without_mesh(signal), aligned(q, "mesh_force_n")
        lines = 2.0 * np.abs(np.fft.rfft(signal)) / signal.size
        bands = [np.sqrt((lines[[h * TEETH + k for k in range(-8, 9) if k]] ** 2).sum()) for h in (1, 2)]
        kurtosis = (rest**4).mean() / (rest**2).mean() ** 2 if rms(rest) > 1e-6 else np.nan
        across = rms(without_mesh(aligned(q, LID["horizontal"])))
        bare = rms(without_mesh(aligned(alone[name], LID["vertical"])))
        print(
            f"| {said(name)} | {rms(signal):.3g} | {rms(rest):.2g}, {np.abs(rest).max():.2g} | {across:.2g} | "
            f"{bare:.2g} | {kurtosis:.3g} | {bands[0]:.2g} | "
            f"{bands[1]:.2g} | {force.min():.0f} to {force.max():.0f} | {q['lost']:.2%} |"
        )
        row[0].plot(milliseconds, signal, color="tab:blue", lw=0.7, label="signal")
        row[0].plot(milliseconds, rest, color="tab:red", lw=0.9, label="without mesh harmonics")
        row[0].set(ylabel="[m/s²]", xlim=(0, 1000 / SPEED_HZ))
        row[0].set_title(said(name), fontsize=9, loc="left")
        orders = np.arange(1, 150)
        mesh = orders % TEETH == 0
        shown = np.maximum(lines[orders], 1e-6)
        row[1].vlines(orders[~mesh], 1e-6, shown[~mesh], color="tab:red", lw=1.0)
        row[1].vlines(orders[mesh], 1e-6, shown[mesh], color="tab:blue", lw=1.6)
        row[1].set(yscale="log", ylim=(1e-5, 30), xlim=(0, 150), xticks=TEETH * np.arange(9))
        for axis in row:
            axis.grid(alpha=0.3)
    axes[0, 0].legend(fontsize=7, ncols=2, loc="upper right")
    axes[-1, 0].set_xlabel("time after tooth 0 enters contact [ms]; one revolution")
    axes[-1, 1].set_xlabel("order of the pinion shaft; blue: mesh; amplitude [m/s²]")
    figure.suptitle("casing, vertical acceleration at 30 Hz, 30 N m", fontsize=11)
    figure.savefig(FIGURES / "paper_b_severity.png", dpi=110)


def levels():
    """Print the level of the casing by state at two more speeds, with rough land about damage and without."""
    states, speeds = [HEALTHY, *PITTED, PARTIAL, THROUGH], [15.0, 35.0]
    print("\n| casing, both axes [m/s² rms] | " + " | ".join(said(state["name"]) for state in states) + " |")
    print("|---" * (len(states) + 1) + "|")
    for title, overrides in (("", ()), (", lands as smooth as the flank", ("dynamics.friction.pit_roughness_um=0.4",))):
        found = {(name, v): q for name, v, q in runs(states, speeds, 0.5, *overrides)}
        for v in speeds:
            both = (np.hypot(*(rms(found[state["name"], v][LID[axis]]) for axis in LID)) for state in states)
            print(f"| {v:g} Hz{title} | " + " | ".join(f"{level:.3g}" for level in both) + " |")


def friction_models():
    """Draw bearing force and casing by friction model, healthy and spalled; print their levels."""
    damped = "dynamics.mesh.damping=constant"
    models = {
        "off": ("dynamics.friction.model=off", damped),
        "constant 0.05": ("dynamics.friction.model=constant", "dynamics.friction.coefficient=0.05", damped),
        "mixed_ehl": (damped,),
        "mixed_ehl, damping by asperity share": (),
    }
    states = [HEALTHY, *PITTED, THROUGH]
    print(
        "\n| friction | state | bearing force along; across [N rms] | casing along; across [m/s² rms] | "
        "vertical; horizontal | "
        "without mesh lines, vertical; horizontal |\n|---|---|---|---|---|---|"
    )
    figure = Figure(figsize=(9.5, 10), layout="constrained")
    axes = figure.subplots(4, 2, sharex=True, sharey="row")
    milliseconds = np.arange(1800) / 54.0
    colours = dict(zip(models, ("black", "tab:orange", "tab:blue", "tab:green"), strict=True))
    for model, overrides in models.items():
        for name, _, q in runs(states, [SPEED_HZ], 0.5, *overrides):
            if name in ("slight", "moderate"):
                continue
            force, casing = along(q, BEARING), along(q, LID)
            screen = [aligned(q, LID[axis]) for axis in ("vertical", "horizontal")]
            numbers = [(rms(a), rms(b)) for a, b in (force, casing, screen)]
            numbers.append(tuple(rms(without_mesh(part)) for part in screen))
            print(f"| {model} | {said(name)} | " + " | ".join(f"{a:.3g}; {b:.3g}" for a, b in numbers) + " |")
            column = {"healthy": 0, "through_1_0_mm": 1}.get(name)
            if column is None or "damping" in model:
                continue
            for row, part in enumerate((force[0], force[1], *casing)):
                axes[row, column].plot(milliseconds, part, color=colours[model], lw=1.0, label=model)
                axes[row, column].grid(alpha=0.3)
    labels = (
        "bearing force\nalong the line of action [N]",
        "bearing force\nacross it [N]",
        "casing along\nthe line of action [m/s²]",
        "casing\nacross it [m/s²]",
    )
    for row, label in zip(axes, labels, strict=True):
        row[0].set_ylabel(label)
    axes[0, 0].set(title="healthy", xlim=(0, 8))
    axes[0, 1].set_title(said("through_1_0_mm"))
    for axis in axes[-1]:
        axis.set_xlabel("time after tooth 0 enters contact [ms]")
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=3, title="friction")
    figure.savefig(FIGURES / "paper_b_friction.png", dpi=110)


LUBRICATION = {
    "load_share": ("load share", 1.0), "hertz_pressure_pa": ("Hertz pressure [GPa]", 1e-9),
    "central_film_m": ("central film [µm]", 1e6), "film_ratio": ("film ratio Λ", 1.0),
    "asperity_share": ("asperity share of the load", 1.0), "friction_coefficient": ("friction coefficient", 1.0),
}  # fmt: skip


def engagement(quantities):
    """Return place (s - s_P in mm) and contact quantities over the last whole engagement of tooth 0."""
    slots = len({name.split("_")[1] for name in quantities if name.startswith("pair_")})
    pitches = quantities["angle_rad"] * TEETH / (2.0 * np.pi)
    pair = TEETH * int(np.floor((pitches[-1] - 2.0) / TEETH))
    slot = pair % slots
    chosen = (pitches > pair - 0.1) & (pitches < pair + 1.74)
    position = quantities[f"pair_{slot}_position_m"][chosen]
    pressed = quantities[f"pair_{slot}_hertz_pressure_pa"][chosen] > 0.0
    values = {key: quantities[f"pair_{slot}_{key}"][chosen] * scale for key, (_, scale) in LUBRICATION.items()}
    pitch_point_mm = 0.5 * 3.0 * TEETH * np.sin(PRESSURE_ANGLE)
    return 1e3 * position - pitch_point_mm, {key: np.where(pressed, v, np.nan) for key, v in values.items()}


def lubrication():
    """Draw contact quantities over one engagement of tooth 0; print them at the pitch point and their extremes."""
    figure = Figure(figsize=(9.5, 9), layout="constrained")
    axes = figure.subplots(3, 2, sharex=True)
    print("\n| state | " + " | ".join(f"{label}: least, mean, largest" for label, _ in LUBRICATION.values()) + " |")
    print("|---|" + "---|" * len(LUBRICATION))
    for name, _, q in runs([HEALTHY, *PITTED, PARTIAL, THROUGH], [SPEED_HZ], 0.1, fs_hz=216000.0):
        if name in ("slight", "moderate"):
            continue
        place, values = engagement(q)
        inner = np.abs(place) < 3.5  # single contact and the damage, without the lightly loaded ends
        cells = (
            f"{np.nanmin(v[inner]):.3g}, {np.nanmean(v[inner]):.3g}, {np.nanmax(v[inner]):.3g}" for v in values.values()
        )
        print(f"| {said(name)} | " + " | ".join(cells) + " |")
        for axis, (key, (label, _)) in zip(axes.flat, LUBRICATION.items(), strict=True):
            axis.plot(place, values[key], lw=1.3, label=said(name))
            axis.set_ylabel(label)
            axis.grid(alpha=0.3)
    axes[1, 0].set_ylim(0, 3)
    for axis in axes[-1]:
        axis.set_xlabel("contact along the line of action, from the pitch point [mm]")
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=4)
    figure.savefig(FIGURES / "paper_b_lubrication.png", dpi=110)


if __name__ == "__main__":
    for part in (speed_sweep, severity_sweep, levels, friction_models, lubrication):
        part()
    sys.exit(0)
