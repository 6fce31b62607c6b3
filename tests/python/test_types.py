"""Types and docstrings: what is there is declared, and what is declared is there."""

import ast
import inspect
import os

import kairos
from kairos import _kairos

FOLDER = os.path.dirname(kairos.__file__)


def stub(name):
    with open(os.path.join(FOLDER, name), encoding="utf-8") as file:
        return ast.parse(file.read())


def names_of(body):
    return {node.name for node in body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}


def public(thing):
    return {name for name in vars(thing) if not name.startswith("_") or name == "__init__"}


def test_the_stub_declares_the_compiled_module():
    tree = stub("_kairos.pyi")
    assert names_of(tree.body) == {name for name in vars(_kairos) if not name.startswith("_")}
    for node in tree.body:
        if isinstance(node, ast.ClassDef):
            declared, there = names_of(node.body), public(getattr(_kairos, node.name))
            assert declared - {"__init__"} == there - {"__init__"}, node.name


def test_keywords_of_a_run_are_declared_from_the_table():
    options = stub("_options.pyi").body[-1]
    assert [node.target.id for node in options.body] == [row["name"] for row in kairos.options()]


def test_what_is_public_is_documented():
    for name in kairos.__all__:
        thing = getattr(kairos, name)
        if callable(thing):
            assert inspect.getdoc(thing), name
