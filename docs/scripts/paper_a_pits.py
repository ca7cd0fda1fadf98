"""Figures and numbers of docs/understand/paper_a.md: severity, position and size of pits on the pair of paper_a."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from siggen.checks.loading import load_config
from siggen.damage.part import pits_of
from siggen.gearbox.design import SetDesign
from siggen.mesh.sections import contact_length_loss
from siggen.record.teeth import all_teeth
from siggen.views.flank import flank_damage_table, flank_views, save_flank_figure
from siggen.views.stiffness import StiffnessCurve, stiffness_curves

FIGURES = Path(__file__).resolve().parents[1] / "figures"
PAPER = "configs/paper_a.yaml"
STATES = ("healthy", "slight", "moderate", "severe")
Cases = dict[str, tuple[SetDesign, str]]


def varied(state: str, key: str, value: float) -> SetDesign:
    """Return the paper's set with one size of one state changed; that state keeps no pits of a milder one."""
    milder = STATES[STATES.index(state) - 1]
    alone = [f"states.{state}.grows=null", f"states.{state}.like={milder}"]
    return load_config(PAPER, [f"states.{state}.damage.{key}={value}", *alone])


def sweep(symbol: str, key: str, values: tuple[float, ...], state: str = "moderate") -> Cases:
    """Return one case per value of a size."""
    return {f"{state}, {symbol} = {value} mm": (varied(state, key, value), state) for value in values}


def scattered(half_mm: float) -> SetDesign:
    """Return the paper's set with 48 pits of the severe state scattered about the pitch line, alike for all sizes."""
    damage = (
        f"{{kind: clustered, count: 48, spread_profile_mm: 0.4, semi_axis_face_mm: 0.3, "
        f"semi_axis_profile_mm: {half_mm}, depth_mm: 0.4}}"
    )
    return load_config(PAPER, [f"states.severe.damage={damage}", "states.severe.grows=null"])


GROUPS: dict[str, Cases] = {
    "severity": {state: (load_config(PAPER), state) for state in STATES[1:]},
    "position": sweep("μ", "first_height_mm", (1.0, 1.9, 2.8, 3.7, 4.6)),
    "face": sweep("a", "semi_axis_face_mm", (0.2, 0.3, 0.4, 0.5)),
    "profile": sweep("b", "semi_axis_profile_mm", (0.1, 0.2, 0.3, 0.4)),
    "profile_severe": sweep("b", "semi_axis_profile_mm", (0.1, 0.2, 0.3, 0.4), "severe"),
    "profile_scattered": {f"scattered, b = {b} mm": (scattered(b), "severe") for b in (0.1, 0.2, 0.3, 0.4)},
}


def curves(config: SetDesign, state: str) -> tuple[StiffnessCurve, StiffnessCurve]:
    """Return the healthy curve and that of a state, 1/200 degree apart."""
    found = {c.state: c for c in stiffness_curves(config.gearbox(0), points_per_pitch=4000)}
    return found["healthy"], found[state]


def contact_extent(config: SetDesign, state: str) -> tuple[float, float, float]:
    """Return first and last pinion angle at which the contact meets pits [deg], and the largest lost length [mm]."""
    teeth = all_teeth(config.gearbox(0))[0]
    pair, damage = teeth.pair, teeth.damage(STATES.index(state))
    pits = pits_of(damage, "pinion", damage[0].tooth)
    ends = [p.height_m + sign * p.semi_axis_profile_m for p in pits for sign in (-1, 1)]
    gear = pair.pinion
    roll = gear.roll_at_height(np.clip([min(ends), max(ends)], 0.0, float(gear.height_m(gear.tip_roll_rad))))
    first, last = np.degrees(roll - pair.contact_start_m / gear.base_radius_m)
    heights = np.linspace(min(ends), max(ends), 4001)
    return float(first), float(last), 1e3 * float(contact_length_loss(pits, pair.face_width_m, heights).max())


def row(name: str, config: SetDesign, state: str) -> str:
    """Return one line of the table."""
    healthy, pitted = curves(config, state)
    loss = healthy.mesh_stiffness_n_per_m - pitted.mesh_stiffness_n_per_m
    degrees = np.degrees(healthy.angle_rad)
    first, last, length = contact_extent(config, state)
    area = flank_views(config.gearbox(0), state=state)[0].area_mm2
    behind = loss[(degrees > last + 0.01) & (degrees < 32.7)].max(initial=0.0)
    softer = np.nanmax(pitted.parts_m_per_n["contact"] - healthy.parts_m_per_n["contact"])
    relative = 100 * (loss / healthy.mesh_stiffness_n_per_m).max()
    cells = (
        f"{flank_damage_table(config.gearbox(0), state=state).num_rows}",
        f"{area:.2f}",
        f"{length:.2f}",
        f"{loss.max() / 1e6:.2f}",
        f"{relative:.2f}",
        f"{degrees[loss.argmax()]:.2f}",
        f"{first:.2f} to {last:.2f}",
        f"{behind / 1e6:.3f}",
        f"{1e11 * softer:.3f}",
    )
    return f"| {name} | " + " | ".join(cells) + " |"


def draw(cases: Cases, path: Path) -> None:
    """Draw mesh stiffness above and its loss against healthy below, while the pitted tooth is in contact."""
    figure = Figure(figsize=(8.0, 6.2), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True)
    for number, (name, (config, state)) in enumerate(cases.items()):
        healthy, pitted = curves(config, state)
        degrees = np.degrees(healthy.angle_rad)
        if number == 0:
            above.plot(degrees, healthy.mesh_stiffness_n_per_m / 1e8, color="black", lw=1.0, label="healthy", zorder=20)
        colour = f"C{number}"
        # The mildest case lies on top, so that it is seen where cases agree.
        above.plot(degrees, pitted.mesh_stiffness_n_per_m / 1e8, color=colour, lw=1.4, label=name, zorder=10 - number)
        loss = healthy.mesh_stiffness_n_per_m - pitted.mesh_stiffness_n_per_m
        below.plot(degrees, loss / 1e6, color=colour, lw=1.4, zorder=10 - number)
    above.set_ylabel("mesh stiffness [10⁸ N/m]")
    below.set_ylabel("loss against healthy [10⁶ N/m]")
    below.set_xlabel("pinion angle since the pitted tooth entered contact [°]")
    below.set_xlim(0, 33)
    below.set_ylim(bottom=0)
    for axis in (above, below):
        axis.grid(alpha=0.3)
    figure.legend(
        *above.get_legend_handles_labels(), loc="outside upper center", frameon=False, ncols=4 if len(cases) == 3 else 3
    )
    figure.savefig(path, dpi=110)


def main() -> None:
    """Draw all figures and print the table."""
    FIGURES.mkdir(exist_ok=True)
    for group, cases in GROUPS.items():
        draw(cases, FIGURES / f"paper_a_{group}.png")
    save_flank_figure(flank_views(load_config(PAPER).gearbox(0)), FIGURES / "paper_a_flanks.png")
    print(
        "| case | pits | area [mm²] | largest lost contact length [mm] | largest ΔK [10⁶ N/m] | largest ΔK/K [%] "
        "| largest ΔK at [°] | contact on pits [°] | largest ΔK behind them [10⁶ N/m] "
        "| largest Δ(1/k) of the contact [10⁻¹¹ m/N] |"
    )
    print("|---" * 10 + "|")
    for cases in GROUPS.values():
        for name, (config, state) in cases.items():
            print(row(name, config, state))


if __name__ == "__main__":
    main()
