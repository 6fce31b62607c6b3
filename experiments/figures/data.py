"""Reads the tables of an experiment (CSV), with what their columns mean."""

import csv
import math
import os


def read_csv(path):
    """Rows as dictionaries; an empty cell is None, a number a float, anything else text."""
    with open(path, newline="", encoding="utf-8") as file:
        return [{key: _cell(text) for key, text in row.items()} for row in csv.DictReader(file)]


def _cell(text):
    if text == "":
        return None
    try:
        number = float(text)
    except ValueError:
        return text
    return number if math.isfinite(number) else None


def unique(values):
    """Values in the order in which they first appear."""
    return list(dict.fromkeys(values))


class Experiment:
    def __init__(self, folder):
        self.folder = folder
        self.manifest = read_csv(os.path.join(folder, "manifest.csv"))
        self.columns = read_csv(os.path.join(folder, "columns.csv"))

    def sweeps(self):
        return [str(row["value"]) for row in self.manifest if row["key"] == "sweep"]

    def entry(self, key):
        found = [row["value"] for row in self.manifest if row["key"] == key]
        return found[0] if found else None

    def table(self, sweep, kind):
        """kind: runs, summary, series or apexes."""
        return read_csv(os.path.join(self.folder, f"{sweep}_{kind}.csv"))

    def length(self, sweep, kind):
        """Rows of such a table, without reading them into memory."""
        with open(os.path.join(self.folder, f"{sweep}_{kind}.csv"), "rb") as file:
            return sum(1 for _ in file) - 1

    def rows(self, table):
        """A table by its name; figures of the thesis have no sweeps."""
        return read_csv(os.path.join(self.folder, f"{table}.csv"))

    def value(self, name):
        """A single number of `values.csv`."""
        found = [row["value"] for row in self.rows("values") if row["name"] == name]
        if not found:
            raise KeyError(f"no value {name} in {self.folder}")
        return found[0]

    def column(self, sweep, name):
        for row in self.columns:
            if row["sweep"] == sweep and row["column"] == name:
                return row
        return {"unit": None, "label": name, "scale": "linear", "role": "metric"}

    def label(self, sweep, name):
        column = self.column(sweep, name)
        unit = f" / {column['unit']}" if column["unit"] else ""
        return str(column["label"]).replace("_", " ") + unit

    def axes(self, sweep):
        return [str(row["column"]) for row in self.columns
                if row["sweep"] == sweep and row["role"] == "axis"]


def pick(rows, **wanted):
    """Rows whose columns have these values."""
    return [row for row in rows if all(row[key] == value for key, value in wanted.items())]


def points(rows, x, y):
    """Two lists without the rows that have no value."""
    kept = [(row[x], row[y]) for row in rows if row[x] is not None and row[y] is not None]
    return [p[0] for p in kept], [p[1] for p in kept]
