"""A prediction as JSON and as lines for the terminal."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from diagnostics.page.wording import counted
from diagnostics.prediction.known_reasons import OwnState
from diagnostics.prediction.model_facts import ModelFacts
from diagnostics.prediction.prediction import Nearness, Prediction, Vote

MEANING = (
    "The models were trained on simulated records only. No measured pitting was used. A probability compares the "
    "simulated states: it says which of them the recording is most like. It is not the probability that the gear is "
    "damaged."
)


def prediction_facts(found: Prediction, facts: ModelFacts) -> dict[str, Any]:
    """Return everything about a prediction as JSON can hold it; undefined numbers are null."""
    middle = np.array([_median(column) for column in found.pieces.values.T])
    return {
        "file": str(found.recording.path),
        "state": found.state,
        "reasons_to_abstain": list(found.reasons),
        "contradiction": found.contradiction or None,
        "against_own_healthy_state": _own_state(found.own_state),
        "probabilities": {
            vote.classifier: {
                **dict(zip(found.classes, vote.probability.tolist(), strict=True)),
                "share_of_pieces_that_agree": vote.agreement,
                "test_accuracy": vote.accuracy.numbers() if vote.accuracy else None,
            }
            for vote in found.votes
        },
        "distance": _nearness(found.nearness),
        "distance_without_reference": _nearness(found.plain_nearness),
        "pinion_speed_hz": found.pulses.speed_hz,
        "mesh_frequency_hz": found.pulses.speed_hz * found.teeth[0],
        "speed_from": found.pulses.source,
        "speed_certainty": found.pulses.certainty,
        "teeth": list(found.teeth),
        "pieces": len(found.pieces.values),
        "revolutions_per_piece": found.pieces.revolutions,
        "notes": list(found.notes),
        "meaning": MEANING,
        "model": {
            "set": facts.set_name,
            "identity": facts.identity,
            "manifest_digest": facts.manifest_digest,
        },
        "indicators": {
            name: value if math.isfinite(value) else None
            for name, value in zip(found.pieces.names, middle.tolist(), strict=True)
        },
    }


def _median(values: np.ndarray) -> float:
    finite = values[np.isfinite(values)]
    return float(np.median(finite)) if finite.size else math.nan


def _own_state(found: OwnState | None) -> dict[str, Any] | None:
    return None if found is None else {"verdict": found.verdict, "reason": found.reason}


def _nearness(found: Nearness) -> dict[str, Any]:
    return {
        "value": found.distance,
        "threshold": found.threshold,
        "outside": found.outside,
        "farthest_off_in_spreads": dict(found.strangest),
    }


def prediction_rows(found: Prediction) -> list[tuple[str, str]]:
    """Return what the terminal and the page show first: label and text."""
    pulses = found.pulses
    pieces = counted(len(found.pieces.values), "piece")
    own = found.own_state
    rows = [
        *([] if own is None else [("against its own healthy state", f"{own.verdict} ({own.reason})")]),
        ("answer", found.state),
        ("pinion speed", f"{pulses.speed_hz:.4f} Hz ({pulses.origin}); mesh {pulses.speed_hz * found.teeth[0]:.2f} Hz"),
        ("averaged", f"{pieces} of {found.pieces.revolutions} or more pinion revolutions"),
    ]
    for vote in found.votes:
        rows.append((f"by {vote.classifier}", _vote_text(found, vote)))
    near = found.nearness
    rows.append(("distance to training", f"{near.distance:.2f}, threshold {near.threshold:.2f}"))
    if found.plain_nearness is not found.nearness:
        plain = found.plain_nearness
        rows.append(("without reference", f"{plain.distance:.2f}, threshold {plain.threshold:.2f}"))
    rows += [("abstains because", reason) for reason in found.reasons]
    rows += [("weak answer", found.contradiction)] if found.contradiction else []
    return [*rows, *(("note", note) for note in found.notes)]


def _vote_text(found: Prediction, vote: Vote) -> str:
    shares = ", ".join(f"{state} {share:.2f}" for state, share in zip(found.classes, vote.probability, strict=True))
    agree = "" if vote.agreement is None else f"; {vote.agreement:.0%} of {vote.parts} agree"
    right = "" if vote.accuracy is None else f"; right in {vote.accuracy.value:.0%} of its test records"
    return f"{shares}{agree}{right}{' (do not use)' if found.reasons else ''}"
