"""Involute, tooth root, gear pair, path of contact and what tip relief takes away."""
