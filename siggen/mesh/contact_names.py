"""Names of what a tooth pair has only while it touches on its drive flank; elsewhere such quantities are NaN."""

from __future__ import annotations

PAIR_PREFIX = "pair_"
PER_CONTACT = ("hertz_pressure_pa",)
PER_FILM = ("central_film_m", "film_ratio", "asperity_share")
OF_CONTACT_ALONE = ("friction_coefficient", *PER_CONTACT, *PER_FILM)


def is_of_contact_alone(name: str) -> bool:
    """Return whether a quantity such as pair_0_film_ratio is not defined while its pair does not touch."""
    return name.endswith(OF_CONTACT_ALONE)
