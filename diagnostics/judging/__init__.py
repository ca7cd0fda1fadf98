"""Who learns, who is judged, and which pairs of records count: detectors, designs, one evaluation."""
