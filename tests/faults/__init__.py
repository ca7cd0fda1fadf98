"""Faults made on purpose, and what came of them: flipped bits, mutated and foreign files, shortages, kills.

In their rows `measured` is how many were found or refused, `alternative` what else happened, the goal is all of them.
"""

PARTS = (*("mutated_configurations", "mutated_recordings", "foreign_sets", "bit_flips", "shortages", "kills"),)
"""Each by itself: `python -m tests.faults kills`."""
