"""State of a recording by the saved models, with probabilities, and the reasons for which no answer should be taken.

A state of a measured recording is named only beside healthy recordings of the same machine, and only where the
classifier agrees with the direction of the change. The answer is withheld where the recording is unlike the training
records: by distance, or by what is known of it (teeth, rate, speed, length). Where the classifiers name different
states the answer stands, with the contradiction beside it: that says how little it is worth, not that the recording is
foreign. Source: derived.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from diagnostics.prediction.known_reasons import OwnState, check_units, known_reasons, own_state, reference_reasons
from diagnostics.prediction.record_pieces import RecordPieces, at_rate, record_pieces
from diagnostics.prediction.released_model import ReleasedModel
from diagnostics.prediction.training_distance import TrainingDistance
from diagnostics.recordings.measured_recording import MeasuredRecording
from diagnostics.recordings.shaft_pulses import ShaftPulses, shaft_pulses
from diagnostics.records.gear_train import pair_train
from diagnostics.records.record_classes import STATE
from diagnostics.statistics.calibration import tempered
from diagnostics.statistics.evaluation import Interval
from diagnostics.training.referenced import log_mean, log_values
from siggen.columns.drivetrain import GearTrain
from siggen.errors import UsageError

NO_REFERENCE = (
    "a state of a measured recording is named only beside healthy recordings of the same machine; give them with "
    "--reference. Without them there are the distance and the indicators"
)
INDICATORS, REFERENCED, NETWORK = "indicators", "healthy_referenced", "network"

Reference = tuple[MeasuredRecording, ShaftPulses, RecordPieces]
"""A recording in healthy state as it came, its pulses, and its pieces at the rate of the model."""


@dataclass(frozen=True, slots=True)
class Vote:
    """Probability of every state by one classifier.

    Attributes
    ----------
    classifier : str
    probability : (states,) float64
        Mean over pieces.
    agreement : float or None
        Share of the pieces that name the same state; None where there is a single one.
    accuracy : Interval or None
        Share of the model's test records that the classifier named rightly; None where the model does not say.
    """

    classifier: str
    probability: np.ndarray
    agreement: float | None
    accuracy: Interval | None = None

    @property
    def named(self) -> int:
        """Which state it names."""
        return int(self.probability.argmax())


@dataclass(frozen=True, slots=True)
class Nearness:
    """Distance to the training records: median over pieces, threshold, and the features farthest off.

    `farthest`, `allowed`: of a single feature, in spreads.
    """

    distance: float
    threshold: float
    strangest: tuple[tuple[str, float], ...]
    farthest: float = 0.0
    allowed: float = np.inf

    @property
    def outside(self) -> bool:
        """Whether the recording is unlike the training records."""
        return not (self.distance <= self.threshold and self.farthest <= self.allowed)


@dataclass(frozen=True, slots=True)
class Prediction:
    """What the models say about one recording.

    Attributes
    ----------
    recording : MeasuredRecording
        At the rate of the model.
    pulses : ShaftPulses
    train : GearTrain
    classes : tuple of str
        In the order of the probabilities; `class_kind` says what they are: `state` or `fault`.
    votes : tuple of Vote
        The first one is the answer.
    nearness : Nearness
        By the features that the answer uses.
    plain_nearness : Nearness
        By the features without a reference; the same where none was given.
    reasons : tuple of str
        Why no answer is given; empty where one is.
    notes : tuple of str
        What the reader should know besides.
    pieces : RecordPieces
        Indicators.
    own_state : OwnState or None
        Whether the machine has changed against its own healthy recordings; None where none were given.
    """

    recording: MeasuredRecording
    pulses: ShaftPulses
    train: GearTrain
    classes: tuple[str, ...]
    votes: tuple[Vote, ...]
    nearness: Nearness
    plain_nearness: Nearness
    reasons: tuple[str, ...]
    notes: tuple[str, ...]
    pieces: RecordPieces
    own_state: OwnState | None = None
    class_kind: str = STATE

    @property
    def contradiction(self) -> str:
        """How the classifiers contradict each other; empty where they name one class, or there is one only."""
        if len({vote.named for vote in self.votes}) < 2:
            return ""
        said = (f"{vote.classifier} {self.classes[vote.named]} ({vote.probability.max():.2f})" for vote in self.votes)
        return f"the classifiers name different {self.class_kind}s: {', '.join(said)}"

    @property
    def state(self) -> str:
        """The class of largest probability, or `abstains`."""
        return "abstains" if self.reasons else self.classes[self.votes[0].named]


def predict_recording(
    model: ReleasedModel,
    recording: MeasuredRecording,
    teeth: tuple[int, int],
    speed_range_hz: tuple[float, float] | None = None,
    references: tuple[MeasuredRecording, ...] = (),
) -> Prediction:
    """Return what the models of a folder say about a recording.

    Parameters
    ----------
    model : ReleasedModel
        One that can judge recordings (`check_judges`).
    recording : MeasuredRecording
        With the model's channels.
    teeth : (int, int)
        Teeth of both gears.
    speed_range_hz : (float, float), optional
        Where to look for the first shaft's speed without a tacho.
    references : tuple of MeasuredRecording
        Recordings of the same machine in healthy state; with them the healthy-referenced variant answers.

    Raises
    ------
    UsageError
        If a channel is in another unit than in training, pulses cannot be found, or a reference is the recording
        itself.
    """
    for one in (recording, *references):
        check_units(model.facts, one)
    _check_references(recording, references)
    facts, source = model.facts, recording
    recording = at_rate(recording, facts.fs_hz)
    train = pair_train(teeth, facts.names[0])
    pulses = shaft_pulses(recording, train, speed_range_hz)
    pieces = record_pieces(recording, pulses, train, facts.duration_s, model.settings, model.own)
    plain = _nearness(model.distance, log_values(pieces.columns(model.distance.features)), pulses.speed_hz)
    healthy = tuple(_reference(model, reference, train, speed_range_hz) for reference in references)
    if healthy:
        answer, nearness = _referenced_vote(model, pieces, healthy, pulses.speed_hz)
    else:
        said = model.classifier.probability(pieces.columns(model.classifier.features))
        answer, nearness = _vote(INDICATORS, said, model.classifier.temperature), plain
    network, notes = _network_vote(model, pieces, teeth)
    every = (answer, *network)
    votes = tuple(replace(vote, accuracy=model.accuracy.get(vote.classifier)) for vote in every)
    unreferenced = not (recording.simulated or healthy)
    own = own_state(pieces, [found for _, _, found in healthy]) if healthy else None
    undefined = int(np.isnan(pieces.columns(model.classifier.features)).any(axis=0).sum())
    return Prediction(
        recording=recording,
        pulses=pulses,
        train=train,
        classes=facts.classes,
        votes=() if unreferenced else votes,
        nearness=nearness,
        plain_nearness=plain,
        reasons=(
            *([NO_REFERENCE] if unreferenced else []),
            *_direction_reasons(own, facts.classes[answer.named]),
            *_distance_reasons(plain, nearness),
            *known_reasons(facts, source, pulses, teeth, pieces),
            *(text for found in healthy for text in reference_reasons(facts, *found, pulses.speed_hz)),
        ),
        notes=tuple(note for note in (*pieces.notes, model.note, *notes, _undefined_note(undefined)) if note),
        pieces=pieces,
        own_state=own,
        class_kind=facts.class_kind,
    )


def _direction_reasons(own: OwnState | None, named: str) -> list[str]:
    """Return why the classifier's state cannot be the change that was found."""
    if own is None or not own.contradicts(named):
        return []
    return [f"against its own healthy recordings the machine is {own.verdict}, the classifier says {named}"]


