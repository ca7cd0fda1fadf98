"""What the columns of a table of records are to whoever learns from them: condition, target, key; read, never guessed.

Only a target is to be predicted, and only a condition is known before a measurement. What follows from the damage, as
the loss of mesh stiffness does, would give the answer away.
"""

from __future__ import annotations

from diagnostics.records.state_classes import CLASS

KEY, CONDITION, MEASURED, CONSEQUENCE, TARGET = "key", "condition", "measured", "consequence", "target"
LABEL_ROLES = {
    **dict.fromkeys(("record_id", "specimen_id", "state_id", "operating_point_id", "repeat", "split"), KEY),
    **dict.fromkeys(("teeth_pinion", "teeth_gear", "speed_hz", "torque_nm"), CONDITION),
    **dict.fromkeys(("state", CLASS, "fault", "severity", "damaged_area_mm2", "damaged_area_share"), TARGET),
    "through_face": TARGET,  # where a set has it
    "mesh_stiffness_loss": CONSEQUENCE,
}
"""Role of every label that goes along with indicators."""
