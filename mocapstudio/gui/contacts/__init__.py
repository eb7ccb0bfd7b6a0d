"""The parts of the Contacts workspace."""
