#!/usr/bin/env python3
"""Writes the table of hard cases in docs/stability.md from what the tests measured.

    stability.py [--build DIR] [--xml FILE]

Runs the hard cases of the build (default build/release), or reads the XML that GoogleTest wrote of such a run. Each row is a test, run with
Gauss-Seidel and mostly with Jacobi; figures are the worst of all the runs within it. Fails if a test failed or says not what it shows.
"""

import argparse
import pathlib
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parent.parent
DOCUMENT = ROOT / "docs" / "stability.md"
BEGIN, END = "<!-- table: scripts/stability.py -->", "<!-- end of table -->"
SOLVERS = ("GaussSeidel", "Jacobi")


def words(name):
    """APileAtRest -> a pile at rest"""
    return re.sub(r"(?<=[a-z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", " ", name).lower().capitalize()


def run(build):
    with tempfile.TemporaryDirectory() as directory:
        path = pathlib.Path(directory) / "hard_cases.xml"
        done = subprocess.run([build / "tests" / "loam-tests-hard_cases", f"--gtest_output=xml:{path}"], cwd=ROOT,
                              stdout=subprocess.DEVNULL, check=False)
        if not path.exists():
            sys.exit(f"error: the tests ended with {done.returncode} and wrote nothing")
        return path.read_text()


def read(text):
    """(suite, name) -> solver -> properties"""
    cases = {}
    for case in xml.etree.ElementTree.fromstring(text).iter("testcase"):
        properties = {p.get("name"): p.get("value") for p in case.iter("property")}
        name, _, solver = case.get("name").partition("/")
        if case.get("status") != "run" or not solver and "shows" not in properties:
            continue
        solver = solver or SOLVERS[0]  # of those that are run with one alone
        if case.find("failure") is not None:
            sys.exit(f"error: {case.get('name')} failed")
        if "shows" not in properties or "lowest" not in properties:
            sys.exit(f"error: {case.get('name')} does not say what it shows or measured")
        cases.setdefault((case.get("classname").split("/")[-1], name), {})[solver] = properties
    return cases


def pair(of_solvers, name, form):
    values = [form(float(of_solvers[s][name])) for s in SOLVERS if s in of_solvers]
    return " / ".join(values)


def table(cases):
    rows = ["| case | what it shows | peak speed, m/s | peak energy over start | lowest point, mm | seconds | "
            "speed limited | strain limited | least stiffness |",
            "| --- | --- | --- | --- | --- | --- | --- | --- | --- |"]
    number = lambda v: f"{v:.3g}"
    count = lambda v: f"{v:.0f}" if v < 1e5 else f"{v:.1e}"
    for (_, name), solvers in cases.items():
        shows = next(iter(solvers.values()))["shows"]
        if all("creep" in p for p in solvers.values()):
            creep = " / ".join(f"{float(solvers[s]['creep']):.2g}" for s in SOLVERS if s in solvers)
            shows = f"{shows} {creep}"
        rows.append(f"| {words(name)} | {shows} | {pair(solvers, 'peak_speed', number)} | {pair(solvers, 'peak_energy', number)} | "
                    f"{pair(solvers, 'lowest', lambda v: f'{1000 * v:.2f}' if v < 1e20 else '-')} | "
                    f"{number(float(next(iter(solvers.values()))['simulated']))} | {pair(solvers, 'speed_limited', count)} | "
                    f"{pair(solvers, 'strain_limited', count)} | {pair(solvers, 'stiffness_share', number)} |")
    return "\n".join(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "release")
    parser.add_argument("--xml", type=pathlib.Path)
    arguments = parser.parse_args()
    text = arguments.xml.read_text() if arguments.xml else run(arguments.build.resolve())
    document = DOCUMENT.read_text()
    before, found, rest = document.partition(BEGIN)
    _, ended, after = rest.partition(END)
    if not found or not ended:
        sys.exit(f"error: {DOCUMENT} has no place for the table")
    cases = read(text)
    DOCUMENT.write_text(f"{before}{BEGIN}\n\n{table(cases)}\n\n{END}{after}")
    print(f"{len(cases)} cases written to {DOCUMENT.relative_to(ROOT)}")


if __name__ == "__main__":
    main()
