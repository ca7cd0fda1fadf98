"""One machine against its own healthy recordings: whether it has changed, without any model of its faults."""
