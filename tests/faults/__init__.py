"""Faults made on purpose, and what came of them: flipped bits, hostile files, shortages, kills; one digest of all ways.

In their rows `measured` is how many were found or refused, `alternative` what else happened, the goal is all of them.
"""

PARTS = (
    *("mutated_configurations", "mutated_recordings", "hostile_files", "foreign_sets", "bit_flips", "digests"),
    *("mutated_answers", "shortages", "kills"),
)
"""Each by itself: `python -m tests.faults kills`."""
