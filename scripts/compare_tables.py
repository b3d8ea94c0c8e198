"""How far two tables of results are apart: of how many numbers, and how far over the largest of their column.

Usage: compare_tables.py NAME TABLE TABLE    an error if they have other rows or columns, or are further apart than 1e-6
"""

import csv
import sys

FAR = 1e-6
"""Far above last digits of libm (6e-16 was found, docs/packaging.md), far below what a run promises (1 % of means)."""


def read(path):
    with open(path) as file:
        head, *rows = csv.reader(file)
    return head, [[float(cell) for cell in row] for row in rows]


name, (head, rows), (other_head, other_rows) = sys.argv[1], *(read(path) for path in sys.argv[2:])
assert head == other_head and len(rows) == len(other_rows), f"{name}: other columns or rows"
apart, worst = 0, (0.0, "")
for k, column in enumerate(head):
    largest = max(abs(row[k]) for row in rows)
    for row, other in zip(rows, other_rows):
        if row[k] != other[k]:
            apart += 1
            # Counts of steps, and what is rounding of zeros, have no size to compare with.
            if not column.startswith("integrator.") and largest > 1e-9:
                worst = max(worst, (abs(row[k] - other[k]) / largest, column))
print(f"{name}: {apart} of {len(head) * len(rows)} numbers differ, at most by {worst[0]:.1e} of the largest of {worst[1] or 'any column'}")
sys.exit(worst[0] > FAR)
