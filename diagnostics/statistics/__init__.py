"""Scores and their intervals, calibration, detectable sizes."""
