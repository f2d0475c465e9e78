# SPDX-License-Identifier: Apache-2.0
"""Stubs, docstrings and help() say what is there."""
import ast
import inspect
import pydoc
import subprocess
import sys

import pytest

import stillmap
from conftest import SOURCE
from stillmap import _core

STUBS = {node.name: node
         for node in ast.parse((SOURCE / "python/stillmap/_core.pyi").read_text()).body
         if isinstance(node, (ast.ClassDef, ast.FunctionDef))}


def public_names(thing):
    return {name for name in vars(thing) if not name.startswith("_")}


def parameters(node):
    arguments = node.args
    keywords = [arguments.kwarg] if arguments.kwarg else []
    return [each.arg for each in
            arguments.posonlyargs + arguments.args + arguments.kwonlyargs + keywords]


def test_every_name_has_a_stub_and_every_stub_a_name():
    built = {name for name, value in vars(_core).items()
             if inspect.isclass(value) or inspect.isroutine(value)}
    assert built == set(STUBS)
    for name, node in STUBS.items():
        if isinstance(node, ast.ClassDef) and name != "Error":
            stubs = {item.name for item in node.body if isinstance(item, ast.FunctionDef)}
            public = {stub for stub in stubs if not stub.startswith("_")}
            assert public == public_names(getattr(_core, name)), name


def test_parameters_are_those_of_the_stubs():
    for name, node in STUBS.items():
        value = getattr(_core, name)
        if isinstance(node, ast.FunctionDef):
            assert list(inspect.signature(value).parameters) == parameters(node), name
            continue
        for item in node.body:
            if isinstance(item, ast.FunctionDef) and not item.decorator_list \
                    and not item.name.startswith("__"):
                method = inspect.signature(getattr(value, item.name))
                assert list(method.parameters) == parameters(item), (name, item.name)
            if isinstance(item, ast.FunctionDef) and item.name == "__init__":
                assert list(inspect.signature(value).parameters) == parameters(item)[1:], name


def test_everything_has_a_docstring():
    for name in stillmap.__all__:
        value = getattr(stillmap, name)
        if name in ("CLASS_NAMES", "__version__"):
            continue
        assert value.__doc__, name
        if inspect.isclass(value) and name != "Error":
            for member in public_names(value):
                assert inspect.getdoc(getattr(value, member)), (name, member)


def test_help_shows_what_a_reader_needs():
    text = pydoc.plain(pydoc.render_doc(stillmap.Slam.process))
    assert "process(self, color, depth, stamp, objects=None, *, copy=False)" in text
    assert "Tracks a frame" in text
    package = pydoc.plain(pydoc.render_doc(stillmap))
    assert "class Slam" in package and "run(sequence" in package


def test_mypy_agrees():
    pytest.importorskip("mypy", reason="mypy is not installed: apt-get install mypy")
    for arguments in (["mypy.stubtest", "stillmap._core", "--allowlist",
                       str(SOURCE / "python/tests/stubtest_allowlist.txt")],
                      ["mypy", "--strict", "--package", "stillmap"]):
        done = subprocess.run([sys.executable, "-m", *arguments], capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
