"""Recordings of real machines: one reader per kind of file, units and channels as the user names them."""
