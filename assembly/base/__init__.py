"""Steps, crews, ranges of marks, groups of parts, words: what every room of the planner speaks in."""
