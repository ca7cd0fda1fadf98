"""What a prediction says, in sentences written from its numbers."""

from __future__ import annotations

from importlib.metadata import version

from diagnostics.page.wording import capitalised, counted, joined, percent
from diagnostics.prediction.model_facts import ModelFacts
from diagnostics.prediction.prediction import Prediction, Vote

TITLES = {
    "healthy_referenced": "differences from the healthy reference",
    "network": "the network",
    "circular": "the circular network",
}


def prediction_summary(found: Prediction) -> list[str]:
    """Return the answer or why there is none, the votes, the distance, and what they rest on."""
    votes = [
        f"{found.classes[vote.named]} by {TITLES.get(vote.classifier, vote.classifier)} ({_weight(vote)})"
        for vote in found.votes
    ]
    near = found.nearness
    side = "beyond" if near.outside else "within"
    speed = f"{found.pulses.speed_hz:.4g}\N{NO-BREAK SPACE}Hz"
    if found.reasons:
        reasons = [f"{capitalised(reason.rstrip('.'))}." for reason in found.reasons]
        answer = f"The models give no answer for this recording. {' '.join(reasons)}"
    else:
        answer = f"The recording is most like the state {found.state}."
        if found.contradiction:
            answer += f" This answer is weak: {found.contradiction}."
    if (own := found.own_state) is not None:
        told = "nothing can be said" if own.score is None else f"the machine is {own.verdict}"
        answer = f"Against its own healthy recordings {told} ({own.reason}). {answer}"
    withheld = " Do not use these states." if found.reasons else ""
    return [
        answer,
        *([f"The most probable state is {joined(votes)}.{withheld}"] if votes else []),
        f"Its distance to the training records is {near.distance:.2f}, {side} the threshold of {near.threshold:.2f}.",
        f"The models used {counted(len(found.pieces.values), 'piece')} of {found.pieces.revolutions} or more pinion "
        f"revolutions. The pinion speed is {speed}, from the {found.pulses.origin}.",
    ]


def _weight(vote: Vote) -> str:
    """Return how sure a vote is, how far its pieces agree, and how often its classifier was right."""
    agree = [] if vote.agreement is None else [f"{percent(vote.agreement)} of the {vote.parts} agree"]
    right = [] if vote.accuracy is None else [f"right in {percent(vote.accuracy.value)} of its test records"]
    return "; ".join([percent(float(vote.probability.max())), *agree, *right])


def model_provenance(facts: ModelFacts) -> str:
    """Return which program made the page, and which set the models were trained on."""
    return (
        f"Made by siggen-diagnostics {version('siggen')} with models trained on the set {facts.set_name}, identity "
        f"{facts.identity}."
    )
