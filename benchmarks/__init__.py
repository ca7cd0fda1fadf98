"""What siggen costs: each speed beside a named alternative measured in the same run."""
