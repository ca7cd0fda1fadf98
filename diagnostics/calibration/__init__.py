"""A machine's healthy recordings as a configuration: what they tell is fitted, what they do not tell stays wide."""
