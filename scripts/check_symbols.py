#!/usr/bin/env python3
"""No code that was compiled for one instruction set may be reached from another.

The linker keeps one copy of each weak symbol (inline functions, templates) and may take it from any object. Were it one compiled for
AVX-512, the library would crash on older machines. So an object compiled once per instruction set may define a weak symbol only if its name
lies in the namespace of that instruction set and no other object defines it.

  check_symbols.py DIRECTORY       the build folder; objects are found under loam_kernels_<set>.dir, all other objects are the rest
"""
import collections
import pathlib
import re
import subprocess
import sys

WEAK = set("VvWwu")
# References to the personality routine of C++ exceptions: data, the same in every object.
HARMLESS = re.compile(r"^DW\.ref\.")


def weak_symbols(paths: list[pathlib.Path]) -> dict[str, set[str]]:
    found = collections.defaultdict(set)
    for start in range(0, len(paths), 200):
        chunk = [str(path) for path in paths[start:start + 200]]
        output = subprocess.run(["nm", "-A", "--defined-only", "--format=posix", *chunk], check=True, capture_output=True, text=True).stdout
        for line in output.splitlines():
            path, _, rest = line.rpartition(": ")
            name, kind = rest.split()[:2]
            if kind in WEAK and not HARMLESS.match(name):
                found[name].add(path)
    return found


def demangle(names: list[str]) -> list[str]:
    return subprocess.run(["c++filt"], input="\n".join(names), check=True, capture_output=True, text=True).stdout.splitlines()


def main() -> int:
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    objects = sorted(pathlib.Path(sys.argv[1]).rglob("*.o"))
    groups = collections.defaultdict(list)
    for path in objects:
        match = re.search(r"loam_kernels_(\w+)\.dir", str(path))
        groups[match.group(1) if match else ""].append(path)
    rest = weak_symbols(groups.pop("", []))
    if not groups:
        sys.exit(f"error: no object of a target loam_kernels_<instruction set> under {sys.argv[1]}")

    weak = {group: weak_symbols(paths) for group, paths in groups.items()}
    faults = 0
    for group, symbols in sorted(weak.items()):
        others = set(rest).union(*(weak[other] for other in weak if other != group))
        bad = sorted(name for name in symbols if name in others or not re.search(rf"\d+{group}", name))
        faults += len(bad)
        for name, readable in zip(bad, demangle(bad)):
            why = "is also defined elsewhere" if name in others else f"lies outside the namespace {group}"
            print(f"{group}: the weak symbol {readable[:160]} {why}")
        print(f"{group}: {len(groups[group])} objects, {len(symbols)} weak symbols, {len(bad)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
