"""The two files that a driver is given. Drivers are scripts of environments that need not have this package."""

import csv


def read(inputs: str, results: str) -> tuple[list[dict[str, float]], list[str]]:
    """What is set at each sample, its time included, and the names of the results that are compared."""
    with open(inputs) as file:
        rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    with open(results) as file:
        return rows, [name for name in next(csv.reader(file)) if name != "time"]
