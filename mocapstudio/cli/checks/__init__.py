"""What `mocapstudio doctor` looks at: one file a check.

A check is a function that returns findings. What could take the process down (a broken driver, a
missing library) is tried in a process of its own.
"""
