"""`python -m wheelchair_fmu`: the `wheelchair` command, where its script is not on the path."""

from .cli.start import main

if __name__ == "__main__":
    main()
