"""Small parts that several views are made of. They know nothing of the document."""
