"""From a record to the order domain: angle, synchronous averages, lines and difference signals."""
