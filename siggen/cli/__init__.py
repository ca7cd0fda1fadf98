"""The siggen command."""