def _undefined_note(count: int) -> str:
    return f"{count} indicators are undefined here: the classifier uses their training medians" if count else ""


def _check_references(recording: MeasuredRecording, references: tuple[MeasuredRecording, ...]) -> None:
    """Refuse the recording as its own reference; one channel suffices, since noise does not repeat."""
    for reference in references:
        if any(np.array_equal(signal, reference.channels[name]) for name, signal in recording.channels.items()):
            raise UsageError(
                f"{reference.path}: has the same samples as the recording {recording.path}; a difference to "
                "itself hides damage. Give another recording of the same machine in healthy state (another file, or "
                "another row in --reference FILE:ROW), or leave --reference out"
            )


def _reference(
    model: ReleasedModel,
    reference: MeasuredRecording,
    train: GearTrain,
    speed_range_hz: tuple[float, float] | None,
) -> Reference:
    slow = at_rate(reference, model.facts.fs_hz)
    pulses = shaft_pulses(slow, train, speed_range_hz)
    return reference, pulses, record_pieces(slow, pulses, train, model.facts.duration_s, model.settings, model.own)


def _vote(name: str, probability: np.ndarray, temperature: float) -> Vote:
    """Return the mean of what a classifier says of all pieces, (pieces, states)."""
    mean = tempered(probability.mean(axis=0, keepdims=True), temperature)[0]
    agreement = float(np.mean(probability.argmax(axis=1) == mean.argmax())) if len(probability) > 1 else None
    return Vote(name, mean, agreement)


