#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that the includes keep to the modules that the CMake files state.

A module is a folder with a stillmap_module(...) call. Its USES name the modules that its files
include, each of them added before it; its TEST_USES name the modules that only its tests include, be
it through a header of tests/support, which may include any module. PRIVATE_HEADERS are included by
their own folder and by tests/support alone. stillmap/ includes nothing from outside but in its tests,
tooling/ and simulation/ know stillmap/ and not each other. Every include is a full path from the root.

The table of modules in docs/architecture.md is written from the same calls: --write writes it, and
without --write a table that differs is a problem.
"""
import pathlib
import re
import sys

KEYWORDS = ("NAME", "USES", "PUBLIC_LIBS", "PRIVATE_LIBS", "SOURCES", "PRIVATE_HEADERS", "TEST_USES",
            "TEST_LIBS")
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)
ADDED = re.compile(r"\badd_subdirectory\s*\(\s*([\w./]+)\s*\)")
CALL = re.compile(r"\bstillmap_module\s*\(([^)]*)\)")

# The top folders, and which of them their files may include; tests may include everything.
TOPS = {
    "stillmap": {"stillmap"},
    "tooling": {"stillmap", "tooling"},
    "simulation": {"stillmap", "simulation"},
    "apps": {"stillmap", "tooling", "simulation", "apps"},
    "python": {"stillmap", "tooling", "simulation", "apps", "python"},
    "tests": {"stillmap", "tooling", "simulation", "tests"},
    "examples": {"stillmap", "examples"},
    "bench": {"stillmap", "tooling", "simulation", "tests", "bench"},
    "fuzz": {"stillmap", "tooling", "tests", "fuzz"},
}
SUPPORT = "tests/support"
TABLE_FILE = "docs/architecture.md"
TABLE_BEGIN = "<!-- The table of modules, written by tools/check_layers.py --write -->"
TABLE_END = "<!-- End of the table of modules -->"


def without_comments(text):
    return re.sub(r"#.*", "", text)


def first_comment(text):
    """The first comment line of a CMake file after the licence, without a final full stop."""
    lines = [line[1:].strip() for line in text.split("\n") if line.startswith("#")]
    lines = [line for line in lines if not line.startswith("SPDX")]
    return lines[0].rstrip(".") if lines else ""


def read_call(text):
    """The arguments of a stillmap_module call by keyword, or None where there is no call."""
    call = CALL.search(without_comments(text))
    if not call:
        return None
    arguments = {keyword: [] for keyword in KEYWORDS}
    keyword = None
    for word in call.group(1).split():
        if word in KEYWORDS:
            keyword = word
        elif keyword:
            arguments[keyword].append(word)
    return arguments


def added_folders(root, folder=""):
    """All folders below, in the order in which CMake adds them."""
    file = root / folder / "CMakeLists.txt"
    text = without_comments(file.read_text()) if file.is_file() else ""
    for name in ADDED.findall(text):
        path = f"{folder}/{name}" if folder else name
        yield path
        yield from added_folders(root, path)


def read_modules(root):
    """All modules by folder, in the order in which they are added."""
    modules = {}
    for folder in added_folders(root):
        file = root / folder / "CMakeLists.txt"
        call = read_call(file.read_text()) if file.is_file() else None
        if call is not None:
            modules[folder] = {**call, "holds": first_comment(file.read_text())}
    return modules


def name_of(folder):
    """The name of the module in a folder: the folder's own, or test_support for tests/support."""
    return ("test_" if folder.startswith("tests/") else "") + folder.split("/")[-1]


def check_calls(root, modules):
    """Names, order and descriptions, and folders that nobody adds."""
    order = [name_of(folder) for folder in modules]
    for folder, module in modules.items():
        where = f"{folder}/CMakeLists.txt"
        name = name_of(folder)
        if module["NAME"] != [name]:
            yield f"{where}: expected stillmap_module(NAME {name} ...)"
        if order.count(name) > 1:
            yield f"{where}: two modules have the name {name}"
        if not module["holds"]:
            yield f"{where}: expected a comment line that says what the module holds"
        for used in module["USES"]:
            if used not in order[: order.index(name)]:
                yield f"{where}: USES {used}, which is not added before {name}"
        for used in module["TEST_USES"]:
            if used not in order:
                yield f"{where}: TEST_USES {used}, which is no module"
        for header in module["PRIVATE_HEADERS"]:
            if not (root / folder / header).is_file():
                yield f"{where}: PRIVATE_HEADERS {header}, which is no file"
    for top in TOPS:
        for file in sorted((root / top).rglob("CMakeLists.txt")):
            folder = str(file.parent.relative_to(root))
            if folder not in modules and read_call(file.read_text()) is not None:
                yield f"{folder}/CMakeLists.txt: a module that no add_subdirectory adds"


def is_test(path):
    return path.endswith("_test.cpp")


