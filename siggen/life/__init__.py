"""How damage begins and grows over the life of one gearbox: laws, and the flanks that they act on."""
