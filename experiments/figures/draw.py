"""Draws the figures of one experiment: python3 draw.py SCRIPT FOLDER

SCRIPT is a module of this folder with a function draw(data, figures); FOLDER holds the tables that
`kairos experiment` or `kairos sweep` wrote. Figures appear there as SVG and PNG, with their
captions in figures.csv.
"""

import importlib
import sys

import matplotlib

import data
import style


def main(arguments):
    if len(arguments) != 2:
        sys.exit(__doc__)
    script, folder = arguments
    matplotlib.use("Agg")
    style.use()
    figures = style.Figures(folder)
    importlib.import_module(script.replace("-", "_")).draw(data.Experiment(folder), figures)
    figures.list_captions()


if __name__ == "__main__":
    main(sys.argv[1:])
