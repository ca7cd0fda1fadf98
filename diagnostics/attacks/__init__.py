"""Cheap attackers of a set: how well states are told on gearboxes that were not seen, and what chance alone reaches."""
