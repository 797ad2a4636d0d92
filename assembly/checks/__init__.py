"""Independent walks over a plan."""
