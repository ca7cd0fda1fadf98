"""Gear indicators of records, and the tables that hold them."""
