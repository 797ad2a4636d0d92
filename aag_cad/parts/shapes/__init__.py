"""The six shapes that parts have: bar, prism, box, threaded, folded plate and sheet."""
