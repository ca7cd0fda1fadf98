"""What is added to channels, each source a module: what a user writes, what it adds to a block, its column."""
