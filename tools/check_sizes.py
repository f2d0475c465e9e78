#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks every tracked C++ file: length of files and functions, what the library must not do, and that a type has its
name for itself."""
import bisect
import pathlib
import re
import subprocess
import sys

MAX_FILE_LINES = 400
MAX_FUNCTION_LINES = 60

# The library, and the tooling and simulation beside it, neither print, nor end the process, nor wait
# for time to pass, nor write to what they were given as const.
LIBRARY = ("stillmap/", "tooling/", "simulation/")
FORBIDDEN = {
    r"\bcout\b|\bcerr\b": "prints",
    r"\b(?:_?[eE]xit|abort|quick_exit)\s*\(": "ends the process",
    r"\b(?:sleep_for|sleep_until|u?sleep|nanosleep)\b": "sleeps",
    r"\bconst_cast\b": "casts const away",
}

# Comments, raw strings, strings and characters; a quote between digits separates them.
LEXEME = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(?P<tag>[^()\s\\]{0,16})\(.*?\)(?P=tag)"|"(?:\\.|[^"\\\n])*"'
    r"|(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])*'",
    re.DOTALL)
PREPROCESSOR = re.compile(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", re.MULTILINE)
TEMPLATE_HEAD = re.compile(r"\btemplate\s*<(?:[^<>]|<(?:[^<>]|<[^<>]*>)*>)*>")
HEAD_START = re.compile(r"\s*(?:(?:public|private|protected)\s*:\s*)?")
SCOPE = re.compile(r'\b(?:namespace|class|struct|union|enum)\b|\bextern\s*""')


def blanked(match):
    """The match without content but with its line ends, so that line numbers stay."""
    lines = "\n" * match.group(0).count("\n")
    return '""' + lines if match.group(0).startswith(('"', "R")) else " " + lines


def code_of(text):
    return PREPROCESSOR.sub(blanked, LEXEME.sub(blanked, text))


def is_scope(head):
    """Whether a brace after this text opens a namespace, a type or the like, not a function."""
    head = TEMPLATE_HEAD.sub(" ", head)
    return bool(SCOPE.search(head)) and "(" not in head.replace("alignas(", "")


class Scanner:
    """Walks the braces of a file's code; finds functions and what stands outside of them."""

    def __init__(self, code):
        self.code = code
        self.line_starts = [0] + [match.end() for match in re.finditer("\n", code)]
        self.functions = []  # (first line, last line)
        self.outside = []  # pieces of code outside functions, with their offset

    def line(self, offset):
        return bisect.bisect_right(self.line_starts, offset)

    def scan(self):
        depth = 0  # of braces inside a function or a value; 0 outside
        head = 0  # where the text before the next brace or semicolon begins
        opened = 0
        for match in re.finditer(r"[{};]", self.code):
            token, at = match.group(0), match.start()
            if depth > 0:
                depth += {"{": 1, "}": -1, ";": 0}[token]
                if depth == 0:
                    head = self.end_block(head, opened, at)
            elif token == "{" and not is_scope(self.code[head:at]):
                depth, opened = 1, at
            else:
                self.outside.append((head, self.code[head:at]))
                head = at + 1
        return self

    def end_block(self, head, opened, at):
        """A block that began outside functions is closed; where the next head begins."""
        if re.match(r"\s*[,{)]", self.code[at + 1:]):
            return head  # a member's initialiser in a constructor's list: the function follows
        if not self.code[head:opened].rstrip().endswith("="):
            start = head + HEAD_START.match(self.code[head:opened]).end()
            self.functions.append((self.line(start), self.line(at)))
        return at + 1


def check_file(path, name):
    text = path.read_text()
    lines = text.count("\n") + (0 if text.endswith("\n") or not text else 1)
    if lines > MAX_FILE_LINES:
        yield f"{name}: {lines} lines, at most {MAX_FILE_LINES}"
    code = code_of(text)
    scanner = Scanner(code).scan()
    for first, last in scanner.functions:
        if last - first + 1 > MAX_FUNCTION_LINES:
            yield f"{name}:{first}: a function of {last - first + 1} lines, at most {MAX_FUNCTION_LINES}"
    if not name.startswith(LIBRARY):
        return
    for pattern, deed in FORBIDDEN.items():
        for match in re.finditer(pattern, code):
            yield f"{name}:{scanner.line(match.start())}: {match.group(0)}: the library never {deed}"
    for start, piece in scanner.outside:
        match = re.search(r"\busing\s+namespace\b", piece)
        if match:
            yield f"{name}:{scanner.line(start + match.start())}: using namespace outside a function"


NAMESPACE = re.compile(r"^namespace ([\w:]+) \{", re.MULTILINE)
TYPE = re.compile(r"^(?:(?:struct|class|union|enum class) (?P<type>\w+)(?: final)?(?: : [^;{]*)?\s*\{|using (?P<alias>\w+) =)",
                  re.MULTILINE)


def check_types(texts):
    """`texts`: the headers by name. No compiler notices two types of one name that a program links."""
    first = {}
    for name, text in texts.items():
        code = code_of(text)
        spaces = [(match.start(), match.group(1)) for match in NAMESPACE.finditer(code)]
        for match in TYPE.finditer(code):
            space = next((space for at, space in reversed(spaces) if at < match.start()), "")
            type_name = match["type"] or match["alias"]
            before = first.setdefault((space, type_name), name)
            if before != name:
                yield f"{name}: {space}::{type_name} is another type in {before}: one of them needs another name"


def tracked_files(root):
    names = subprocess.run(["git", "ls-files", "-z", "--", "*.cpp", "*.hpp"],
                           cwd=root, check=True, capture_output=True, text=True).stdout
    return [name for name in names.split("\0") if name and (root / name).is_file()]


def main():
    root = pathlib.Path(__file__).resolve().parent.parent
    names = sys.argv[1:] or tracked_files(root)
    problems = [problem for name in names for problem in check_file(root / name, name)]
    problems += check_types({name: (root / name).read_text() for name in names if name.endswith(".hpp")})
    for problem in problems:
        print(problem)
    print(f"check_sizes: {len(names)} files, {len(problems)} problems")
    return 1 if problems or not names else 0


if __name__ == "__main__":
    sys.exit(main())
