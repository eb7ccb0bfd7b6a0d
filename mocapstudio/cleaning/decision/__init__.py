"""The decision learnt from the user's own context: residual features, examples, trees."""
