"""Plan, records, shards and manifest."""
