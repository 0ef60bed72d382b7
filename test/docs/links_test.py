#!/usr/bin/env python3
"""links_test.py ROOT: every relative link and picture in every Markdown file below ROOT leads to a file, and every anchor
to a heading of it (as GitHub names them). First it is run on made links, of which it must find the broken ones."""
import os
import re
import sys
import tempfile
import unicodedata

SKIPPED = ("build", "logs", ".git", ".ci", "templates")
LINK = re.compile(r"\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)")
REFERENCE = re.compile(r"^ {0,3}\[[^\]]+\]:\s*<?(\S+?)>?(?:\s|$)", re.MULTILINE)
HTML = re.compile(r"<(?:a|img)\b[^>]*?\b(?:href|src)\s*=\s*[\"']([^\"']+)[\"']", re.IGNORECASE)
HEADING = re.compile(r"^ {0,3}#{1,6}\s+(.*?)\s*#*\s*$")
ANCHOR = re.compile(r"<a\b[^>]*?\b(?:id|name)\s*=\s*[\"']([^\"']+)[\"']", re.IGNORECASE)
FENCE = re.compile(r"^ {0,3}(```+|~~~+)")


def without_code(text):
    """The text with code blocks and code spans blanked; lines stay."""
    lines, fence = [], None
    for line in text.split("\n"):
        match = FENCE.match(line)
        if fence:
            if match and match.group(1).startswith(fence):
                fence = None
            line = ""
        elif match:
            fence, line = match.group(1), ""
        lines.append(line)
    return re.sub(r"(`+)(?!`)(?:(?!\n\n).)*?(?<!`)\1(?!`)", lambda m: re.sub(r"[^\n]", " ", m.group(0)), "\n".join(lines),
                  flags=re.DOTALL)


def slug(heading):
    """GitHub's anchor of a heading."""
    heading = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").replace("*", "")
    kept = [c for c in heading.lower() if c in " -_" or unicodedata.category(c)[0] in "LN"]
    return "".join(kept).replace(" ", "-")


def anchors_of(path):
    with open(path, encoding="utf-8") as file:
        text = file.read()
    found, fence = set(), None
    for line in text.split("\n"):
        match = FENCE.match(line)
        if match:
            fence = None if fence and match.group(1).startswith(fence) else fence or match.group(1)
            continue
        heading = None if fence else HEADING.match(line)
        if heading:
            base = name = slug(heading.group(1))
            number = 0
            while name in found:
                number += 1
                name = f"{base}-{number}"
            found.add(name)
    return found | set(ANCHOR.findall(text))


def problem_of(root, source, link):
    """What is wrong with the link in source; None if nothing is."""
    if re.match(r"[a-zA-Z][a-zA-Z0-9+.-]*:|//", link):
        return None
    path, _, anchor = link.partition("#")
    target = source
    if path:
        target = os.path.join(root if path.startswith("/") else os.path.dirname(source), path.lstrip("/"))
    if not os.path.exists(target):
        return "no such file"
    if not os.path.realpath(target).startswith(os.path.realpath(root) + os.sep):
        return "leads out of the project"
    if anchor and target.endswith(".md") and anchor not in anchors_of(target):
        return "no such heading"
    return None


def markdown_files(root):
    for folder, folders, files in os.walk(root):
        if folder == root:
            folders[:] = [f for f in folders if not f.startswith(SKIPPED)]
        yield from (os.path.join(folder, f) for f in sorted(files) if f.endswith(".md"))
        folders.sort()
    logs = os.path.join(root, "logs", "README.md")
    if os.path.exists(logs):
        yield logs


def check(root):
    problems, count = [], 0
    for path in markdown_files(root):
        with open(path, encoding="utf-8") as file:
            text = without_code(file.read())
        for pattern in (LINK, REFERENCE, HTML):
            for match in pattern.finditer(text):
                count += 1
                problem = problem_of(root, path, match.group(1))
                if problem:
                    line = text.count("\n", 0, match.start(1)) + 1
                    problems.append(f"{os.path.relpath(path, root)}:{line}: {match.group(1)}: {problem}")
    return problems, count


def self_test():
    with tempfile.TemporaryDirectory() as root:
        os.mkdir(os.path.join(root, "docs"))
        with open(os.path.join(root, "docs", "a.md"), "w", encoding="utf-8") as file:
            file.write("# Two words: `code`, *more*\n## Same\n## Same\n```\n# no heading\n[no](link.md)\n```\n")
        with open(os.path.join(root, "README.md"), "w", encoding="utf-8") as file:
            file.write("[a](docs/a.md) [b](docs/a.md#two-words-code-more) [c](docs/a.md#same-1) `[code](none.md)`\n"
                       "[d](https://example.org/none) ![e](docs/none.png)\n[![f](none.svg)](docs/a.md)\n\n"
                       "[g](docs/a.md#same-2) [h](docs/a.md#no-heading) [i](../out.md) [j](#gone)\n\n[k]: docs/gone.md\n")
        problems, count = check(root)
        lines = [p.split(": ")[0] + " " + p.split(": ")[1] for p in problems]
        assert sorted(lines) == sorted(["README.md:2 docs/none.png", "README.md:3 none.svg", "README.md:5 docs/a.md#same-2",
                                        "README.md:5 docs/a.md#no-heading", "README.md:5 ../out.md", "README.md:5 #gone",
                                        "README.md:7 docs/gone.md"]), problems
        assert count >= 11, count


def main():
    self_test()
    problems, count = check(os.path.abspath(sys.argv[1]))
    for problem in problems:
        print(problem)
    if problems:
        sys.exit(f"{len(problems)} of {count} links are broken")
    print(f"all {count} links lead to a file, and their anchors to a heading")


if __name__ == "__main__":
    main()