def read_includes(root):
    """(file, line, included path) of every quoted include, in the order of the files' names."""
    for top in TOPS:
        for path in sorted((root / top).rglob("*.[ch]pp")):
            text = path.read_text()
            for match in INCLUDE.finditer(text):
                yield (str(path.relative_to(root)), text.count("\n", 0, match.start(1)) + 1,
                       match.group(1))


def check_include(root, modules, path, included):
    """What is wrong with one include of a file, or None."""
    top, other_top = path.split("/")[0], included.split("/")[0]
    if not (root / included).is_file() and not (root / f"{included}.in").is_file():
        return "there is no such file; expected a full path from the root"
    if other_top not in TOPS[top] and not is_test(path):
        return f"{top}/ must not use {other_top}/"
    folder, other = str(pathlib.Path(path).parent), str(pathlib.Path(included).parent)
    if other == folder or other not in modules:
        return None
    if pathlib.Path(included).name in modules[other]["PRIVATE_HEADERS"] and folder != SUPPORT:
        return f"it is a private header (PRIVATE_HEADERS) of {name_of(other)}"
    if folder in modules and not (folder == SUPPORT and path.endswith(".hpp")):
        module = modules[folder]
        known = module["USES"] + (module["TEST_USES"] if is_test(path) else [])
        if name_of(other) not in known:
            return f"{name_of(folder)} does not use {name_of(other)}"
    return None


def check_includes(root, modules, includes):
    for path, line, included in includes:
        problem = check_include(root, modules, path, included)
        if problem:
            yield f"{path}:{line}: {included}: {problem}"


def names_included(path, includes_of):
    """The names of the modules that a file includes; for a test, through tests/support as well."""
    names, waiting, seen = set(), list(includes_of.get(path, [])), set()
    while waiting:
        included = waiting.pop()
        folder = str(pathlib.Path(included).parent)
        names.add(name_of(folder))
        if is_test(path) and folder == SUPPORT and included not in seen:
            seen.add(included)
            waiting += includes_of.get(included, [])
    return names


def check_unused(modules, includes):
    """USES and TEST_USES that no file includes."""
    includes_of = {}
    for path, _, included in includes:
        includes_of.setdefault(path, []).append(included)
    used = {folder: {"USES": set(), "TEST_USES": set()} for folder in modules}
    for path in includes_of:
        folder = str(pathlib.Path(path).parent)
        if folder in modules:
            used[folder]["TEST_USES" if is_test(path) else "USES"] |= names_included(path, includes_of)
    for folder, module in modules.items():
        for keyword in ("USES", "TEST_USES"):
            for name in module[keyword]:
                if name not in used[folder][keyword]:
                    yield f"{folder}/CMakeLists.txt: {keyword} {name}, which no file includes"
        for name in module["TEST_USES"]:
            if name in module["USES"]:
                yield f"{folder}/CMakeLists.txt: TEST_USES {name}, which USES has already"


def table(modules):
    """The table of modules, in Markdown."""
    rows = ["| room | module | what it holds | uses |", "|---|---|---|---|"]
    last_room = None
    for folder, module in modules.items():
        parts = folder.split("/")
        room = "/".join(parts[:2]) if parts[0] == "stillmap" else parts[0]
        shown = "" if room == last_room else f"`{room}/`"
        uses = ", ".join(module["USES"]) or "-"
        rows.append(f"| {shown} | `{name_of(folder)}` | {module['holds']} | {uses} |")
        last_room = room
    return "\n".join(rows)


def with_table(text, modules):
    """The document's text with the table as the modules have it, or None without its markers."""
    begin, end = text.find(TABLE_BEGIN), text.find(TABLE_END)
    if begin < 0 or end < begin:
        return None
    return f"{text[:begin]}{TABLE_BEGIN}\n{table(modules)}\n{text[end:]}"


def check_table(root, modules, write):
    file = root / TABLE_FILE
    text = file.read_text()
    wanted = with_table(text, modules)
    if wanted is None:
        yield f"{TABLE_FILE}: expected the lines {TABLE_BEGIN} and {TABLE_END}"
    elif write:
        file.write_text(wanted)
    elif wanted != text:
        yield f"{TABLE_FILE}: the table of modules is out of date: tools/check_layers.py --write"


def check_all(root, write=False):
    modules = read_modules(root)
    includes = list(read_includes(root))
    problems = [*check_calls(root, modules), *check_includes(root, modules, includes),
                *check_unused(modules, includes), *check_table(root, modules, write)]
    return modules, problems


def main():
    root = pathlib.Path(__file__).resolve().parent.parent
    modules, problems = check_all(root, write="--write" in sys.argv[1:])
    for problem in problems:
        print(problem)
    print(f"check_layers: {len(modules)} modules, {len(problems)} problems")
    return 1 if problems or not modules else 0


if __name__ == "__main__":
    sys.exit(main())