def _referenced_vote(
    model: ReleasedModel, pieces: RecordPieces, healthy: tuple[Reference, ...], speed_hz: float
) -> tuple[Vote, Nearness]:
    classifier, distance = model.referenced_classifier, model.referenced_distance
    assert classifier is not None
    assert distance is not None

    def minus_reference(names: tuple[str, ...]) -> np.ndarray:
        reference = log_mean(np.concatenate([found.columns(names) for _, _, found in healthy]))
        return np.asarray(log_values(pieces.columns(names)) - reference)

    vote = _vote(REFERENCED, classifier.probability(minus_reference(classifier.features)), classifier.temperature)
    return vote, _nearness(distance, minus_reference(distance.features), speed_hz)


def _nearness(distance: TrainingDistance, logs: np.ndarray, speed_hz: float) -> Nearness:
    found = distance.distance(logs, np.full(len(logs), speed_hz))
    middle = int(np.argsort(found)[len(found) // 2])
    farthest = float(np.median(distance.farthest(logs, np.full(len(logs), speed_hz))))
    strangest = tuple(distance.strangest(logs[middle], speed_hz))
    return Nearness(float(np.median(found)), distance.threshold, strangest, farthest, distance.largest_spreads)


def _network_vote(
    model: ReleasedModel, pieces: RecordPieces, teeth: tuple[int, int]
) -> tuple[tuple[Vote, ...], tuple[str, ...]]:
    """Return the vote of the network where the pieces have them, else why not."""
    if model.network is None:
        return (), ()
    from diagnostics.training.average_rows import AveragedRecords, padded_lines
    from diagnostics.training.cnn import network_probability

    trained = model.network
    if not all(pieces.waveforms):
        return (), ("the 1-D network takes averages of two turns of the first shaft or more: left out",)
    lines = padded_lines([[piece[name] for name in trained.channels] for piece in pieces.waveforms])
    records = AveragedRecords(lines, np.full(len(lines), teeth[0]), trained.channels)
    return (_vote(NETWORK, network_probability(trained.network, records), trained.temperature),), ()


def _distance_reasons(plain: Nearness, nearness: Nearness) -> list[str]:
    """Return why the distance forbids an answer.

    A foreign machine stays foreign with a reference: differences look alike on machines whose states they do not tell.
    """
    found = []
    judged = {"training records": plain}
    if nearness is not plain:
        judged["differences to a reference in training"] = nearness
    for what, near in judged.items():
        if near.outside:
            strangest = ", ".join(f"{name} {off:+.1f} spreads" for name, off in near.strangest)
            found.append(
                f"unlike the {what}: the distance is {near.distance:.2f}, on held-out gearboxes it was at most "
                f"{near.threshold:.2f}; one indicator is {near.farthest:.1f} spreads off, at most {near.allowed:.1f} "
                f"there (largest deviations: {strangest})"
            )
    return found
