"""Contact of a tooth pair across the face: edges of missing material, coupled slices, lead and tilt."""
