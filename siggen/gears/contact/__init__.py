"""Contact of a tooth pair across the face."""
