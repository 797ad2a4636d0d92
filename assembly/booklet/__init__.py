"""Pages for the crew: cards, booklet, page for telephones, chart, calendar."""
