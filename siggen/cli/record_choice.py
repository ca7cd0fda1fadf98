"""The record that a command asks for of a YAML file or a set's folder, and its gearbox."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from siggen.gearbox.design import SetDesign
    from siggen.gearbox.plan import PlannedRecord
    from siggen.gearbox.specimen import Specimen


def chosen_record(source: Path, record: int, overrides: Sequence[str]) -> tuple[SetDesign, Specimen, PlannedRecord]:
    """Return the design of a file or folder, the gearbox of a record, and where that stands.

    Raises
    ------
    UsageError
        If it has no such record.
    """
    from siggen.checks.loading import load_config
    from siggen.gearbox.plan import expect_record, planned_record

    design = load_config(source / "config.yaml" if source.is_dir() else source, overrides)
    expect_record(design, record, "--record")
    planned = planned_record(design, record)
    return design, design.gearbox(planned.specimen_id), planned
