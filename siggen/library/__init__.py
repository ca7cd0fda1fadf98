"""siggen as a library: gearboxes, damage and sensors as objects that are composed, and records of them."""
