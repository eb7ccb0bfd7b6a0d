"""`python -m mocapstudio` is `mocapstudio`."""

from mocapstudio.cli import main

if __name__ == "__main__":
    main()
