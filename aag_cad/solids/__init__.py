"""CadQuery shapes of the parts."""
