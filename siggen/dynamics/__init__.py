"""Structure, mesh force and integrators."""
