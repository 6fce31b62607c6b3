"""Tables (CSV) that the program writes."""

from __future__ import annotations

import csv
import os

import numpy as np


class Table:
    """A table in a file: its columns are read when they are asked for, and never all at once
    unless one asks.

    table["max_depth"]: a column, (rows,) of float (an empty cell is nan) or of str.
    """

    def __init__(self, path):
        self.path = os.fspath(path)
        with open(self.path, newline="", encoding="utf-8") as file:
            #: names of the columns
            self.columns = next(csv.reader(file))

    def rows(self):
        """Row by row, as dicts of text: in constant memory."""
        with open(self.path, newline="", encoding="utf-8") as file:
            yield from csv.DictReader(file)

    def __getitem__(self, name) -> np.ndarray:
        if name not in self.columns:
            raise KeyError(f"no column {name!r}; there are: {', '.join(self.columns)}")
        place = self.columns.index(name)
        with open(self.path, newline="", encoding="utf-8") as file:
            reader = csv.reader(file)
            next(reader)
            texts = [row[place] for row in reader]
        try:
            return np.array([float(text) if text else np.nan for text in texts])
        except ValueError:
            return np.array(texts, dtype=str)

    def __len__(self):
        return sum(1 for _ in self.rows())

    def to_pandas(self, **options):
        """A pandas.DataFrame; options as of pandas.read_csv. Needs pandas."""
        import pandas
        return pandas.read_csv(self.path, **options)

    def to_parquet(self, path, rows_at_once=100_000):
        """Writes the table as Parquet, block by block, in constant memory. Needs pyarrow.
        Numbers are doubles: the same bits as in the CSV."""
        import pyarrow
        import pyarrow.csv
        import pyarrow.parquet
        numbers = self._numeric_columns()
        types = {name: pyarrow.float64() if name in numbers else pyarrow.string()
                 for name in self.columns}
        reader = pyarrow.csv.open_csv(
            self.path, convert_options=pyarrow.csv.ConvertOptions(
                column_types=types, strings_can_be_null=True))
        with pyarrow.parquet.ParquetWriter(path, reader.schema) as writer:
            for batch in reader:
                writer.write_batch(batch, row_group_size=rows_at_once)
        return path

    def _numeric_columns(self):
        """Columns that hold nothing but numbers and empty cells, looked at row by row."""
        numeric = set(self.columns)
        for row in self.rows():
            for name in list(numeric):
                if row[name]:
                    try:
                        float(row[name])
                    except ValueError:
                        numeric.discard(name)
        return numeric

    def __repr__(self):
        return f"<kairos.Table {self.path}: {', '.join(self.columns)}>"
