"""What the network that comes with the package says of a recording, without any training, or why it cannot tell.

It says damage where the recording looks more like damage than 99 of 100 sound records of gearboxes that it has not
learnt from; below it says that no damage is seen, and how many damaged records look so too. It cannot tell where the
recording is unlike its training: by rate, length, teeth or speed, by the averages themselves, by what it makes of them,
or because healthy recordings of the machine differ from each other as damaged ones do. Source: derived.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.special import softmax

from diagnostics.page.wording import percent
from diagnostics.prediction.record_pieces import at_rate, cut
from diagnostics.recordings.channel_factor import ACCELERATION_UNIT
from diagnostics.recordings.measured_recording import MeasuredRecording
from diagnostics.recordings.shaft_pulses import ShaftPulses, shaft_pulses
from diagnostics.records.gear_train import pair_train
from diagnostics.training.gear_rows import GearLines, gear_lines, gear_rows, joined
from diagnostics.training.gearbox_network import GEARS, SAID, GearboxNetwork
from diagnostics.training.likeness import average_numbers, mesh_over_noise
from diagnostics.training.shipped_network import shipped_network
from siggen.columns.drivetrain import GearTrain
from siggen.errors import UsageError, counted

DAMAGE, NOTHING, UNTOLD = "damage", "no damage seen", "cannot tell"
SPEED_WITHIN = 1.01
"""A mean speed scatters by less than one per cent."""
DISTANCES = ("the averages are", "one number of the averages is", "to the network it is")
LEAST_AGREEMENT, MOST_TURNED, MOST_LEVEL = 0.8, 5e-4, 1.4
"""Of mesh lines of a recording and a healthy one: real coherence, turn of one against the other, ratio of levels."""
LONGEST_GAP = 1.5
"""Longest time between two pulses, in medians: a missing pulse makes it 2."""
FEWEST_MESH = 4.0
"""Power of mesh lines over that of noise there, from which on there is a mesh: noise alone gives 1 within 0.5."""
SIDES = ("alone", "beside healthy recordings")
WITHOUT_TACHO = "healthy recordings were left out, since they need a tacho"


@dataclass(frozen=True, slots=True)
class GearboxAnswer:
    """What the network says of a recording.

    Attributes
    ----------
    recording : MeasuredRecording
        At the rate of the training.
    pulses : ShaftPulses
    train : GearTrain
    side : int
        0 alone, 1 beside healthy recordings.
    odds : float
        Log odds of damage, mean over pieces and channels.
    as_odd, unseen : float
        Shares of unseen records: sound ones with as large odds, damaged ones with as small.
    distances, farthest : tuple of float
        Of the averages, of their farthest number and of what the network makes of them; the largest like training.
    kinds, gears : mapping of str to float
        Probabilities, if there is damage.
    size : (float, float, float)
        Damaged share of the worst flank: 5, 50 and 95 %.
    pieces : int
    reasons, notes : tuple of str
        Why it cannot tell; what the reader should know besides.
    said : bool
        Whether the odds are larger than those of 99 of 100 unseen sound records.
    false_calls : float
        Share of sound records, of teeth that set no limit, of which damage is said.
    """

    recording: MeasuredRecording
    pulses: ShaftPulses
    train: GearTrain
    side: int
    odds: float
    as_odd: float
    unseen: float
    distances: tuple[float, ...]
    farthest: tuple[float, ...]
    kinds: Mapping[str, float]
    gears: Mapping[str, float]
    size: tuple[float, float, float]
    pieces: int
    reasons: tuple[str, ...]
    notes: tuple[str, ...]
    said: bool
    false_calls: float

    @property
    def verdict(self) -> str:
        """Damage, no damage seen, or cannot tell."""
        return UNTOLD if self.reasons else DAMAGE if self.said else NOTHING

    @property
    def headline(self) -> str:
        """What was found, in one line; first that healthy recordings were left out."""
        return f"{WITHOUT_TACHO}; {self._found}" if WITHOUT_TACHO in self.notes else self._found

    @property
    def _found(self) -> str:
        if self.reasons:
            return f"{UNTOLD}: {self.reasons[0]}"
        if not self.said:
            return f"{NOTHING}; of 100 damaged records of training {_of_100(self.unseen)} look as healthy as this one"
        kind, gear = (max(of, key=lambda name: of[name]) for of in (self.kinds, self.gears))
        return (
            f"{DAMAGE}, most like {kind} ({percent(self.kinds[kind])}) of the {gear} ({percent(self.gears[gear])}); "
            f"of sound records of unseen teeth {percent(self.false_calls)} are called so"
        )

    @property
    def rows(self) -> list[tuple[str, str]]:
        """Label and text of everything that is said."""
        shaft = self.train.gears[0]
        mesh_hz = self.pulses.speed_hz * float(shaft.teeth or 0)
        found = [
            ("answer", self.verdict),
            ("seen", f"{SIDES[self.side]}, {counted(self.pieces, 'piece')}"),
            (f"{shaft.name} speed", f"{self.pulses.speed_hz:.4f} Hz ({self.pulses.origin}); mesh {mesh_hz:.2f} Hz"),
            (
                "log odds of damage",
                f"{self.odds:.2f}; of 100 sound records {_of_100(self.as_odd)} look at least as bad",
            ),
        ]
        if self.verdict == DAMAGE:
            low, middle, high = self.size
            found += [
                ("kind", _shares(self.kinds)),
                ("gear", _shares(self.gears)),
                ("damaged flank share", f"{middle:.2g}, with 90 % between {low:.2g} and {high:.2g}"),
            ]
        names = ("distance of averages", "farthest number", "distance in network")
        for name, off, most in zip(names, self.distances, self.farthest, strict=True):
            found.append((name, f"{off:.2f}; above {most:.2f} it cannot tell"))
        found += [("cannot tell because", reason) for reason in self.reasons]
        return [*found, *(("note", note) for note in self.notes)]

    @property
    def facts(self) -> dict[str, Any]:
        """Everything for JSON."""
        return {
            "file": str(self.recording.path),
            "answer": self.verdict,
            "reasons": list(self.reasons),
            "seen": SIDES[self.side],
            "log_odds": self.odds,
            "sound_records_as_bad": self.as_odd,
            "false_calls": self.false_calls,
            "damaged_records_no_worse": self.unseen,
            "kinds": dict(self.kinds),
            "gears": dict(self.gears),
            "damaged_area_share": dict(zip(("low", "middle", "high"), self.size, strict=True)),
            "distances": list(self.distances),
            "distances_at_most": list(self.farthest),
            "speed_hz": self.pulses.speed_hz,
            "speed_from": self.pulses.origin,
            **self.pulses.facts,
            "teeth": [gear.teeth for gear in self.train.gears],
            "pieces": self.pieces,
            "notes": list(self.notes),
        }


def _of_100(share: float) -> str:
    return f"{100 * share:.0f}"


def _shares(of: Mapping[str, float]) -> str:
    return ", ".join(f"{name} {share:.2f}" for name, share in sorted(of.items(), key=lambda item: -item[1]))


def gearbox_answer(
    recording: MeasuredRecording,
    teeth: tuple[int, int],
    speed_range_hz: tuple[float, float] | None = None,
    references: Sequence[MeasuredRecording] = (),
) -> GearboxAnswer:
    """Return what the network says of a recording.

    Parameters
    ----------
    recording : MeasuredRecording
        Accelerations.
    teeth : (int, int)
        Of both gears.
    speed_range_hz : (float, float), optional
        Where to look for the first shaft's speed without a tacho.
    references : sequence of MeasuredRecording
        Of the same machine in healthy state, at the same speed and load.

    Raises
    ------
    UsageError
        If a channel is no acceleration, pulses cannot be found, or channels of a reference are others.
    """
    network, covered = shipped_network()
    train = pair_train(teeth)
    (slow, pulses, lines), *healthy = (
        _averaged(one, train, speed_range_hz, covered) for one in (recording, *references)
    )
    for other in references:
        _check_reference(recording, other)
    notes = []
    if healthy and any(own.angle is not None for own in (pulses, *(found[1] for found in healthy))):
        notes.append(WITHOUT_TACHO)
        healthy = []
    reasons = [*_uncovered(recording, slow, pulses, teeth, covered)]
    if not (mesh := float(np.median(mesh_over_noise(lines)))) >= FEWEST_MESH:
        reasons.append(
            f"the mesh lines have {mesh:.2g} times the power of noise, at least {FEWEST_MESH:g} are needed: are teeth "
            "and speed right, and does the sensor see these gears?"
        )
    for other, (_, own, _) in zip(references, healthy, strict=False):
        if not 1.0 / SPEED_WITHIN <= own.speed_hz / pulses.speed_hz <= SPEED_WITHIN:
            reasons.append(
                f"reference {other.path.name}: the speed is {own.speed_hz:.4g} Hz, the recording has "
                f"{pulses.speed_hz:.4g} Hz; healthy recordings count at the same speed and load"
            )
    reasons += [
        text for other, (_, _, own) in zip(references, healthy, strict=False) for text in _apart(lines, own, other)
    ]
    if healthy:
        notes.append("healthy recordings count at the same load: more load can look like damage")
    side = int(bool(healthy))
    asked = _Asked(network, side, lines, joined([found[2] for found in healthy]) if healthy else None)
    odds, distances = asked.odds(), asked.distances()
    limits = network.limits
    farthest = limits.farthest[side]
    for name, off, most in zip(DISTANCES, distances, farthest, strict=True):
        if not off <= most:
            reasons.append(f"unlike the training: {name} {off:.2f} spreads off, at most {most:.2f} there")
    said = limits.said(side, SAID)
    for place, (other, _) in enumerate(zip(references, healthy, strict=False)):
        rest = [found[2] for number, found in enumerate(healthy) if number != place]
        if rest and _Asked(network, side, healthy[place][2], joined(rest)).odds() > said:
            reasons.append(
                f"reference {other.path.name} differs from the other healthy recordings as damaged ones do; "
                "give recordings at one load"
            )
    told = asked.told
    low, middle, high = np.exp(told.size.astype(np.float64).mean(axis=0)).tolist()
    return GearboxAnswer(
        recording=slow,
        pulses=pulses,
        train=train,
        side=side,
        odds=odds,
        as_odd=float((limits.sound[side] >= odds).mean()),
        unseen=float((limits.damaged[side] <= odds).mean()),
        distances=tuple(distances.tolist()),
        farthest=tuple(farthest.tolist()),
        kinds=_probabilities(told.kind, network.kinds),
        gears=_probabilities(told.gear, GEARS),
        size=(low, middle, high),
        pieces=len(lines.lines),
        reasons=tuple(dict.fromkeys(reasons)),
        notes=tuple(notes),
        said=odds > said,
        false_calls=covered["called_damaged_of_sound"][("alone", "beside")[side]],
    )


def _probabilities(logits: np.ndarray, names: Sequence[str]) -> dict[str, float]:
    return dict(zip(names, softmax(logits.astype(np.float64).mean(axis=0)).tolist(), strict=True))


class _Asked:
    """A recording's pieces as the network sees them."""

    def __init__(self, network: GearboxNetwork, side: int, lines: GearLines, healthy: GearLines | None) -> None:
        self.network, self.side, self.lines = network, side, lines
        self.rows = gear_rows(lines, healthy)
        self.told = network.tell(self.rows)

    def odds(self) -> float:
        """Return the mean log odds of the pieces."""
        return float(self.told.damage.astype(np.float64).mean())

    def distances(self) -> np.ndarray:
        """Return the median of all distances over pieces, (3,)."""
        seen = self.network.seen(self.rows)
        return np.asarray(
            np.median(self.network.limits.distances(average_numbers(self.lines), seen, self.side), axis=0)
        )


