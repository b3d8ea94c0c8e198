"""Results of studies that couple a machine in several ways at several communication steps, as CSV."""

import csv


def write(path, columns, rows):
    """Writes rows, one of each way and step; cells that they do not have are empty."""
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, columns, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def read(path):
    """Rows as written, by way and step [us]."""
    with open(path, newline="") as file:
        return {(row["way"], int(row["step [us]"])): row for row in csv.DictReader(file)}
