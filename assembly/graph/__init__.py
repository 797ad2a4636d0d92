"""The graph of parts and joints: its files and faults, who lies over whom, what is slid in."""
