"""Oil film, asperities and friction between the flanks."""
