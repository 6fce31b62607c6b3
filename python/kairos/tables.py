"""Tables (CSV) that the program writes."""

from __future__ import annotations

import csv
import itertools
import os

import numpy as np


def _are_numbers(texts):
    try:
        for text in texts:
            if text:
                float(text)
    except ValueError:
        return False
    return True


class _ColumnFile:
    """A column that grows, in a file that appears whole: `numpy.save` of an array too large for
    memory."""

    def __init__(self, path, kind, count):
        self._path, self._kind = path, kind
        self._file = open(path + ".part", "wb")
        np.lib.format.write_array_header_1_0(
            self._file, {"descr": np.lib.format.dtype_to_descr(kind), "fortran_order": False,
                         "shape": (count,)})

    def add(self, texts):
        if self._kind.kind == "S":
            values = [text.encode() for text in texts]
        else:
            values = [float(text) if text else np.nan for text in texts]
        self._file.write(np.array(values, dtype=self._kind).tobytes())

    def finish(self):
        self._file.close()
        os.replace(self._path + ".part", self._path)


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
        _, _, numbers = self._shape()
        types = {name: pyarrow.float64() if name in numbers else pyarrow.string()
                 for name in self.columns}
        reader = pyarrow.csv.open_csv(
            self.path, convert_options=pyarrow.csv.ConvertOptions(
                column_types=types, strings_can_be_null=True))
        with pyarrow.parquet.ParquetWriter(path, reader.schema) as writer:
            for batch in reader:
                writer.write_batch(batch, row_group_size=rows_at_once)
        return path

    def to_npy(self, folder):
        """Writes the table as one file per column, NAME.npy, row by row, in constant memory: numbers
        as doubles with the bits of the CSV (an empty cell is nan), text as bytes (UTF-8) of its
        greatest length. Needs numpy alone, where no Parquet is: `np.load(path, mmap_mode="r")` reads
        a column without the others. Returns the paths by column."""
        folder = os.fspath(folder)
        os.makedirs(folder, exist_ok=True)
        count, widths, numbers = self._shape()
        paths, columns = {}, {}
        for place, name in enumerate(self.columns):
            kind = np.dtype(float) if name in numbers else np.dtype(f"S{max(1, widths[place])}")
            paths[name] = os.path.join(folder, name + ".npy")
            columns[place] = _ColumnFile(paths[name], kind, count)
        with open(self.path, newline="", encoding="utf-8") as file:
            reader = csv.reader(file)
            next(reader)
            while rows := list(itertools.islice(reader, 10_000)):
                for place, texts in enumerate(zip(*rows)):
                    columns[place].add(texts)
        for column in columns.values():
            column.finish()
        return paths

    def _shape(self):
        """Rows, the longest text of each column in bytes, names of columns that are numbers."""
        count, widths, numbers = 0, [0] * len(self.columns), set(range(len(self.columns)))
        with open(self.path, newline="", encoding="utf-8") as file:
            reader = csv.reader(file)
            next(reader)
            while rows := list(itertools.islice(reader, 10_000)):
                count += len(rows)
                for place, texts in enumerate(zip(*rows)):
                    if place in numbers and not _are_numbers(texts):
                        numbers.discard(place)
                    widths[place] = max(widths[place], max(len(text.encode()) for text in texts))
        return count, widths, {self.columns[place] for place in numbers}

    def __repr__(self):
        return f"<kairos.Table {self.path}: {', '.join(self.columns)}>"
