"""Tables of docs/understand/manufacturing_errors.md: sidebands and mesh force of healthy gears by class at 30 N m."""

from collections.abc import Iterator

import numpy as np

from siggen.checks.loading import load_config
from siggen.config import Config
from siggen.planning.plan import planned_record
from siggen.planning.specimen import draw_specimen
from siggen.record.simulation import record_response
from siggen.record.specimen_state import specimen_state

PINION, GEAR = 47, 18
"""Revolutions in the hunting period, which a record lasts: the lines of both shafts are bins of its spectrum."""
MESH = 18 * 47
SPECIMENS = 12
CLASSES = ("6", "7", "8")
SHARES = ("", ", tolerance_share: 1.0")


def config(accuracy_class: str, share: str) -> Config:
    """Return healthy gearboxes with casing and without friction, turning at 30 Hz for one hunting period."""
    return load_config(
        "configs/paper_b.yaml",
        [
            f"specimens={SPECIMENS}", "fs_hz=54000.0", f"duration_s={PINION / 30!r}", "mesh_harmonics=5",
            "operating_points=[{speed_hz: 30.0, torque_nm: 30.0}]", "states=[{name: healthy}]",
            "dynamics.friction.model=off",
            "dynamics.mesh.damping=constant", "dynamics.shafts=null",
            f"manufacture={{accuracy_class: {accuracy_class}{share}}}",
        ],
    )  # fmt: skip


def measured(chosen: Config) -> Iterator[tuple[float, ...]]:
    """Yield, per specimen: first sidebands over mesh 1 of pinion and gear [dB], rms, least and largest force, lost."""
    for specimen_id in range(SPECIMENS):
        specimen = draw_specimen(chosen, specimen_id)
        state = specimen_state(chosen, specimen, 0)
        response, _ = record_response(chosen, specimen, state, planned_record(chosen, specimen_id), internals=True)
        vertical = next(a for place, a in response.acceleration_m_s2.items() if place == "casing_lid/vertical")
        lines = 20.0 * np.log10(np.abs(np.fft.rfft(vertical)))
        first = [float(np.mean(lines[[MESH - n, MESH + n]]) - lines[MESH]) for n in (PINION, GEAR)]
        force = response.internals["mesh_force_n"]
        yield *first, float(vertical.std()), force.min(), force.max(), response.contact_loss_share


def main() -> None:
    """Print the table."""
    print("| class, share | pinion 1x [dB] | gear 1x [dB] | rms [m/s²] | mesh force [N] | lose contact | time lost |")
    print("|---|---|---|---|---|---|---|")
    for share in SHARES:
        for accuracy_class in CLASSES:
            found = np.array(list(measured(config(accuracy_class, share))))
            median, low, high = np.median(found, axis=0), found.min(axis=0), found.max(axis=0)
            cells = [f"{median[i]:.0f} ({low[i]:.0f} to {high[i]:.0f})" for i in (0, 1)]
            lost = f"{np.count_nonzero(found[:, 5])} of {SPECIMENS} | {high[5]:.2%}"
            name = "1.0" if share else "0.3-0.5"
            force = f"{low[3]:.0f} to {high[4]:.0f}"
            print(f"| {accuracy_class}, {name} | {' | '.join(cells)} | {median[2]:.1f} | {force} | {lost} |")


if __name__ == "__main__":
    main()
