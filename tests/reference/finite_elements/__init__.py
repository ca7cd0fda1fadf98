"""Finite elements of one tooth on its ring body: check of the tooth compliance models and source of the calibration."""
