"""What is offered for a flag: joint estimates, donors, exchanged sides, and the root."""
