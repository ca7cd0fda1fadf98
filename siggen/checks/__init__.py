"""What cannot be, and what should be said, before anything is simulated."""
