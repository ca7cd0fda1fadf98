"""The command `siggen-diagnostics`."""
