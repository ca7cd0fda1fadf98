"""A network that has seen thousands of gearboxes: they are streamed, kept as averages, and passed over.

    diagnostics.pretrain("runs/pretrained", minutes=75)   # again: goes on, until everything is done

First every family streams its gearboxes. Of a record only the averages of its gears are kept, 16 KB for two channels:
thousands of gearboxes then fit in memory, and every pass mixes all of them. Then the network passes over them. Its
weights depend on families, numbers and seed alone, not on the minutes of a call, on interruptions or on the number of
cores.

What it is judged on are pairs of gears that no record it has learnt from had, whatever family: a pair's teeth decide
its split. The split `validation` widens intervals of the size. Families of fewer than FEWEST_PAIRS pairs in all keep
the splits of their gearboxes, and scores are of unseen gearboxes.
"""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import asdict, dataclass
from functools import partial
from io import BytesIO
from math import ceil
from pathlib import Path
from typing import Any, TypeAlias
from zipfile import BadZipFile

import numpy as np
import torch

import siggen
from diagnostics.base.seeding import Purpose, generator
from diagnostics.records.state_classes import HEALTHY
from diagnostics.statistics.evaluation import area, bootstrap_weights
from diagnostics.training.gear_rows import ACCELERATION, ALONE, PARTS, GearLines, gear_lines, gear_rows, joined
from diagnostics.training.gearbox_learner import NOWHERE, DamageTruth, GearboxLearner, learnt, told_loss
from diagnostics.training.gearbox_network import (
    GEARS,
    LEVELS,
    QUANTILES,
    SAID,
    WIDTHS,
    GearboxNetwork,
    Told,
    save_gearbox_network,
)
from diagnostics.training.likeness import average_numbers, fitted
from diagnostics.training.loop import LoopSettings, fit_network, seeded
from diagnostics.training.referenced import healthy_references
from diagnostics.training.splits import TEST, TRAIN, VALIDATION
from siggen.errors import UsageError, counted
from siggen.file_writing import write_file
from siggen.plain_json import json_text, plain

FAMILIES = tuple(str(Path(__file__).with_name("families") / f"{name}.yaml") for name in ("spalls", "faults"))
PLAN, PLACE, WEIGHTS, CARD = "plan.json", "place.pt", "network.safetensors", "card.json"
LABELS = (
    "record_id", "specimen_id", "split", "state_id", "state", "operating_point_id", "repeat", "fault", "faulty_gear",
    "damaged_area_share",
)  # fmt: skip
SOUND = "none"
"""Value of `faulty_gear`. All teeth are sound beside a spalled bearing, bad alignment or a loose sensor too."""
LIKE = 0.98
"""Share of unseen records that each distance calls alike."""
TEETH = tuple(f"teeth_{gear}" for gear in GEARS)
FEWEST_PAIRS, SHARES = 20, {TEST: 0.15, VALIDATION: 0.1}
"""Pairs of teeth from which on these decide the split, and the shares that are not learnt from."""
Say: TypeAlias = Callable[[str], object]
"""Takes a line on how far it is."""
USE = (
    "To tell damage of teeth in gearboxes with fixed shafts, from accelerations with a pulse per turn and known teeth."
)
NO_USE = (
    "All it has learnt from is simulated: no measured damage was seen. Its scores are no detection limits of a "
    "machine. Not for planetary sets, for speeds that run up or down, or as the only reason to stop a "
    "machine or not."
)


