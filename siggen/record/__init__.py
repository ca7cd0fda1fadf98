"""One simulated record: channels, labels, internals and rows of damage."""
