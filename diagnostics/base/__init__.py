"""What every room needs: seeds, progress, optional packages."""
