"""The queue as a table: model, filter, drawing."""
