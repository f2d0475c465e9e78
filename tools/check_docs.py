#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that the documents name files and types that exist.

Every path to a source file in a document is a tracked file or the end of one: `dense/free_space.hpp` stands for
`stillmap/dense/free_space.hpp`. In docs/glossary.md each type named beside a file is in that file. Links between
documents lead to files.
"""
import pathlib
import re
import subprocess
import sys

SOURCE = re.compile(r"(?<![\w/.-])((?:[\w.-]+/)*[\w-]+\.(?:hpp|cpp|py))(?![\w/]|\.\w)")
PLACEHOLDERS = {"x", "x_test", "NAME"}  # names that stand for any file
LINK = re.compile(r"\]\(([^)#:\s]+)(?:#[^)]*)?\)")
TYPED = re.compile(r"`([A-Z]\w*)(?:::\w+)?`, ((?:[\w]+/)+\w+\.hpp)")


def tracked(root):
    listed = subprocess.run(["git", "ls-files"], cwd=root, check=True, capture_output=True, text=True)
    return listed.stdout.split()


def find(path, files):
    """The tracked files that a path in a document can mean."""
    return [file for file in files if file == path or file.endswith("/" + path)]


def problems_of(text, files):
    named = {path for path in SOURCE.findall(text) if pathlib.Path(path).stem not in PLACEHOLDERS}
    return [f"no file {path}" for path in sorted(named) if not find(path, files)]


def type_problems(text, files, read):
    problems = []
    for name, path in TYPED.findall(text):
        if not any(re.search(rf"\b{name}\b", read(file)) for file in find(path, files)):
            problems.append(f"no type {name} in {path}")
    return problems


def broken_links(document, text):
    return [f"no file {target}" for target in LINK.findall(text) if not (document.parent / target).exists()]


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent)
    files = tracked(root)
    documents = [root / file for file in files if re.fullmatch(r"(docs/)?[\w-]+\.md", file)]
    problems = []
    for document in documents:
        text = document.read_text()
        found = broken_links(document, text)
        if document.name != "CHANGELOG.md":
            found += problems_of(text, files)
        if document.name == "glossary.md":
            found += type_problems(text, files, lambda file: (root / file).read_text())
        problems += [f"{document.relative_to(root)}: {problem}" for problem in found]
    for problem in problems:
        print(problem)
    print(f"check_docs: {len(documents)} documents, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
