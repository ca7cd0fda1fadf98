"""The part of the model card on use with recordings: what the models are limited to, and when they abstain."""

from __future__ import annotations

from diagnostics.release.release import Release


def release_card(found: Release) -> str:
    """Return the section as Markdown."""
    facts, distance = found.facts, found.distance
    teeth = ", ".join(f"{a}/{b}" for a, b in facts.teeth)
    lines = [
        "## Use on recordings",
        f"* digest of the set's manifest, which holds the hash of every file: `{facts.manifest_digest}`",
        f"* `model.json`: channels ({', '.join(facts.channels)}), {facts.fs_hz:g} Hz, {teeth} teeth, "
        f"{facts.speed_range_hz[0]:.3g} to {facts.speed_range_hz[1]:.3g} Hz pinion speed, "
        f"{facts.torque_range_nm[0]:.3g} to {facts.torque_range_nm[1]:.3g} N m in training and validation; outside of "
        "these no answer is given, apart from the torque, which a recording does not tell",
        f"* distance to the training records: threshold {distance.threshold:.2f} from {distance.held_out_specimens} "
        f"held-out specimens; it refuses {found.test_outside:.1%} of the test records, which are of the same family",
    ]
    if found.referenced:
        accuracy = found.referenced.scores.accuracy.value
        lines.append(
            "* `referenced_classifier.skops`: on log features minus those of healthy records of the same gearbox at "
            f"other operating points; accuracy {accuracy:.2f} on test specimens"
        )
    return "\n\n".join([lines[0], "\n".join(lines[1:])]) + "\n"
