"""Whole sets: generation and verification."""
