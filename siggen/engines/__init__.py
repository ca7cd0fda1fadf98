"""Ways to run independent tasks."""
