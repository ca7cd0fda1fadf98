"""Figure and table of docs/understand/crack.md: `python docs/scripts/crack.py`, a minute of one core.

Gearbox 0 of the quickstart preset, healthy and with cracks of the pinion's first tooth: static mesh stiffness, and the
order spectrum of one record.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from diagnostics.signal.spectrum import OrderSpectrum, order_spectrum
from siggen.checks.loading import load_config
from siggen.columns.record import Record
from siggen.config import Config, read_yaml
from siggen.planning.specimen import draw_specimen
from siggen.record.simulation import simulate
from siggen.record.specimen_state import SpecimenState, specimen_state

FIGURE = Path(__file__).resolve().parents[1] / "figures" / "crack.png"
CONFIG = Path(__file__).resolve().parents[2] / "configs" / "quickstart.yaml"
SHARES = (0.1, 0.25, 0.4)
TORQUE_NM, TOOTH, MESHES = 60.0, 0, 3
PERFECT = ["manufacture=null", "background=null", "variation={}"]


def cracked_set(*overrides: str) -> Config:
    """Return one gearbox in all states at its rated torque."""
    states: list[dict[str, object]] = [{"name": "healthy"}]
    for share, severity in zip(SHARES, ("slight", "moderate", "severe"), strict=True):
        damage = {"kind": "crack", "depth_share": share, "teeth": [TOOTH]}
        states.append({"name": f"crack{round(100 * share)}", "severity": severity, "damage": damage})
    points = [{"speed_hz": 33.0, "torque_nm": TORQUE_NM}]
    return load_config({**read_yaml(CONFIG), "states": states, "operating_points": points, "repeats": 1}, overrides)


def records(config: Config) -> list[Record]:
    """Return the record of gearbox 0 in each state."""
    made = simulate(config, range(config.records_per_specimen))
    found = {one.planned.state_id: one for one in made if isinstance(one, Record) and one.planned.specimen_id == 0}
    return [found[state] for state in range(len(config.states))]


def spectrum_of(config: Config, record: Record, teeth: int) -> OrderSpectrum:
    """Return the order spectrum of the first channel."""
    signal = np.asarray(next(iter(record.channels.values())), dtype=np.float64)
    return order_spectrum(signal, np.asarray(record.tacho_s), config.fs_hz, teeth)


def sidebands(spectrum: OrderSpectrum, teeth: int) -> float:
    """Return the rms [m/s²] of the lines at whole orders between the mesh harmonics 1 to 10 that are none of these."""
    whole = [order for order in range(teeth // 2, 10 * teeth + teeth // 2) if order % teeth]
    lines = spectrum.amplitude_m_s2[np.array(whole) * spectrum.revolutions]
    return float(np.sqrt(0.5 * np.sum(lines**2)))


def table(states: list[SpecimenState], spectra: list[list[OrderSpectrum]], pitches: np.ndarray) -> str:
    """Return the rows of the page."""
    lines = [
        "| depth share | largest loss of stiffness | pulse [µm] | lines between mesh lines, perfect gears | as made |"
    ]
    lines.append("|---|---|---|---|---|")
    force = states[0].static.force_n(TORQUE_NM)
    sound = force / states[0].static.stiffness_n_per_m(TORQUE_NM, pitches)
    for share, state, *two in zip((0.0, *SHARES), states, *spectra, strict=True):
        pulse = (force / state.static.stiffness_n_per_m(TORQUE_NM, pitches) - sound).max()
        loss = state.static.largest_loss(TORQUE_NM) if share else 0.0
        rms = " | ".join(f"{sidebands(one, state.pair.pinion.teeth):.3f} m/s²" for one in two)
        lines.append(f"| {share:g} | {100 * loss:.1f} % | {1e6 * pulse:.2f} | {rms} |")
    return "\n".join(lines)


def draw(states: list[SpecimenState], spectra: list[list[OrderSpectrum]], pitches: np.ndarray) -> None:
    """Draw stiffness over angle, and the spectra of the healthy and the most cracked gearbox."""
    figure = Figure(figsize=(8.0, 8.0), layout="constrained")
    above, *below = figure.subplots(3, 1)
    for share, state in zip((0.0, *SHARES), states, strict=True):
        name = f"depth share {share:g}" if share else "healthy"
        above.plot(pitches, 1e-6 * state.static.stiffness_n_per_m(TORQUE_NM, pitches), label=name, lw=1.2)
    above.set(xlabel="pinion angle [base pitches since the tooth came into contact]", ylabel="force/approach [N/µm]")
    above.set(ylim=(0, None), title="static mesh stiffness")
    above.legend(fontsize=8, ncols=4, loc="lower center")
    for axes, two, title in zip(below, spectra, ("perfect gears", "gears as made, with background"), strict=True):
        for one, name, colour in ((two[-1], f"depth share {SHARES[-1]:g}", "C3"), (two[0], "healthy", "C0")):
            axes.semilogy(one.order, one.amplitude_m_s2, lw=0.6, label=name, color=colour)
        axes.set(xlim=(0, 100), ylim=(1e-4, 30), xlabel="pinion order", ylabel="acceleration [m/s²]", title=title)
        axes.legend(fontsize=8, loc="upper right")
    figure.savefig(FIGURE, dpi=110)


def main() -> None:
    """Print the table and draw the figure."""
    spectra = []
    for config in (cracked_set(*PERFECT), cracked_set()):
        specimen = draw_specimen(config, 0)
        teeth = specimen.gears.pinion.teeth
        spectra.append([spectrum_of(config, record, teeth) for record in records(config)])
    states = [specimen_state(config, specimen, number) for number in range(1 + len(SHARES))]
    pitches = np.linspace(-0.5, MESHES - 0.5, 601)
    print(table(states, spectra, pitches))
    draw(states, spectra, pitches)


if __name__ == "__main__":
    main()
