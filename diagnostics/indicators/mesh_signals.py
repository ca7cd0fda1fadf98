"""Signals of all meshes of a gearbox: each over the angle of its own driver, averaged over whole turns of its shafts.

What has no shaft and no mesh line, such as the rms of the record, stands once, with the first mesh.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from diagnostics.indicators.channel_signals import ChannelSignals
from diagnostics.indicators.indicator import Indicator
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.records.gear_train import GearMesh, Planets
from diagnostics.signal.member_average import PLANET, RING, SUN, Carrier, carrier_turns_needed
from diagnostics.signal.order_domain import AngleGrid, angle_grid, shaft_grid
from diagnostics.signal.shaft_signals import SignalShaft, record_shafts

FEWEST_TURNS = 8
"""Of a shaft behind the first mesh: what is not locked to it falls as one over the turns, and all other meshes are."""


@dataclass(frozen=True, slots=True)
class MeshSignals:
    """One mesh of a record: its shafts, and the signals of every channel over its angle.

    A planetary set counts as one mesh with its members as shafts.
    """

    shafts: tuple[SignalShaft, ...]
    channels: Mapping[str, ChannelSignals]
    first: bool

    def values(self, channel: str, taken: tuple[Indicator, ...]) -> dict[str, float]:
        """Return the values of a channel by column."""
        own = taken if self.first else tuple(entry for entry in taken if entry.is_of_mesh)
        return self.channels[channel].values(own)

    def moments(self, channel: str) -> dict[str, float]:
        """Return what indicators with a history need of a channel."""
        return self.channels[channel].moments()

    def notes(self) -> list[str]:
        """Return what its shafts leave undefined, and why."""
        return [shaft.note for shaft in self.shafts if shaft.note]


def mesh_signals(
    channels: Mapping[str, np.ndarray],
    tacho_s: np.ndarray,
    fs_hz: float,
    train: tuple[GearMesh, ...],
    settings: IndicatorSettings,
) -> tuple[MeshSignals, ...]:
    """Return the signals of every mesh, the first one first.

    Parameters
    ----------
    channels : mapping of str to (n,) float64
        Signals by channel name.
    tacho_s : (k,) float64
        Pulse times of the first driver.
    fs_hz : float
        Sampling frequency [Hz].
    train : tuple of Mesh
        As of `meshes_of`.
    settings : IndicatorSettings
        How values are taken.
    """
    found = []
    for mesh in train:
        first = mesh is train[0]
        grid = _grid(tacho_s, mesh, settings.samples_per_tooth, first=first)
        carrier = _carrier(mesh.planets, settings)
        if carrier is None:
            shafts: tuple[SignalShaft, ...] = _shafts(grid, mesh, settings, first=first)
        else:
            shafts = _members(grid, mesh, carrier, settings)
        signals = {
            name: ChannelSignals(signal, fs_hz, grid, shafts, settings, mesh.names, carrier)
            for name, signal in channels.items()
        }
        found.append(MeshSignals(shafts, signals, first))
    return tuple(found)


def _grid(tacho_s: np.ndarray, mesh: GearMesh, samples_per_tooth: int, *, first: bool) -> AngleGrid | None:
    if len(tacho_s) < 2:
        return None
    steps = mesh.teeth[0] * samples_per_tooth
    return angle_grid(tacho_s, steps) if first else shaft_grid(tacho_s, steps, mesh.turns)


def _shafts(
    grid: AngleGrid | None, mesh: GearMesh, settings: IndicatorSettings, *, first: bool
) -> tuple[SignalShaft, SignalShaft]:
    driver, driven = record_shafts(grid, mesh.teeth, settings.samples_per_tooth, settings.sidebands, mesh.names.gears)
    if not first:
        driver, driven = _behind(driver), _behind(driven)
    return replace(driver, beside=mesh.before), replace(driven, beside=mesh.behind)


def _behind(shaft: SignalShaft) -> SignalShaft:
    """Return a shaft of a further mesh, without revolutions where they are too few."""
    if shaft.revolutions >= FEWEST_TURNS:
        return shaft
    note = f"all {shaft.name} averages undefined, since they need {FEWEST_TURNS} {shaft.name} revolutions"
    return replace(shaft, revolutions=0, note=note)


def _carrier(planets: Planets | None, settings: IndicatorSettings) -> Carrier | None:
    if planets is None:
        return None
    return Carrier(planets.ring, planets.places, planets.passing, settings.samples_per_tooth)


def _members(
    grid: AngleGrid | None, mesh: GearMesh, carrier: Carrier, settings: IndicatorSettings
) -> tuple[SignalShaft, ...]:
    """Return sun, planets and ring as shafts, without revolutions where those against the carrier are too few."""
    assert mesh.planets is not None
    sun, planet, ring = mesh.planets.teeth
    periods = grid.time_s.size / settings.samples_per_tooth if grid else 0.0
    both = np.ones(settings.sidebands) / settings.sidebands  # the ring's sidebands are those of passing planets
    needed = (
        carrier_turns_needed(settings.sidebands, sun, planet, carrier),
        carrier_turns_needed(settings.sidebands, planet, sun, carrier),
        both,
    )
    period = (sun * float(mesh.planets.sun_turns), 0.0, 0.0)  # one turn of the sun's shaft
    rows = zip(mesh.names.gears, mesh.planets.teeth, needed, (SUN, PLANET, RING), period, strict=True)
    return tuple(
        _member(SignalShaft(name, teeth, int(periods // teeth), turns <= periods / ring, "", 0, meets, after), turns)
        for name, teeth, turns, meets, after in rows
    )


def _member(shaft: SignalShaft, needed: np.ndarray) -> SignalShaft:
    """Return a member with what is not defined of it, and why."""
    if shaft.revolutions < FEWEST_TURNS:
        note = f"all {shaft.name} averages undefined, since they need {FEWEST_TURNS} turns against the carrier"
        return replace(shaft, revolutions=0, note=note)
    missing = [f"{k + 1} (needs {np.ceil(needed[k]):.0f})" for k in np.flatnonzero(~shaft.resolved)]
    told = f"{shaft.name} sidebands not resolved, by turns of the carrier: {', '.join(missing)}" if missing else ""
    return replace(shaft, note=told)
