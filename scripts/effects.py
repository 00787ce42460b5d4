#!/usr/bin/python3
"""Measures what each effect costs in a scene, and writes the tables of docs/effects.md and its plot.

    effects.py [--build DIR] [--lean DIR] [--json FILE] [--keep FILE]

Runs loam-effects of the build (default build/release), or reads what a run of it wrote (--keep says where to). Then runs its sand once more with
the library of --lean (default build/lean; preset lean), which has nothing but sand, in turns with the whole one.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys

try:
    import matplotlib
except ImportError:
    sys.exit("error: matplotlib is missing: scripts/install_dependencies.sh docs")

matplotlib.use("svg")
from matplotlib import pyplot  # noqa: E402  (the backend is chosen before)

ROOT = pathlib.Path(__file__).resolve().parent.parent
DOCUMENT = ROOT / "docs" / "effects.md"
PLOT = ROOT / "docs" / "images" / "effects.svg"
COLOURS = {"solver": "#4c72b0", "materials": "#dd8452", "colliders": "#55a868", "cloth": "#8172b3", "streams": "#c44e52",
           "host": "#937860"}


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.partition(":")[2].strip()
    return "unknown processor"


def run(build):
    program = build / "benchmarks" / "loam-effects"
    done = subprocess.run([program], cwd=ROOT, stdout=subprocess.PIPE, check=False, text=True)
    if done.returncode != 0:
        sys.exit(f"error: {program} ended with {done.returncode}")
    return json.loads(done.stdout)


def sand_with(build, library):
    program = build / "benchmarks" / "loam-effects"
    environment = dict(os.environ, LD_PRELOAD=str(library))
    done = subprocess.run([program, "--only", "sand alone", "--pile", "0", "--particles", "65536"], cwd=ROOT, env=environment,
                          stdout=subprocess.PIPE, check=True, text=True)
    return json.loads(done.stdout)["sand"]


def compare_with_lean(build, lean, rounds=7):
    """The same sand with both libraries in turns: the fastest step of each, and its memory."""
    libraries = {"whole": build / "runtime" / "libloam.so", "lean": lean / "runtime" / "libloam.so"}
    runs = {name: [] for name in libraries}
    for number in range(rounds):
        for name in sorted(libraries, reverse=number % 2 == 0):
            runs[name].append(sand_with(build, libraries[name]))
    return {name: {"seconds": min(run["seconds"] for run in of), "bytes": sum(of[0]["memory"].values()),
                   "library": libraries[name].stat().st_size} for name, of in runs.items()}


def lean_text(both):
    whole, lean = both["whole"], both["lean"]
    return (f"The sand, 65536 particles, with the whole library and with one that was built for sand alone (`cmake --preset lean`: no other law, "
            f"no cloth), in turns: a step takes {1e3 * whole['seconds']:.2f} ms and {1e3 * lean['seconds']:.2f} ms, a ratio of "
            f"{whole['seconds'] / lean['seconds']:.3f}; the world takes {whole['bytes']} and {lean['bytes']} bytes. The libraries, the whole one with its CUDA backend if it has one, have "
            f"{whole['library'] / 1e6:.1f} and {lean['library'] / 1e6:.1f} MB.")


def nanoseconds(state, results):
    """of a particle and substep"""
    return 1e9 * state["seconds"] / results["options"]["particles"] / results["options"]["substeps"]


def own_stages(effect):
    before, after = effect["without"]["stages"], effect["with"]["stages"]
    return [name for name in after if name not in before]


def added_bytes(effect, results):
    before, after = effect["without"]["memory"], effect["with"]["memory"]
    return (sum(after.values()) - sum(before.values())) / results["options"]["particles"]


def effects_table(results):
    rows = ["| effect | measured as | ns a particle and substep | over the scene without | bytes a particle | stages of its own |",
            "| --- | --- | --: | --: | --: | --- |"]
    for effect in results["effects"]:
        without, with_it = (nanoseconds(effect[k], results) for k in ("without", "with"))
        rows.append(f"| {effect['name']} | {effect['scene']} | {with_it - without:+.1f} | {100 * (with_it / without - 1):+.1f} % | "
                    f"{added_bytes(effect, results):+.1f} | {', '.join(own_stages(effect))} |")
    return "\n".join(rows)


def sand_table(results):
    sand = results["sand"]
    whole = sum(sand["stages"].values())
    rows = ["| stage | ns a particle and substep | share |", "| --- | --: | --: |"]
    for name, seconds in sand["stages"].items():
        rows.append(f"| {name} | {nanoseconds({'seconds': seconds}, results):.1f} | {100 * seconds / whole:.1f} % |")
    rows += ["", "| memory | bytes a particle |", "| --- | --: |"]
    for name, size in sand["memory"].items():
        rows.append(f"| {name} | {size / results['options']['particles']:.1f} |")
    return "\n".join(rows)


def sleep_text(results):
    sleep = results["sleep"]
    awake, asleep = sleep["awake"]["seconds"], sleep["asleep"]["seconds"]
    hit = next(step for step in sleep["hit"] if step["awake"] > 1)
    return (f"A pile of {sleep['particles']} grains falls asleep {sleep['seconds_until_asleep']:.1f} s after it was put down. A step then takes "
            f"{1e3 * asleep:.3f} ms; awake it takes {1e3 * awake:.1f} ms: {100 * asleep / awake:.2f} %. In the step in which a grain at 5 m/s "
            f"hits it, {hit['awake'] - 1} others wake, and the step takes {1e3 * hit['seconds']:.1f} ms; "
            f"{len(sleep['hit'])} steps later {sleep['hit'][-1]['awake']} are awake.")


def plot(results):
    effects = results["effects"][::-1]
    costs = [100 * (e["with"]["seconds"] / e["without"]["seconds"] - 1) for e in effects]
    pyplot.rcParams.update({"svg.hashsalt": "loam", "font.size": 9})
    figure, axes = pyplot.subplots(figsize=(8, 0.3 * len(effects) + 1))
    bars = axes.barh([e["name"] for e in effects], costs, color=[COLOURS[e["group"]] for e in effects])
    axes.bar_label(bars, [f" {c:+.1f} % " for c in costs])
    axes.axvline(0, color="#333333", linewidth=0.8)
    axes.set_xlabel("time of a step over that of the scene without the effect, %")
    axes.margins(x=0.15)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    figure.tight_layout()
    figure.savefig(PLOT, metadata={"Date": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "release")
    parser.add_argument("--lean", type=pathlib.Path, default=ROOT / "build" / "lean")
    parser.add_argument("--json", type=pathlib.Path)
    parser.add_argument("--keep", type=pathlib.Path)
    arguments = parser.parse_args()
    results = json.loads(arguments.json.read_text()) if arguments.json else run(arguments.build.resolve())
    if arguments.keep:
        arguments.keep.write_text(json.dumps(results, indent=1))
    build, lean = arguments.build.resolve(), arguments.lean.resolve()
    if not (lean / "runtime" / "libloam.so").exists():
        sys.exit(f"error: no library in {lean}: cmake --preset lean && cmake --build --preset lean")
    options = results["options"]
    parts = {
        "machine": f"{processor()}, {options['threads']} thread; {options['particles']} particles, {options['substeps']} substeps of {1e3 * options['substep_seconds']:g} ms a step, "
                   f"{options['iterations']} iterations; the fastest of the steps.",
        "sand": sand_table(results),
        "effects": effects_table(results),
        "sleep": sleep_text(results),
        "lean": lean_text(compare_with_lean(build, lean)),
    }
    document = DOCUMENT.read_text()
    for name, text in parts.items():
        begin, end = f"<!-- {name}: scripts/effects.py -->", f"<!-- end of {name} -->"
        before, found, rest = document.partition(begin)
        _, ended, after = rest.partition(end)
        if not found or not ended:
            sys.exit(f"error: {DOCUMENT} has no place for '{name}'")
        document = f"{before}{begin}\n\n{text}\n\n{end}{after}"
    DOCUMENT.write_text(document)
    plot(results)
    print(f"{len(results['effects'])} effects written to {DOCUMENT.relative_to(ROOT)} and {PLOT.relative_to(ROOT)}")


if __name__ == "__main__":
    main()
