"""Ten leaks, one per layer, planted into a measured set without any: what the audit has to find, and nothing else."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from diagnostics.audit.measured_set import MeasuredSet


def labelled(clean: MeasuredSet, **columns: np.ndarray) -> MeasuredSet:
    return replace(clean, labels={**clean.labels, **columns})


def valued(clean: MeasuredSet, **columns: np.ndarray) -> MeasuredSet:
    return replace(clean, values={**clean.values, **columns})


def noise(clean: MeasuredSet) -> MeasuredSet:
    """The noise of damaged records lies 1 dB higher in one band; no label says so."""
    return valued(clean, noise_band6_db=clean.values["noise_band6_db"] + 1.0 * ~clean.healthy[:, None])


def angle(clean: MeasuredSet) -> MeasuredSet:
    """Damaged records start within a tenth of a turn after the pulse."""
    start = clean.values["start_turn"].copy()
    start[~clean.healthy] *= 0.1
    return valued(clean, start_turn=start)


def byte(clean: MeasuredSet) -> MeasuredSet:
    """Damaged records went through a converter of half the step."""
    return valued(clean, converter_step_log2=-12.0 - 1.0 * ~clean.healthy[:, None] * np.ones(len(clean.channels)))


def path(clean: MeasuredSet) -> MeasuredSet:
    """The mounting of damaged records passes 1 dB less of all above 2 kHz, noise included."""
    high = {f"noise_band{k}_db": clean.values[f"noise_band{k}_db"] - 1.0 * ~clean.healthy[:, None] for k in (7, 8, 9)}
    return valued(clean, **high)


def length(clean: MeasuredSet) -> MeasuredSet:
    """Damaged records are padded: their last hundred samples repeat."""
    return valued(clean, samples=clean.values["samples"] - 100.0 * ~clean.healthy[:, None])


def level(clean: MeasuredSet) -> MeasuredSet:
    """Damaged records were taken at a gain of three."""
    return valued(clean, rms=clean.values["rms"] * np.where(clean.healthy, 1.0, 3.0)[:, None])


def speed(clean: MeasuredSet) -> MeasuredSet:
    """Damaged records ran 0.5 % slower, whatever the label says; gearboxes differ by ten times that."""
    slower = clean.values["pulses_per_s"] * np.where(clean.healthy, 1.0, 0.995)[:, None]
    return valued(clean, pulses_per_s=slower)


def order(clean: MeasuredSet) -> MeasuredSet:
    """The files hold all healthy records first."""
    place = np.argsort(~clean.healthy, kind="stable")
    return replace(
        clean,
        labels={name: values[place] for name, values in clean.labels.items()},
        values={name: values[place] for name, values in clean.values.items()},
        waveforms=[clean.waveforms[k] for k in place],
        sketches=[clean.sketches[k] for k in place],
        checksums=clean.checksums[place],
        raw=clean.raw.of(place),
    )


def duplicate(clean: MeasuredSet) -> MeasuredSet:
    """One channel of a record was copied into a record of another state."""
    checksums = clean.checksums.copy()
    checksums[5, 1] = checksums[0, 1]
    return replace(clean, checksums=checksums)


def metadata(clean: MeasuredSet) -> MeasuredSet:
    """Two innocent columns tell the state by their sum alone."""
    rng = np.random.default_rng(2)
    first = rng.standard_normal(clean.healthy.size)
    second = np.where(clean.healthy, -0.6, 0.6) + 0.1 * rng.standard_normal(first.size) - first
    return labelled(clean, room_temperature=first, cabinet_temperature=second)


LEAKS: dict[str, Callable[[MeasuredSet], MeasuredSet]] = {
    leak.__name__: leak for leak in (noise, angle, byte, path, length, level, speed, order, duplicate, metadata)
}
FOUND_AS = {
    "noise": "state_told_by_noise",
    "angle": "state_tied_to_operating_points",
    "byte": "state_told_by_bytes",
    "path": "state_told_by_noise",
    "length": "state_tied_to_duration_s",
    "level": "slight_separable_by_rms",
    "speed": "state_told_by_metadata",
    "order": "state_told_by_order",
    "duplicate": "copied_signal",
    "metadata": "state_told_by_metadata",
}

DAMAGE_COLUMNS = (
    *("state_id", "state", "fault", "severity", "faulty_teeth_pinion"),
    *("damaged_area_mm2", "damaged_area_share", "damage_profile_length_mm", "mesh_stiffness_loss", "snr_lid_x_db"),
)


def with_permuted_states(clean: MeasuredSet, turn: int) -> MeasuredSet:
    """Return the set with states and labels of damage permuted among the records of every gearbox."""
    rng, specimen = np.random.default_rng(turn), clean.labels["specimen_id"]
    place = np.arange(specimen.size)
    for owner in np.unique(specimen):
        rows = np.flatnonzero(specimen == owner)
        place[rows] = rng.permutation(rows)
    return labelled(clean, **{name: clean.labels[name][place] for name in DAMAGE_COLUMNS})
