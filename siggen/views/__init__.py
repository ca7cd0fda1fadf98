"""What commands tabulate and draw, each with its figure."""
