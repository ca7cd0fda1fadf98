"""Equations of motion, their integration, and the response at the samples."""
