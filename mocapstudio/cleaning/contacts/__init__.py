"""Contacts: when an end effector rests on the floor, or holds on to something."""
