"""The gearbox of a record, drawn once: laws of a configuration become numbers in SI."""
