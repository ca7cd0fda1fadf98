"""Which record belongs to which specimen, state, operating point and split, and what a specimen draws."""