def _averaged(
    recording: MeasuredRecording,
    train: GearTrain,
    speed_range_hz: tuple[float, float] | None,
    covered: Mapping[str, Any],
) -> tuple[MeasuredRecording, ShaftPulses, GearLines]:
    """Return a recording at the rate of the training, its pulses, and the averages of its pieces."""
    for name, unit in recording.units.items():
        if unit != ACCELERATION_UNIT:
            raise UsageError(
                f"{recording.path}: channel {name} is in {unit}; allowed: accelerations. Name those columns, or give "
                "a model trained on such a set: predict MODEL FILE"
            )
    slow = at_rate(recording, covered["fs_hz"])
    pulses = shaft_pulses(slow, train, speed_range_hz)
    pieces = cut(slow, pulses, covered["duration_s"])
    fewest = 0.9 * min(covered["duration_s"], slow.duration_s) * pulses.speed_hz - 1.0
    found = [gear_lines(channels, times_s, slow.fs_hz, train) for channels, times_s in pieces if times_s.size > fewest]
    if not found:
        raise UsageError(
            f"{recording.path}: pulses cover no piece of {covered['duration_s']:g} s; give a tacho that runs all along"
        )
    return slow, pulses, joined(found)


def _apart(lines: GearLines, healthy: GearLines, other: MeasuredRecording) -> Iterator[str]:
    """Yield why a healthy recording does not lie over the recording: by the mesh lines of the pinion, each channel.

    `docs/scripts/laid_over.py` shows what the limits tell apart.
    """
    teeth = int(lines.teeth[0, 0])
    one, two = (part.lines[:, :, 0, teeth::teeth].mean(axis=0).astype(np.complex128) for part in (lines, healthy))
    size, known = (np.sqrt(np.square(np.abs(part)).sum(axis=1)) + 1e-300 for part in (one, two))
    order = np.arange(teeth, lines.lines.shape[-1], teeth)[: one.shape[1]]
    turns = np.linspace(-0.5, 0.5, 4001) / teeth
    product = (one * two.conj() / (size * known)[:, None]).sum(axis=0)
    turned = float(turns[(np.exp(-2j * np.pi * turns[:, None] * order) @ product).real.argmax()])
    level = float(np.abs(np.log(size / known)).max())
    agreement = float(((one * two.conj()).sum(axis=1).real / (size * known)).min())
    if agreement < LEAST_AGREEMENT or abs(turned) > MOST_TURNED:
        yield (
            f"reference {other.path.name} does not lie over the recording: mesh lines agree to {agreement:.2f}, "
            f"{LEAST_AGREEMENT:g} or more is needed, and are turned by {abs(turned):.2g} of a turn, at most "
            f"{MOST_TURNED:g}; the same machine, sensors, order of columns, sign, and mark of the tacho?"
        )
    elif level > np.log(MOST_LEVEL):
        yield (
            f"the level of the mesh is {np.exp(level):.2g} times that of reference {other.path.name}, or its inverse; "
            f"at most {MOST_LEVEL:g} is compared: another load, another sensor, or severe damage; ask without "
            "--reference"
        )


