"""The part of the model card on use with recordings: what the models are limited to, and when they abstain."""

from __future__ import annotations

from diagnostics.prediction.release import Release


def release_card(found: Release) -> str:
    """Return the section as Markdown."""
    facts, distance = found.facts, found.distance
    teeth = ", ".join(f"{a}/{b}" for a, b in facts.teeth)
    lines = [
        "## Use on recordings",
        f"* digest of the set's manifest (the manifest holds the hash of every file): `{facts.manifest_digest}`",
        f"* `model.json`: channels ({', '.join(facts.channels)}), {facts.fs_hz:g} Hz, {teeth} teeth, "
        f"{facts.speed_range_hz[0]:.3g} to {facts.speed_range_hz[1]:.3g} Hz pinion speed, "
        f"{facts.torque_range_nm[0]:.3g} to {facts.torque_range_nm[1]:.3g} N m in training and validation. Outside "
        "these ranges no answer is given. Torque is not checked, because a recording does not contain it.",
        f"* distance to the training records: the threshold is {distance.threshold:.2f}, from "
        f"{distance.held_out_specimens} held-out specimens. It refuses {found.test_outside:.1%} of the test records, "
        "which are of the same family.",
    ]
    if found.referenced:
        accuracy = found.referenced.scores.accuracy.value
        lines.append(
            "* `referenced_classifier.skops`: uses log features minus those of healthy records of the same gearbox in "
            f"another state, repeat or operating point. Its accuracy is {accuracy:.2f} on test specimens."
        )
    return "\n\n".join([lines[0], "\n".join(lines[1:])]) + "\n"
