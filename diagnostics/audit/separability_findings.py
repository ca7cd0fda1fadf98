"""All traps of the separability audit, and the verdict on them."""

from __future__ import annotations

from collections.abc import Sequence

from diagnostics.audit.bank_detections import ChanceLimit
from diagnostics.audit.condition_traps import condition_traps
from diagnostics.audit.damage_phase import damage_phase
from diagnostics.audit.detectability import FEWEST_SPECIMENS
from diagnostics.audit.error_draws import error_draws
from diagnostics.audit.finding import Finding
from diagnostics.audit.gearboxes_needed import gearboxes_needed
from diagnostics.audit.healthy_sidebands import healthy_sidebands
from diagnostics.audit.measured_set import MeasuredSet
from diagnostics.audit.noise_copies import noise_copies
from diagnostics.audit.shared_specimens import shared_specimens
from diagnostics.audit.simple_thresholds import simple_thresholds
from diagnostics.audit.solver_settings import solver_settings
from diagnostics.audit.state_ties import state_ties
from diagnostics.page.wording import counted, decimal

TRIVIAL = (
    "healthy_without_sidebands",
    "slight_separable_by",
    "state_tied_to",
    "state_told_by",
    "constant_damage_phase",
)


def separability_findings(measured: MeasuredSet, seed: int = 0) -> list[Finding]:
    """Return every finding, in the order of the traps.

    Attackers on conditions name no cause, so they speak only where nothing more exact was found.
    """
    named = [
        *shared_specimens(measured),
        *healthy_sidebands(measured),
        *simple_thresholds(measured, seed),
        *state_ties(measured, seed),
        *solver_settings(measured),
        *error_draws(measured),
        *noise_copies(measured),
        *damage_phase(measured),
    ]
    return named or condition_traps(measured, seed)


def verdict(findings: Sequence[Finding], specimens: int, chance: ChanceLimit | None = None) -> str:
    """Return what the findings mean for scores on a set of so many specimens, beside what chance reaches there."""
    if not findings and specimens < FEWEST_SPECIMENS:
        return (
            f"No trap was found. Few traps can be found with {counted(specimens, 'gearbox')}. Scores on this set say "
            "nothing about other gearboxes."
        )
    needed = gearboxes_needed(chance, specimens)
    if not findings and chance and needed:
        return (
            f"There are too few gearboxes to tell: chance reaches an AUC of {decimal(chance.auc)}. Use at least "
            f"{counted(needed, 'gearbox')} in place of {specimens}."
        )
    if not findings:
        return (
            "No trap was found. As far as the audit can see, scores on unseen specimens of this set measure the damage."
        )
    trivial = [finding.trap for finding in findings if finding.trap.startswith(TRIVIAL)]
    if trivial:
        return (
            f"The set is trivially separable ({', '.join(trivial)}). A detection score on it says nothing about real "
            "gearboxes."
        )
    found = "A trap was" if len(findings) == 1 else f"{len(findings)} traps were"
    return f"{found} found. Scores on this set do not measure what they seem to measure."
