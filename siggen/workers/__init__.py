"""Who runs independent tasks: any executor of `concurrent.futures`."""
