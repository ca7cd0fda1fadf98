"""Fault classifiers and sideband indicators, trained and judged on sets that siggen wrote."""
