"""What moves the gearbox from outside: speed, torque and external forces over time."""
