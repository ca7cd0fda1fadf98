"""A finding of the separability audit: what was measured, against which bound, and how to mend the configuration.

Which label columns are conditions of a record, by group, and how a tie of the state to one is mended.
"""

from __future__ import annotations

import re
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ColumnGroup:
    """Label columns that one part of the configuration draws."""

    name: str
    pattern: str
    mend: str


GROUPS = (
    ColumnGroup(
        "solver",
        r"integrator|solver|steps?_per|time_step|tolerance|table_points|damping_option",
        "Use one solver setting for all states.",
    ),
    ColumnGroup(
        "start",
        r"start_(angle|turn)|seed",
        "Draw start angle and seeds per record, by one law for all states.",
    ),
    ColumnGroup(
        "noise",
        r"noise|floor|mains|hum|background|tone|bearing_tone",
        "Draw the noise by one law for all states, in the unit of the channel and not from the level of the record.",
    ),
    ColumnGroup(
        "path",
        r"path|sensor|gain|sensitivity|mount|cross_axis|axis|delay|resonance|mode_|residue",
        "Draw the transfer path per specimen and use it for all states of that specimen.",
    ),
    ColumnGroup(
        "manufacture",
        r"error|pitch_dev|runout|eccentric|misalign|lead|f_pt|f_p_|f_ha|f_fa|grade|iso|manufactur|relief|tolerance_share",
        "Draw the errors per specimen and keep them in all its states, or draw them anew in every state alike.",
    ),
    ColumnGroup(
        "length",
        r"^samples$|duration|revolutions|length_s$",
        "Give all records the same length. Do not pad.",
    ),
    ColumnGroup(
        "operation",
        r"speed|torque|_hz$|load|temperature|ripple|slip|pulses_per_s|operating",
        "Use the same operating points for all states of a specimen.",
    ),
    ColumnGroup("status", r"^status", "Find out why records of one state fail or end otherwise, and draw again."),
    ColumnGroup("other", r"", "Draw this quantity by one law for all states."),
)

CONSEQUENCES = re.compile(
    r"^(record_id|specimen_id|state_id|state|split|repeat|fault|severity|faulty_.*|damage.*|contact_length_loss.*|"
    r"mesh_stiffness_loss.*|through_face|sham|changed_keys|has_.*|sink_depth_.*|contact_loss_share|integration_error|snr_.*|clipped_share_.*|"
    r"(.*_)?(pits?|spalls?|film|lambda|asperity|friction)(_.*)?)$"
)
"""Identities, what the damage is, and what follows from it: these may differ between states."""


def column_group(name: str) -> ColumnGroup | None:
    """Return the group of a label column, or None for identities, damage and its consequences."""
    if CONSEQUENCES.match(name):
        return None
    return next(group for group in GROUPS if re.search(group.pattern, name.lower()))


@dataclass(frozen=True, slots=True)
class Finding:
    """One reason why scores on the set would not mean what they seem to.

    Attributes
    ----------
    trap : str
        Which trap: a fixed word, such as `state_tied_to_operation`.
    measured : str
        What was measured.
    bound : str
        What it was compared with.
    mend : str
        How to change the configuration.
    """

    trap: str
    measured: str
    bound: str
    mend: str

    def line(self) -> str:
        """Return the finding on one line."""
        return f"{self.trap}: {self.measured}. Bound: {self.bound}. To correct it: {self.mend}"
