"""Compliance of teeth, gear bodies and contacts, and the mesh stiffness that follows."""