@dataclass(frozen=True, slots=True)
class PretrainingSettings:
    """What is learnt from, and how.

    Attributes
    ----------
    families : tuple of str
        Configurations whose gearboxes are streamed, as of `siggen.load_config`.
    gearboxes : int
        Of all families together; each has the same share.
    mixed : int
        Gearboxes that are simulated before they are written.
    passes : int
        Over the gearboxes to learn from.
    batch : int
        Channels of records per step.
    rate, decay : float
        Of AdamW; the rate falls.
    widths : tuple of int
        Of the network's stages.
    alone : float
        Share of the records whose healthy record is taken away.
    seed : int
        Of weights, order and what is taken away.
    """

    families: tuple[str, ...] = FAMILIES
    gearboxes: int = 2000
    mixed: int = 8
    passes: int = 20
    batch: int = 64
    rate: float = 3e-3
    decay: float = 0.1
    widths: tuple[int, ...] = WIDTHS
    alone: float = 0.5
    seed: int = 0

    def __post_init__(self) -> None:
        if isinstance(self.families, str) or not self.families:
            raise UsageError(f"families: received {self.families!r}; allowed: names of configurations, one or more")
        wholes = {name: getattr(self, name) for name in ("gearboxes", "mixed", "passes")}
        wholes |= {f"widths[{place}]": width for place, width in enumerate(self.widths or (0,))}
        for name, value, least in (*((*item, 1) for item in wholes.items()), ("batch", self.batch, 2)):
            if isinstance(value, bool) or not isinstance(value, int) or value < least:
                raise UsageError(f"{name}: received {value!r}; allowed: whole numbers from {least} on")
        for name, value, most in (("rate", self.rate, 1.0), ("decay", self.decay, 10.0), ("alone", self.alone, 1.0)):
            if not 0.0 <= value <= most:
                raise UsageError(f"{name}: received {value!r}; allowed: 0 to {most:g}")


@dataclass(frozen=True, slots=True)
class KeptRecords:
    """Averages of records with what is true of them.

    Attributes
    ----------
    averages : GearLines
    labels : mapping of str to (records,)
        As a record has them; `record_id` and `specimen_id` count over all families. `pair` counts pairs of teeth.
    """

    averages: GearLines
    labels: Mapping[str, np.ndarray]

    def of_split(self, name: str) -> np.ndarray:
        """Return the places of the records of a split."""
        return np.flatnonzero(self.labels["split"] == name)

    def kinds(self, places: np.ndarray) -> list[str]:
        """Return the kinds of damage of teeth of some records."""
        return sorted(set(self.labels["fault"][places][self.labels["faulty_gear"][places] != SOUND].tolist()))

    def rows(self) -> np.ndarray:
        """Return what a network takes of all records, beside a healthy record where there is one."""
        return gear_rows(self.averages, self.averages, healthy_references(self.labels))

    def truths(self, kinds: Sequence[str]) -> DamageTruth:
        """Return what is true of all records; other kinds than those are of no place."""
        fault, gear = self.labels["fault"], self.labels["faulty_gear"]
        with np.errstate(divide="ignore"):
            size = np.log(self.labels["damaged_area_share"].astype(np.float32))
        return DamageTruth(
            damaged=(gear != SOUND).astype(np.float32),
            kind=np.array([kinds.index(name) if name in kinds else NOWHERE for name in fault.tolist()]),
            gear=np.array([GEARS.index(name) if name in GEARS else NOWHERE for name in gear.tolist()]),
            size=np.where(np.isfinite(size), size, np.nan),
        )


class _TimeIsUpError(Exception):
    """The minutes of a call are over; the next one goes on."""


def pretrain(
    folder: Path | str,
    settings: PretrainingSettings | None = None,
    *,
    minutes: float | None = None,
    workers: int | None = None,
    say: Say = lambda _: None,
) -> dict[str, Any] | None:
    """Train a network on streamed gearboxes, or go on with it.

    Parameters
    ----------
    folder : path
        Takes averages, the place of the training, weights and card.
    settings : PretrainingSettings, optional
        Default: two thousand gearboxes of the shipped families, 75 minutes on two cores.
    minutes : float, optional
        After which the call ends, by default when all is done. Of gearboxes those that are simulated then are kept; a
        pass that has begun is begun again by the next call.
    workers : int, optional
        Processes that simulate, by default one per core; 0: this process.
    say : callable, optional
        Takes a line on how far it is.

    Returns
    -------
    dict or None
        The card: settings, digests, gearboxes, scores, use; None if the minutes are over before.

    Raises
    ------
    UsageError
        If a setting is out of its range, the folder holds another training or a damaged file, or a family has several
        stages, planets, no accelerometer, or another number of them than the first.
    """
    chosen, home = settings or PretrainingSettings(), Path(folder)
    end = None if minutes is None else time.monotonic() + 60.0 * minutes
    try:
        kept = _averages(home, chosen, workers, partial(_check, end), say)
        trained = _trained(home, chosen, kept, partial(_check, end), say)
    except _TimeIsUpError:
        say(f"{minutes:g} minutes are over; the same call goes on")
        return None
    return _finished(home, chosen, kept, *trained)


