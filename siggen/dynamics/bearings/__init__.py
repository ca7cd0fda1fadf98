"""Rolling bearings: how their balls turn and share the load, and what a spall takes from a ball."""
