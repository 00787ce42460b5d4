#!/usr/bin/env python3
"""Compiles the CUDA sources of a compile_commands.json once more with -Xptxas -v and prints what each kernel takes.

Exits with 1 if a kernel spills registers. Allowed to: those of the CUB library, and the walks through the triangle trees, whose stacks lie in
local memory anyway and which run once a substep.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

ENTRY = re.compile(r"Compiling entry function '(\w+)' for '(\w+)'")
PROPERTIES = re.compile(r"Function properties for (\w+)")
STACK = re.compile(r"(\d+) bytes stack frame, (\d+) bytes spill stores, (\d+) bytes spill loads")
REGISTERS = re.compile(r"Used (\d+) registers")
SHARED = re.compile(r"(\d+) bytes smem")


def compile_verbosely(command: dict) -> str:
    words = shlex.split(command["command"]) if "command" in command else list(command["arguments"])
    while words and not re.search(r"nvcc[^/]*$", words[0]):
        words.pop(0)  # a launcher such as ccache
    words[words.index("-o") + 1] = os.devnull
    for flag in ("-MF", "-MT"):
        if flag in words:
            del words[words.index(flag):words.index(flag) + 2]
    words = [word for word in words if word not in ("-MD", "-MMD")]
    result = subprocess.run([*words, "-Xptxas", "-v"], cwd=command["directory"], capture_output=True, text=True)
    if result.returncode != 0:
        sys.exit(f"{command['file']} does not compile:\n{result.stderr}")
    return result.stdout + result.stderr


def read(output: str) -> dict[str, dict]:
    kernels: dict[str, dict] = {}
    entry = described = None
    for line in output.splitlines():
        if found := ENTRY.search(line):
            entry = described = found.group(1)
            kernels[entry] = dict(registers=0, stack=0, stores=0, loads=0, shared=0)
        elif found := PROPERTIES.search(line):
            described = found.group(1)
        elif (found := STACK.search(line)) and entry and described == entry:
            kernels[entry].update(zip(("stack", "stores", "loads"), map(int, found.groups())))
        elif (found := REGISTERS.search(line)) and entry:
            kernels[entry]["registers"] = int(found.group(1))
            if shared := SHARED.search(line):
                kernels[entry]["shared"] = int(shared.group(1))
    return kernels


def shorten(name: str) -> str:
    name = re.sub(r"^void ", "", name)
    name = re.sub(r"\(anonymous namespace\)::|\b(?:loam\w*|kernels|cuda|gpu|cub|detail|std)::", "", name)
    name = re.sub(r"\(.*\)$", "", name)
    name = re.sub(r"\(\w+\)(\d)", r"\1", name)
    return name if len(name) <= 80 else name[:77] + "..."


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("commands", type=pathlib.Path)
    parser.add_argument("--allow-spills", default="Device(?:Radix|Scan|Reduce|Merge)|FindContacts|SweepContacts", help="kernels, by regular expression, that may spill")
    arguments = parser.parse_args()

    commands = [command for command in json.loads(arguments.commands.read_text()) if command["file"].endswith(".cu")]
    if not commands:
        sys.exit("error: no CUDA source is compiled in this build")
    kernels: dict[str, dict] = {}
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count() or 2) as pool:
        for command, output in zip(commands, pool.map(compile_verbosely, commands)):
            found = read(output)
            print(f"{pathlib.Path(command['file']).name}: {len(found)} kernels", flush=True)
            kernels.update(found)

    readable = subprocess.run(["c++filt"], input="\n".join(kernels), check=True, capture_output=True, text=True).stdout.splitlines()
    print(f"\n{'kernel':80} {'registers':>9} {'shared':>7} {'stack':>6} {'spilled':>8} {'reloaded':>8}")
    faults = 0
    for name, use in sorted(zip(readable, kernels.values()), key=lambda row: -row[1]["registers"]):
        spills = bool(use["stores"] or use["loads"])
        allowed = re.search(arguments.allow_spills, name) is not None
        faults += spills and not allowed
        print(f"{shorten(name):80} {use['registers']:9} {use['shared']:7} {use['stack']:6} {use['stores']:8} {use['loads']:8}"
              + ("" if not spills else "  spills, as it may" if allowed else "  SPILLS"))
    print(f"\n{len(kernels)} kernels, {faults} that spill and should not")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
