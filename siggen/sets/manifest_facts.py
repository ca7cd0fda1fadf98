"""What a manifest says of a set beside its files: name, identity, channels, sampling, stored quantities."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from siggen.columns.record import channels
from siggen.dataset.card_making import stated_tolerance
from siggen.keys.column import Column
from siggen.planning.plan import rows_per_group

if TYPE_CHECKING:
    from siggen.config import Config


def manifest_facts(config: Config, quantities: Sequence[Column]) -> dict[str, Any]:
    """Return the facts; `quantities` are the columns of `internals/`, none where a set stores none."""
    internals = [{"name": c.name, "unit": c.unit, "meaning": c.meaning} for c in quantities]
    return {
        **({"internals": internals} if internals else {}),
        "name": config.name,
        "identity": config.identity,
        "seed": config.seed,
        "specimens": config.specimens,
        "fs_hz": float(config.fs_hz),
        "duration_s": float(config.duration_s),
        "rows_per_group": rows_per_group(config),
        "channels": [asdict(channel) for channel in channels(config)],
        **({} if (tolerance := stated_tolerance(config)) is None else {"integration_tolerance": tolerance}),
    }
