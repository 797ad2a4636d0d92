"""Tables, purchases, summary, plan files, pictures and reports."""
