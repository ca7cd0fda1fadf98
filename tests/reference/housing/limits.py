"""Limit cases over many drawn housings: what cancels, what infinite plates do, what seats give way, what is coupled."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from siggen.dynamics.housing.box import Axis, Box
from siggen.dynamics.housing.housing_modes import WAVES, HousingModes, housing_modes, resolved_hz
from siggen.dynamics.housing.motion import Motion, Place, box_motions, motion_at
from siggen.dynamics.housing.plate_energy import sheet
from tests.reference.housing.drawn_boxes import drawn_box
from tests.reference.housing.solid_comparison import refinement_levels
from tests.reference.housing.third_octaves import DAMPING, centres_hz, distance, lines_hz

BOXES = 20
BEARINGS_N_PER_M = 2.5e8
"""Both ball bearings of a shaft (assumed)."""
BANDS = ((50.0, 1000.0), (20.0, 160.0), (160.0, 400.0), (400.0, 1000.0), (1000.0, 2500.0), (2500.0, 8000.0))


def boxes() -> list[Box]:
    """Return the drawn housings."""
    rng = np.random.default_rng(11)
    return [drawn_box(rng) for _ in range(BOXES)]


def limits_table() -> Iterator[str]:
    """Yield rows of quantity: least, median, most over the boxes."""
    found: dict[str, list[float]] = {}
    for box in boxes():
        modes = housing_modes(box, 12_000.0, 1.5 * WAVES)
        for name, number in _quantities(box, modes).items():
            found.setdefault(name, []).append(number)
    yield "quantity | least | median | most"
    for name, numbers in found.items():
        yield f"{name} | {min(numbers):.3g} | {np.median(numbers):.3g} | {max(numbers):.3g}"


def _quantities(box: Box, modes: HousingModes) -> dict[str, float]:
    damping = np.full(modes.frequency_hz.size, DAMPING)
    of_shafts = {(shaft, axis): on_both(box, modes, shaft, axis) for shaft in box.seats for axis in "xy"}
    found = {
        "mass [kg]": box.mass_kg,
        "resolved frequency [Hz]": resolved_hz(box),
        "seventh mode [Hz]": float(modes.frequency_hz[6]),
        "seats of a shaft beyond six modes over its bearings": _elastic(modes, list(of_shafts.values())),
        "conductance of the lid over an infinite plate's, 2-9 kHz": _conductance(box, modes, damping),
    }
    place = _lid(box, modes, (0.6, 0.35))
    for low, high in BANDS:
        frequency = np.geomspace(low, high, 600)
        for axis, word in (("x", "horizontal"), ("y", "vertical")):
            gear, pinion = of_shafts["gear", axis], of_shafts["pinion", axis]
            levels = modes.accelerance([place], [gear, pinion, gear.plus(pinion, -1.0)], frequency, damping)[0]
            power = (np.abs(levels) ** 2).mean(axis=1)
            if axis == "y":
                found[f"lid from one shaft, {low:.0f}-{high:.0f} Hz [dB]"] = 10.0 * np.log10(power[1])
            found[f"opposed {word} pair, {low:.0f}-{high:.0f} Hz [dB]"] = 10.0 * np.log10(
                power[2] / (power[0] + power[1])
            )
    found |= _coupling(box, modes, list(of_shafts), damping)
    return found


def on_both(box: Box, modes: HousingModes, shaft: str, axis: str) -> Motion:
    """Return half a force on either seat of a shaft."""
    motions = box_motions(box, modes.halves)
    front, back = (motions[f"{shaft}/{wall}/{axis}"] for wall in ("front", "back"))
    return Motion(0.5 * (front.even + back.even), 0.5 * (front.odd + back.odd))


def _lid(box: Box, modes: HousingModes, shares: tuple[float, float]) -> Motion:
    return motion_at(modes.halves, Place("lid", shares[0] * box.size_m[0], shares[1] * box.size_m[2], Axis.Y))


def _elastic(modes: HousingModes, seats: list[Motion]) -> float:
    flexible = np.diag(modes.flexibility_beyond(6, seats, seats))
    return float(1.0 / flexible.max() / BEARINGS_N_PER_M)


def _conductance(box: Box, modes: HousingModes, damping: np.ndarray) -> float:
    frequency, rng = np.linspace(2000.0, 9000.0, 1500), np.random.default_rng(3)
    places = [_lid(box, modes, (float(a), float(b))) for a, b in rng.uniform(0.15, 0.85, (6, 2))]
    own = sheet(box.material, box.thickness.lid_m)
    found = [modes.accelerance([p], [p], frequency, damping)[0, 0] / (2j * np.pi * frequency) for p in places]
    return float(np.mean(np.real(found)) * 8.0 * np.sqrt(own.bending * own.mass))


def _coupling(box: Box, modes: HousingModes, shafts: list[tuple[str, str]], damping: np.ndarray) -> dict[str, float]:
    """Return where simpler housings are wrong for the shafts: k_b |R - R_0|, R_0 of each of them."""
    frequency = np.geomspace(20.0, 8000.0, 1500)
    seats = [on_both(box, modes, *shaft) for shaft in shafts]
    stiff_box = replace(box, material=replace(box.material, youngs_modulus_pa=1e4 * box.material.youngs_modulus_pa))
    stiff = housing_modes(stiff_box, 3000.0, WAVES)
    stiff_seats = [on_both(stiff_box, stiff, *shaft) for shaft in shafts]
    squared = (2.0 * np.pi * frequency) ** 2
    full = -modes.accelerance(seats, seats, frequency, damping) / squared
    kept = {"six modes": 6, "modes below 1.5 kHz": max(6, int((modes.frequency_hz < 1500.0).sum()))}
    rigid = -stiff.accelerance(stiff_seats, stiff_seats, frequency, np.full(stiff.frequency_hz.size, DAMPING)) / squared
    models = {"rigid box on the same bolts": rigid}
    for name, count in kept.items():
        shapes, natural = modes.shapes(seats)[:, :count], 2.0 * np.pi * modes.frequency_hz[:count, None]
        shares = 1.0 / (natural**2 - squared + 2j * damping[:count, None] * natural * np.sqrt(squared))
        models[name] = np.einsum("om,im,mk->oik", shapes, shapes, shares)
        models[f"{name}, rest in series"] = models[name] + modes.flexibility_beyond(count, seats, seats)[:, :, None]
    found = {"modes below 1.5 kHz": float(kept["modes below 1.5 kHz"])}
    for name, simpler in models.items():
        wrong = BEARINGS_N_PER_M * np.linalg.norm(np.moveaxis(full - simpler, 2, 0), 2, axis=(1, 2))
        found[f"k_b |R - R_0| > 0.5, {name} [% of the band]"] = 100.0 * float((wrong > 0.5).mean())
        found[f"k_b |R - R_0|, {name}, median over 20-8000 Hz"] = float(np.median(wrong))
    return found


def reach_table() -> Iterator[str]:
    """Yield rows: third octaves against three times as many waves, by frequency over the resolved one."""
    yield "frequency over the resolved one | within 6 dB | median | 95 % | most | bias [dB]"
    pairs: dict[int, list[list[np.ndarray]]] = {}
    for box in boxes()[:6]:
        highest = 3.0 * resolved_hz(box)
        coarse = housing_modes(box, highest, WAVES)
        fine = housing_modes(box, 1.2 * highest, 2.5 * WAVES)
        centres = centres_hz(50.0, highest)
        levels = [refinement_levels(box, modes, lines_hz(centres)) for modes in (coarse, fine)]
        which = np.digitize(centres / coarse.resolved_hz, (0.5, 0.71, 1.0, 1.41, 2.0))
        for place in set(which.tolist()):
            pairs.setdefault(place, []).append([level[..., which == place].ravel() for level in levels])
    names = ("below 0.5", "0.5-0.71", "0.71-1", "1-1.41", "1.41-2", "2-3")
    for place in sorted(pairs):
        one, other = (np.concatenate([pair[side] for pair in pairs[place]]) for side in (0, 1))
        yield f"{names[place]} | {distance(one, other).text}"