def _check_reference(recording: MeasuredRecording, other: MeasuredRecording) -> None:
    if tuple(other.channels) != tuple(recording.channels):
        raise UsageError(
            f"{other.path}: has the channels {', '.join(other.channels)}, the recording "
            f"{', '.join(recording.channels)}; allowed: the same sensors in the same order"
        )
    if any(np.array_equal(signal, other.channels[name]) for name, signal in recording.channels.items()):
        raise UsageError(
            f"{other.path}: has the same samples as the recording {recording.path}; give another recording of the "
            "machine in healthy state, or leave --reference out"
        )


def _uncovered(
    source: MeasuredRecording,
    slow: MeasuredRecording,
    pulses: ShaftPulses,
    teeth: tuple[int, int],
    covered: Mapping[str, Any],
) -> list[str]:
    """Return what is known of a recording and was never learnt from."""
    found, (low_hz, high_hz) = [], covered["speed_hz"]
    for gear, z, (low, high) in zip(GEARS, teeth, covered["teeth"], strict=True):
        if not low <= z <= high:
            found.append(f"the {gear} has {z} teeth, training covers {low} to {high}")
    low, high = covered["ratio"]
    if not low <= teeth[1] / teeth[0] <= high:
        found.append(f"the ratio is {teeth[1] / teeth[0]:.3g}, training covers {low:.3g} to {high:.3g}")
    if source.fs_hz < covered["fs_hz"] * (1.0 - 1e-3):
        found.append(
            f"the sampling rate is {source.fs_hz:g} Hz, training has {covered['fs_hz']:g} Hz: the band above "
            f"{0.5 * source.fs_hz:g} Hz is missing"
        )
    if not low_hz / SPEED_WITHIN <= pulses.speed_hz <= high_hz * SPEED_WITHIN:
        found.append(f"the pinion's speed is {pulses.speed_hz:.4g} Hz, training covers {low_hz:g} to {high_hz:g} Hz")
    if (gaps := np.diff(pulses.times_s)).max() > LONGEST_GAP * np.median(gaps):
        found.append(f"a pulse is missing at {pulses.times_s[int(gaps.argmax())]:.3g} s, or the speed jumps there")
    if slow.duration_s < covered["duration_s"] * (1.0 - 1e-3):
        found.append(f"the recording lasts {slow.duration_s:.3g} s, training takes {covered['duration_s']:g} s")
    return found
