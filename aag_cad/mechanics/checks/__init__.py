"""Checks by formula: planks, fasteners, cover, supports."""
