"""A gearbox housing as one body: six plates on bolts, from its geometry to natural modes and accelerance."""
