"""Versions of a set's files and of the simulation that filled them; docs/develop/versions.md says when they rise."""

from __future__ import annotations

SCHEMA_VERSION = "8"
"""Version of the columns and of the files around them: the one that is written and read."""

SIMULATION_VERSION = 11
"""Raised, at most once per release, when a configuration of an earlier release comes to give a record other numbers."""
