"""Versions of a set's files and of the simulation that filled them; docs/develop/versions.md says when each one rises.

A configuration's identity has a version of its own (`siggen.config.config`), which never rises.
"""

from __future__ import annotations

SCHEMA_VERSION = "4"
"""Version of the columns and of the files around them that is written."""

WITHOUT_ROLES = "3"
"""Version whose manifests list no columns; the configuration says their roles."""

READ_VERSIONS = (WITHOUT_ROLES, SCHEMA_VERSION)
"""Versions that are read; nothing older was ever released."""

SIMULATION_VERSION = 10
"""Raised, at most once per release, when a configuration of an earlier release comes to give a record other numbers."""
