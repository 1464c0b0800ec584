"""Every field of a configuration struct is bound: bound_fields_test.py SOURCE_FOLDER."""
import pathlib
import re
import sys


def without_comments(text):
    return re.sub(r"//[^\n]*", "", text)


def body_after(text, begin):
    """What the braces that open at or after `begin` hold."""
    first = text.index("{", begin)
    depth = 0
    for i in range(first, len(text)):
        depth += {"{": 1, "}": -1}.get(text[i], 0)
        if depth == 0:
            return text[first + 1 : i]
    raise ValueError("braces that do not close")


def fields(struct):
    """Names of data members; nested braces (initialisers, member functions) do not count."""
    flat = re.sub(r"\{[^{}]*\}", "", struct)
    flat = re.sub(r"\([^()]*\)[^;]*", "()", flat)
    for statement in flat.split(";"):
        found = re.search(r"^\s*(?!using|static|enum|struct|friend)[\w:<>,\s*&]*?[\w>&*]\s+(\w+)\s*(?:=.*)?$", statement, re.S)
        if found and "()" not in statement.split("=")[0]:
            yield found.group(1)


def main():
    source = pathlib.Path(sys.argv[1])
    files = [f for f in source.rglob("*.[ch]pp") if not {"build", "tests"} & set(f.relative_to(source).parts)]
    texts = {f: without_comments(f.read_text()) for f in files}
    structs = {}
    for path, text in texts.items():
        for found in re.finditer(r"^struct (\w+)(?: : [^{;]*)? \{", text, re.M):
            structs.setdefault(found.group(1), {})[path.parent] = body_after(text, found.start())
    bound, missing = 0, []
    for path, text in texts.items():
        for found in re.finditer(r"^void bind\(Binder& \w+, ([\w:]+)& (\w+)\) \{", text, re.M):
            name = found.group(1).split("::")[-1]
            if name not in structs:
                continue
            bound += 1
            body = body_after(text, found.start())
            if re.search(rf"\w\([^()]*\b{found.group(2)}\)", body):  # handed on as a whole, in this file
                body = text
            struct = structs[name].get(path.parent) or next(iter(structs[name].values()))
            missing += [f"{path.relative_to(source)}: bind does not list {name}::{field}"
                        for field in fields(struct) if field[0].islower() and not re.search(rf"\b{field}\b", body)]
    if missing or bound < 20:
        sys.exit(f"of {bound} configuration structs:\n" + "\n".join(missing))
    print(f"{bound} configuration structs bind all their fields")


main()
