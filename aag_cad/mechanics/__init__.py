"""What planks, web and supports bear: stresses, frame engine, prefabrication, hole rules, cover, footings."""
