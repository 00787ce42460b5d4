#!/usr/bin/env python3
"""What the public headers declare, and whether the library and the ABI baseline keep to it.

  public_api.py list                                        functions, structs and constants, one a line
  public_api.py layout-program --output layout.c            a C program that prints every size, offset and value
  public_api.py compare-layout --program P --baseline FILE  runs that program and compares; --update rewrites the baseline
  public_api.py compare-exports --library libloam.so        exported symbols against the declared functions
"""
import argparse
import dataclasses
import pathlib
import re
import subprocess
import sys

HEADERS = pathlib.Path(__file__).resolve().parent.parent / "include" / "loam"


@dataclasses.dataclass
class Api:
    functions: list[str] = dataclasses.field(default_factory=list)
    structs: dict[str, list[str]] = dataclasses.field(default_factory=dict)
    constants: list[str] = dataclasses.field(default_factory=list)
    types: list[str] = dataclasses.field(default_factory=list)


def fail(message: str) -> None:
    sys.exit(f"error: {message}")


def member_names(body: str, where: str) -> list[str]:
    names = []
    for declaration in filter(None, (part.strip() for part in body.split(";"))):
        pointer = re.search(r"\(\s*\*\s*(\w+)\s*\)\s*\(", declaration)
        if pointer:
            names.append(pointer.group(1))
            continue
        plain = re.fullmatch(r"(?:const\s+)?\w+\s+(?:\*\s*(?:const\s*)?)?(\w+)(?:\[\w+\])*", declaration)
        if not plain:
            fail(f"{where}: cannot read the member '{declaration}': declare one member per line, of a named type")
        names.append(plain.group(1))
    return names


def parse(headers: pathlib.Path) -> Api:
    """Reads the plain C that the headers are written in; anything it does not know is an error, not a gap."""
    api = Api()
    for path in sorted(headers.glob("*.h")):
        text = re.sub(r"/\*.*?\*/", " ", path.read_text(encoding="utf-8"), flags=re.S)
        text = re.sub(r"//[^\n]*", " ", text)
        text = re.sub(r"^\s*#(?:[^\n\\]|\\.|\\\n)*", "", text, flags=re.M)
        text = re.sub(r'extern "C" \{|^\}\s*$', "", text, flags=re.M)

        def struct(match: re.Match) -> str:
            if match.group(1) != match.group(3):
                fail(f"{path.name}: struct {match.group(1)} and its typedef {match.group(3)} differ in name")
            api.structs[match.group(3)] = member_names(match.group(2), f"{path.name}: {match.group(3)}")
            return ""

        def enumeration(match: re.Match) -> str:
            for item in filter(None, (part.strip() for part in match.group(1).split(","))):
                named = re.fullmatch(r"(LOAM_\w+)(?:\s*=\s*[^=]+)?", item)
                if not named:
                    fail(f"{path.name}: cannot read the constant '{item}'")
                api.constants.append(named.group(1))
            return ""

        def function(match: re.Match) -> str:
            api.functions.append(match.group(1))
            return ""

        def alias(match: re.Match) -> str:
            api.types.append(match.group(1))
            return ""

        text = re.sub(r"typedef\s+struct\s+(\w+)\s*\{([^{}]*)\}\s*(\w+)\s*;", struct, text)
        text = re.sub(r"enum\s*(?:\w+\s*)?\{([^{}]*)\}\s*;", enumeration, text)
        text = re.sub(r"LOAM_API\s+[\w\s\*]*?\b(loam_\w+)\s*\([^;]*\)\s*;", function, text)
        text = re.sub(r"typedef\s+struct\s+(\w+)\s+\1\s*;", "", text)
        text = re.sub(r"typedef\s+(?:u?int\d+_t|float|double)\s+(\w+)\s*;", alias, text)
        text = re.sub(r"typedef\s+[\w\s\*]*\(\s*\*\s*(\w+)\s*\)\s*\([^;]*\)\s*;", alias, text)
        if text.strip():
            fail(f"{path.name}: not understood: {' '.join(text.split())[:200]}")
    if not api.functions:
        fail(f"no function found in {headers}")
    return api


