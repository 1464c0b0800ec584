"""The layout that CONTRIBUTING.md promises, and documents whose links lead somewhere: layout_test.py SOURCE_FOLDER.

No folder holds more than 25 files of its own, no source file's name exists twice, every .cpp has its header unless it is a
program, no function is longer than 60 lines, folders use only the layers below them, and no two folders use each other.
"""
import collections
import pathlib
import re
import sys

MOST_FILES = 25
MOST_LINES = 60
# Layers, bottom to top; those of one line do not use each other.
LAYERS = [
    ["foundation"], ["pictures", "geometry"], ["sensors"], ["calibrate"], ["dataset"], ["sim", "models", "losses"],
    ["infer"], ["train"], ["closed_loop", "ros"], ["accuracy"], ["bench"],
]
NEVER = [("infer", "train"), ("infer", "losses"), ("infer", "sim"), ("infer", "dataset"), ("train", "sim"), ("losses", "models")]
OUTSIDE = {"build", "data", "logs", "runs", "out"}  # what the tools write


def sources(root):
    for path in sorted(root.rglob("*")):
        parts = path.relative_to(root).parts
        if path.is_file() and parts[0] not in OUTSIDE and not any(p.startswith(".") or p == "__pycache__" for p in parts):
            yield path.relative_to(root)


def is_program(text):
    return re.search(r"\b(int main\(|BENCHMARK_MAIN|LLVMFuzzerTestOneInput)", text) is not None


def long_functions(text):
    """(line, length) of functions that are too long, by clang-format's indentation: a body ends where its first line began."""
    lines = text.split("\n")
    for first, line in enumerate(lines):
        opened = re.match(r"^( {0,2})\S.*[^=,(] \{$|^( {0,2})\S.*\) (const )?(override )?\{$", line)
        if not opened or re.match(r"^ *(namespace|class|struct|enum|union|extern|template|\}|constexpr|const|static const|inline const)\b.*", line):
            continue
        if line.startswith("    ") or line.lstrip().startswith("//"):
            continue
        margin = " " * (len(line) - len(line.lstrip(" ")))
        for last in range(first + 1, len(lines)):
            if lines[last].startswith(margin + "}"):
                if last - first + 1 > MOST_LINES:
                    yield first + 1, last - first + 1
                break


def uses(root, files):
    """folder -> folders whose headers it includes"""
    graph = collections.defaultdict(lambda: collections.defaultdict(set))
    for path in files:
        if path.suffix not in (".cpp", ".hpp") or path.parts[0] in ("tests", "examples"):
            continue
        for header in re.findall(r'^#include "([^"]+)"', (root / path).read_text(), re.M):
            folder = pathlib.PurePath(header).parent
            if folder != path.parent and (root / header).exists():
                graph[path.parent][folder].add((str(path), header))
    return graph


def cycles(graph):
    """Folders from which a way leads back to them."""
    def reach(start):
        seen, todo = set(), list(graph[start])
        while todo:
            folder = todo.pop()
            if folder not in seen:
                seen.add(folder)
                todo.extend(graph[folder] if folder in graph else [])
        return seen
    reached = {folder: reach(folder) for folder in list(graph)}
    return sorted({tuple(sorted((str(a), str(b)))) for a in reached for b in reached[a] if a != b and a in reached.get(b, ())})


def dead_links(root, files):
    """Links, and paths in code marks, of the documents that lead to no file."""
    tops = {path.parts[0] for path in files if len(path.parts) > 1}
    for path in files:
        if path.suffix != ".md" or path.name == "CHANGELOG.md":
            continue
        text = (root / path).read_text()
        for link in re.findall(r"\]\(([^)#\s]+)[)#]", text):
            if "://" not in link and not (root / path.parent / link).exists():
                yield f"{path}: the link {link} leads nowhere"
        for place in re.findall(r"`([\w./-]+/[\w./-]*\w)`", text):
            if place.split("/")[0] in tops and not (root / place).exists():
                yield f"{path}: {place} is no file"


def main():
    root = pathlib.Path(sys.argv[1])
    files = list(sources(root))
    faults = []
    count = collections.Counter(path.parent for path in files)
    faults += [f"{folder}: holds {n} files; more than {MOST_FILES} are hard to look through, so split it by topic"
               for folder, n in sorted(count.items()) if n > MOST_FILES and folder != pathlib.PurePath(".")]
    code = [path for path in files if path.suffix in (".cpp", ".hpp", ".py", ".sh")]
    names = collections.defaultdict(list)
    for path in code:
        names[path.name].append(str(path))
    faults += [f"{name}: exists more than once: {', '.join(paths)}" for name, paths in sorted(names.items()) if len(paths) > 1]
    known = set(files)
    for path in code:
        if path.suffix not in (".cpp", ".hpp"):
            continue
        text = (root / path).read_text()
        if path.suffix == ".cpp" and path.parts[0] not in ("tests", "bench", "examples"):
            if path.with_suffix(".hpp") not in known and not is_program(text):
                faults.append(f"{path}: has no header of its own")
        faults += [f"{path}:{line}: a function of {length} lines; {MOST_LINES} are the most" for line, length in long_functions(text)]
    graph = uses(root, files)
    order = {folder: i for i, line in enumerate(LAYERS) for folder in line}
    for a, used in sorted(graph.items()):
        for b, places in sorted(used.items()):
            top_a, top_b = a.parts[0], b.parts[0]
            if top_a == top_b:
                continue
            if top_a not in order or top_b not in order:
                faults.append(f"{top_a} or {top_b}: is in no layer of this test")
            elif order[top_b] >= order[top_a] and top_a != "train" or (top_a, top_b) in NEVER:
                faults.append(f"{sorted(places)[0][0]}: {a} must not use {b}")
    faults += [f"{a} and {b}: use each other" for a, b in cycles(graph)]
    faults += dead_links(root, files)
    print("\n".join(faults))
    print(f"{len(files)} files in {len(count)} folders, {len(faults)} faults")
    return 1 if faults or len(files) < 500 else 0


if __name__ == "__main__":
    sys.exit(main())
