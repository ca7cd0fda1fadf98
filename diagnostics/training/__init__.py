"""Classifiers and the network, their scores and their files."""
