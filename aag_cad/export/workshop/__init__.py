"""What the workshop and its machines read."""
