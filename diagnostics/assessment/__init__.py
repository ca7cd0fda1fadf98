"""How good each indicator is: separation, trend, sensitivity, smallest size found, in both designs, with intervals."""
