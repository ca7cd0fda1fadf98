"""From acceleration to what a data logger stores."""
