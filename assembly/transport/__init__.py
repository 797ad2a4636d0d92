"""What travels: segments, how they are found, spliced, slung and kept stiff on the way."""
