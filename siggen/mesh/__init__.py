"""How a pair of teeth gives way, touches and rubs, and the force that follows."""