def layout_program(api: Api) -> str:
    lines = ["/* Made by scripts/public_api.py from include/loam: prints what a compiled host relies on. */",
             "#include <loam/loam.h>", "#include <stddef.h>", "#include <stdio.h>", "",
             '#define TYPE(type) printf("type " #type " size %lu\\n", (unsigned long)sizeof(type))',
             '#define STRUCT(type) printf("struct " #type " size %lu\\n", (unsigned long)sizeof(type))',
             '#define MEMBER(type, member)                                                          \\',
             '  printf("  " #type "." #member " offset %lu size %lu\\n", (unsigned long)offsetof(type, member), \\',
             '         (unsigned long)sizeof(((type *)0)->member))',
             '#define CONSTANT(name) printf("constant " #name " = %ld\\n", (long)(name))', "", "int main(void) {"]
    lines += [f"  TYPE({name});" for name in api.types]
    for name, members in api.structs.items():
        lines.append(f"  STRUCT({name});")
        lines += [f"  MEMBER({name}, {member});" for member in members]
    lines += [f"  CONSTANT({name});" for name in api.constants]
    return "\n".join(lines + ["  return 0;", "}", ""])


def compare_layout(program: str, baseline: pathlib.Path, update: bool) -> int:
    now = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    if update:
        baseline.write_text(now, encoding="utf-8")
        print(f"{baseline}: {len(now.splitlines())} lines written")
        return 0
    if not baseline.exists():
        fail(f"{baseline} is missing; make it with --update")
    old_lines, new_lines = baseline.read_text(encoding="utf-8").splitlines(), now.splitlines()
    gone = [line for line in old_lines if line not in set(new_lines)]
    added = [line for line in new_lines if line not in set(old_lines)]
    for line in gone:
        print(f"- {line}")
    for line in added:
        print(f"+ {line}")
    if gone:
        print("The ABI differs from its baseline: hosts that are already compiled may break. A size may only grow by appended members.")
    elif added:
        print("The ABI has grown.")
    if gone or added:
        print(f"If that is meant: {sys.argv[0]} compare-layout --program {program} --baseline {baseline} --update")
        return 1
    print(f"{len(new_lines)} sizes, offsets and values as in {baseline.name}")
    return 0


def compare_exports(api: Api, library: str) -> int:
    output = subprocess.run(["nm", "-D", "--defined-only", "--format=posix", library], check=True, capture_output=True, text=True).stdout
    exported = {line.split()[0].split("@")[0] for line in output.splitlines()}
    declared = set(api.functions)
    for name in sorted(declared - exported):
        print(f"declared in include/loam but not exported: {name}")
    for name in sorted(exported - declared):
        print(f"exported but not declared in include/loam: {name}")
    if exported != declared:
        return 1
    print(f"{library}: exports exactly the {len(declared)} functions of include/loam")
    return 0


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--headers", type=pathlib.Path, default=HEADERS)
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("list")
    program = commands.add_parser("layout-program")
    program.add_argument("--output", type=pathlib.Path, required=True)
    layout = commands.add_parser("compare-layout")
    layout.add_argument("--program", required=True)
    layout.add_argument("--baseline", type=pathlib.Path, required=True)
    layout.add_argument("--update", action="store_true")
    exports = commands.add_parser("compare-exports")
    exports.add_argument("--library", required=True)
    arguments = parser.parse_args()

    api = parse(arguments.headers)
    if arguments.command == "list":
        for name in api.functions:
            print("function", name)
        for name, members in api.structs.items():
            print("struct", name, *members)
        for name in api.constants:
            print("constant", name)
        return 0
    if arguments.command == "layout-program":
        arguments.output.write_text(layout_program(api), encoding="utf-8")
        return 0
    if arguments.command == "compare-layout":
        return compare_layout(arguments.program, arguments.baseline, arguments.update)
    return compare_exports(api, arguments.library)


if __name__ == "__main__":
    sys.exit(main())
