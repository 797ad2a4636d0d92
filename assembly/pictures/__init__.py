"""Which picture a step gets, and the drawings that need a plan or a layout."""
