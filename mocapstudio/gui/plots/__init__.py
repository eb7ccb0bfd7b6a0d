"""What the plots of the desk are made of: time, rows, colours, curves."""
