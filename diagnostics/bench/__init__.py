"""A benchmark whose test labels nobody can get from what is published: making, sealing, revealing, baselines, board."""