def _check(end: float | None) -> None:
    if end is not None and time.monotonic() > end:
        raise _TimeIsUpError


def _averages(
    home: Path,
    chosen: PretrainingSettings,
    workers: int | None,
    check: Callable[[], None],
    say: Callable[[str], object],
) -> KeptRecords:
    """Return the averages of all families, after those that are missing were simulated."""
    designs = [siggen.load_config(name) for name in chosen.families]
    blocks = -(-chosen.gearboxes // (len(designs) * chosen.mixed))
    by = {"executor": "serial"} if workers == 0 else {"workers": workers}
    streams = [partial(siggen.stream, design, mixed=chosen.mixed, seed=chosen.seed, **by) for design in designs]
    whole = [stream(first_gearbox=0) for stream in streams]
    _check_families(whole)
    _keep_plan(home, chosen, [stream.state_dict() for stream in whole])
    for family, begun in enumerate(streams):
        done = next((number for number in range(blocks) if not _block(home, family, number).exists()), blocks)
        if done == blocks:
            continue
        check()
        stream = begun(first_gearbox=done * chosen.mixed)
        with closing(stream.blocks()) as simulated:  # type: ignore[type-var]
            for number in range(done, blocks):
                _write_block(_block(home, family, number), next(simulated), stream)
                say(f"family {family + 1} of {len(designs)}: {(number + 1) * chosen.mixed} gearboxes")
                check()
    return _read(home, len(designs), blocks)


def _check_families(streams: Sequence[Any]) -> None:
    counts = [sum(channel.quantity == ACCELERATION for channel in stream.channels) for stream in streams]
    for stream, count in zip(streams, counts, strict=True):
        meshes = len(stream.design.names.meshes)
        if meshes != 1 or not count or count != counts[0]:
            raise UsageError(
                f"families: received {stream.design.name} with {counted(meshes, 'mesh', 'meshes')} and "
                f"{counted(count, 'channel')} of acceleration; allowed: one pair of gears, and as many such channels "
                f"as the first family has ({counts[0]})"
            )


def _block(home: Path, family: int, number: int) -> Path:
    return home / "averages" / f"{family}-{number:05d}.npz"


def _keep_plan(home: Path, chosen: PretrainingSettings, places: list[dict[str, Any]]) -> None:
    """Write what the folder is of, or refuse another one."""
    streams = [{name: place[name] for name in ("configuration", "sources")} for place in places]
    plan = {**asdict(chosen), "families": [Path(name).stem for name in chosen.families], "streams": streams}
    text, path = json_text(plan), home / PLAN
    if not path.exists():
        write_file(path, text)
    elif (old := json.loads(path.read_text(encoding="utf-8"))) != (new := json.loads(text)):
        names = ", ".join(name for name in new if new[name] != old.get(name))
        raise UsageError(
            f"{home}: holds a training with other {names}; allowed: another folder, or the settings and the version of "
            "siggen that it was begun with"
        )


def _write_block(path: Path, records: Sequence[Mapping[str, Any] | None], stream: Any) -> None:
    known = sorted((record for record in records if record is not None), key=lambda record: record["record_id"])
    averages = joined([_of_record(record, stream) for record in known])
    labels = {name: np.array([record[name] for record in known]) for name in LABELS}
    content = BytesIO()
    np.savez(content, allow_pickle=False, **{name: getattr(averages, name) for name in PARTS}, **labels)
    write_file(path, content.getvalue())


def _of_record(record: Mapping[str, Any], stream: Any) -> GearLines:
    columns = {channel.name: record[channel.column] for channel in stream.channels if channel.quantity == ACCELERATION}
    if not set(TEETH) <= record.keys():
        raise UsageError(f"families: received other gears than {' and '.join(GEARS)}; allowed: one pair of them")
    return gear_lines(columns, record["tacho_s"], stream.design.fs_hz, tuple(record[name] for name in TEETH))


def _read(home: Path, families: int, blocks: int) -> KeptRecords:
    parts: list[dict[str, np.ndarray]] = []
    for family in range(families):
        for number in range(blocks):
            path = _block(home, family, number)
            try:
                with np.load(path, allow_pickle=False) as file:
                    part = {name: file[name] for name in file.files}
            except (OSError, ValueError, EOFError, BadZipFile) as error:
                raise UsageError(
                    f"{path}: cannot be read ({error}); delete it, and the same call makes it again"
                ) from error
            for name in ("record_id", "specimen_id"):
                part[name] = part[name] * families + family  # numbers of their own
            parts.append(part)
    whole = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    pairs, whole["pair"] = np.unique(whole["teeth"], axis=0, return_inverse=True)
    if len(pairs) >= FEWEST_PAIRS:
        whole["split"] = pair_splits(pairs)[whole["pair"]]
    return KeptRecords(GearLines(*(whole.pop(name) for name in PARTS)), whole)


def pair_splits(pairs: np.ndarray) -> np.ndarray:
    """Return the split of each pair of teeth (pairs, 2): dealt in the order of their digests, by no seed."""
    splits, first = np.full(len(pairs), TRAIN, dtype=object), 0
    order = np.argsort([hashlib.sha256("/".join(map(str, pair)).encode()).hexdigest() for pair in pairs.tolist()])
    for name, share in SHARES.items():
        count = ceil(share * len(pairs))
        splits[order[first : first + count]], first = name, first + count
    return splits.astype(str)


def _trained(
    home: Path, chosen: PretrainingSettings, kept: KeptRecords, check: Callable[[], None], say: Say
) -> tuple[GearboxNetwork, np.ndarray, DamageTruth]:
    """Return the network at its last pass, with the rows and the truth of all records."""
    learn = kept.of_split(TRAIN)
    faults = kept.kinds(learn)
    if not faults or not (kept.labels["faulty_gear"][learn] == SOUND).any():
        raise UsageError("families: the split train has no healthy, or no damaged records; ask for more gearboxes")
    rows, truths = kept.rows(), kept.truths(faults)
    network = taught(rows, truths, faults, learn, chosen, place=home / PLACE, check=check, say=say)
    return network, rows, truths


def taught(
    rows: np.ndarray,
    truths: DamageTruth,
    kinds: Sequence[str],
    learn: np.ndarray,
    chosen: PretrainingSettings,
    *,
    place: Path | None = None,
    check: Callable[[], None] = lambda: None,
    say: Say = lambda _: None,
) -> GearboxNetwork:
    """Return a network that began with random weights, at its last pass over some records.

    Parameters
    ----------
    rows : (records, channels, gears, 4, steps) float16
        Of all records, see `gear_rows`.
    truths : DamageTruth
        Of all records.
    kinds : sequence of str
        Kinds of damage that it can name.
    learn : (n,) int
        Places of the records to learn from.
    chosen : PretrainingSettings
        Passes, batch, rate, decay, widths, alone and seed are used.
    place : Path, optional
        File from which the passes go on.
    check, say : callable, optional
        Called before every batch; takes a line after every pass.
    """
    share, sizes = float(truths.damaged[learn].mean()), truths.size[learn][np.isfinite(truths.size[learn])]
    channels = rows.shape[1]
    with seeded(chosen.seed):
        centre = (float(sizes.mean()), max(float(sizes.std()), 1e-3)) if sizes.size else (0.0, 1.0)
        learner = GearboxLearner(kinds, chosen.widths, centre)

        def batches(number: int) -> Iterator[torch.Tensor]:
            rng, losses = generator(chosen.seed, Purpose.PRETRAINING, number), []
            order = rng.permutation(learn.size * channels)
            for start in range(0, order.size - order.size % chosen.batch or order.size, chosen.batch):
                check()
                record, channel = np.divmod(order[start : start + chosen.batch], channels)
                seen = _moved(rows[learn[record], channel], rng, chosen.alone)
                loss = told_loss(learner(seen), truths.chosen(learn[record]), share)
                losses.append(float(loss.detach()))
                yield loss
            say(f"pass {number} of {chosen.passes}: loss {np.mean(losses):.4f}")

        loop = LoopSettings(chosen.passes, chosen.rate, chosen.decay, falling=True)
        fit_network(learner, batches, None, loop, place=place)
    return learnt(learner)


def _moved(rows: np.ndarray, rng: np.random.Generator, alone: float) -> torch.Tensor:
    """Return rows as seen from another tooth, by a sensor of another sign, some without their healthy record."""
    shift, sign = int(rng.integers(rows.shape[-1])), rng.choice((-1.0, 1.0), len(rows))
    moved = np.roll(rows, shift, axis=-1).astype(np.float32) * sign[:, None, None, None].astype(np.float32)
    moved[rng.random(len(rows)) < alone, :, ALONE:] = 0.0
    return torch.from_numpy(moved)


def _finished(
    home: Path,
    chosen: PretrainingSettings,
    kept: KeptRecords,
    network: GearboxNetwork,
    rows: np.ndarray,
    truths: DamageTruth,
) -> dict[str, Any]:
    """Write weights and card; return the card."""
    sides = _sides(kept, rows)
    _widen(network, sides, truths, kept.of_split(VALIDATION))
    _set_limits(network, kept, sides, truths)
    scores = _scores(network, kept, sides, truths)
    plan, split, owner = json.loads((home / PLAN).read_text()), kept.labels["split"], kept.labels["specimen_id"]
    covered = _covered(kept, chosen)
    false = {side: score["called_damaged_of_sound"] for side, score in scores.items()}
    save_gearbox_network(network, home / WEIGHTS, covered | {"called_damaged_of_sound": false})
    card: dict[str, Any] = plain(
        {
            "weights_sha256": hashlib.sha256((home / WEIGHTS).read_bytes()).hexdigest(),
            "parameters": sum(weight.size for name, weight in network.weights.items() if name != "size_centre"),
            "torch": torch.__version__,
            **plan,
            "gearboxes_of_splits": {
                name: {"gearboxes": int(np.unique(owner[split == name]).size), "records": int((split == name).sum())}
                for name in (TRAIN, VALIDATION, TEST)
            },
            "covered": covered,
            "kinds": network.kinds,
            f"scores_of_unseen_{_unseen(kept)}": scores,
            "use": USE,
            "no_use": NO_USE,
        }
    )
    write_file(home / CARD, json_text(card))
    return card


def _unseen(kept: KeptRecords) -> str:
    """Return what no record learnt from shares with those judged on."""
    learnt = set(kept.labels["pair"][kept.of_split(TRAIN)].tolist())
    return "gearboxes" if learnt & set(kept.labels["pair"][kept.of_split(TEST)].tolist()) else "pairs"


def _covered(kept: KeptRecords, chosen: PretrainingSettings) -> dict[str, Any]:
    """Return what a recording may be: rate [Hz], length [s], ranges of teeth, ratio and speed [Hz] of the training."""
    designs, teeth = [siggen.load_config(name) for name in chosen.families], kept.averages.teeth[kept.of_split(TRAIN)]
    speeds = [point.speed_hz for design in designs for point in design.config.operating_points]
    ends = [(one, one) if isinstance(one, float) else one.bounds() for one in speeds]
    ratio = teeth[:, 1] / teeth[:, 0]
    return {
        "fs_hz": designs[0].fs_hz,
        "duration_s": designs[0].duration_s,
        "teeth": [[int(one.min()), int(one.max())] for one in teeth.T],
        "ratio": [float(ratio.min()), float(ratio.max())],
        "speed_hz": [min(low for low, _ in ends), max(high for _, high in ends)],
    }


Sides: TypeAlias = tuple[tuple[str, np.ndarray, np.ndarray], ...]
"""Name, rows of all records, and which of them (records,) bool are seen so: alone, and beside a healthy record."""


def _sides(kept: KeptRecords, rows: np.ndarray) -> Sides:
    alone = rows.copy()
    alone[..., ALONE:, :] = 0.0
    known = np.array([references.size > 0 for references in healthy_references(kept.labels)])
    return ("alone", alone, np.ones(len(rows), dtype=bool)), ("beside", rows, known)


def _widen(network: GearboxNetwork, sides: Sides, truths: DamageTruth, places: np.ndarray) -> None:
    """Widen intervals of the size so that they hold as many of the records left out as they say."""
    for side, (_, rows, seen) in enumerate(sides):
        sized = places[np.isfinite(truths.size[places]) & seen[places]]
        if sized.size:
            known, (low, _, high) = truths.size[sized], network.tell(rows[sized]).size.T
            missed = np.sort(np.maximum(low - known, known - high))
            rank = int(np.ceil((missed.size + 1) * (QUANTILES[-1] - QUANTILES[0]))) - 1
            network.size_widening[side] = float(missed[min(rank, missed.size - 1)])


def _set_limits(network: GearboxNetwork, kept: KeptRecords, sides: Sides, truths: DamageTruth) -> None:
    """Keep what training records are like, and what is said of those of the split validation."""
    limits, levels = network.limits, np.linspace(0.0, 1.0, LEVELS)
    learnt, unseen = kept.of_split(TRAIN), kept.of_split(VALIDATION)
    averages = average_numbers(kept.averages)
    known = np.concatenate(list(averages[learnt]))
    limits.average_centre, limits.average_precision = fitted(known)
    limits.average_spread = known.std(axis=0) + 1e-9
    for side, (_, rows, beside) in enumerate(sides):
        seen = network.seen(rows)
        limits.seen_centre[side], limits.seen_precision[side] = fitted(
            np.concatenate(list(seen[learnt[beside[learnt]]]))
        )
        judged = unseen[beside[unseen]] if beside[unseen].any() else unseen
        if judged.size:
            limits.farthest[side] = np.quantile(limits.distances(averages[judged], seen[judged], side), LIKE, 0)
            odds, ill = network.tell(rows[judged]).damage.astype(np.float64), truths.damaged[judged] > 0.0
            state = kept.labels["state"][judged]
            sound = [np.quantile(odds[state == name], levels) for name in dict.fromkeys(state[~ill].tolist())]
            if sound:  # of that which looks worst: a loose sensor, which looks sounder, must not lower the limit
                limits.sound[side] = np.max(sound, axis=0)
            if ill.any():
                limits.damaged[side] = np.quantile(odds[ill], levels)


def _scores(network: GearboxNetwork, kept: KeptRecords, sides: Sides, truths: DamageTruth) -> dict[str, Any]:
    """Return what the network tells of unseen pairs, alone and beside a healthy record."""
    scores, averages = {}, average_numbers(kept.averages)
    for side, (name, rows, seen) in enumerate(sides):
        places = kept.of_split(TEST)
        places = places[seen[places]]
        if places.size:
            told = network.tell(rows[places])
            labels = {key: value[places] for key, value in kept.labels.items()}
            drawn = "specimen_id" if _unseen(kept) == "gearboxes" else "pair"
            off = network.limits.distances(averages[places], network.seen(rows[places]), side)
            like = (off <= network.limits.farthest[side]).all(axis=1)
            said = told.damage.astype(np.float64) > network.limits.said(side, SAID)
            ill = truths.damaged[places] > 0.0
            scores[name] = _scores_of(told, truths.chosen(places), labels, drawn) | {
                "answered": float(like.mean()),
                "called_damaged_of_sound": float(said[like & ~ill].mean()) if (like & ~ill).any() else None,
                "called_damaged_of_damaged": float(said[like & ill].mean()) if (like & ill).any() else None,
            }
    return scores


def _scores_of(told: Told, truths: DamageTruth, labels: Mapping[str, np.ndarray], drawn: str) -> dict[str, Any]:
    """Return scores with limits; `drawn` names what is resampled, since that is what others would draw anew."""
    damage, specimen = told.damage.astype(np.float64), labels["specimen_id"]
    weights = bootstrap_weights(labels[drawn], 0)
    ill, healthy, scores = truths.damaged > 0.0, labels["fault"] == HEALTHY, dict[str, Any]()
    for name in ("damage", *dict.fromkeys(labels["state"][~healthy].tolist())):
        of = ill if name == "damage" else labels["state"] == name
        asked = healthy | of  # of sound teeth with another fault: half, as far as damage is told from that
        scores[f"auc_{name}"] = asdict(area(damage[asked], of[asked], weights[:, asked], specimen[asked]))
    for name, said, place in (("kind", told.kind, truths.kind), ("gear", told.gear, truths.gear)):
        known = place != NOWHERE
        if known.any():
            scores[f"{name}_named_rightly"] = float((said.argmax(axis=1)[known] == place[known]).mean())
    sized = np.isfinite(truths.size)
    if sized.any():
        low, middle, high = told.size[sized].T
        size = truths.size[sized]
        scores["size_in_interval"] = float(((low <= size) & (size <= high)).mean())
        scores["size_interval_factor"] = float(np.exp(np.median(high - low)))
        scores["size_median_factor"] = float(np.exp(np.median(np.abs(middle - size))))
    return scores
