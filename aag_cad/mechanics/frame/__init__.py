"""The frame engine, and a shell as a frame."""
