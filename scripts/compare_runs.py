#!/usr/bin/env python3
"""Whether two runs of loam-run tell the same story: compare_runs.py FIRST SECOND, the folders with stats.json and series.csv.

Backends sum neighbours in different orders, and matter is chaotic: single particles part soon, the bulk does not. So compared are the number
of particles in the scene's watched region and the mean speed, frame by frame, and that nothing was lost.
"""
import csv
import json
import pathlib
import sys

WATCHED = 0.02     # of all particles
MEAN_SPEED = 0.05  # of the largest mean speed of the first run


def read(folder: str) -> tuple[dict, list[dict]]:
    path = pathlib.Path(folder)
    with open(path / "series.csv", newline="", encoding="utf-8") as file:
        return json.loads((path / "stats.json").read_text(encoding="utf-8")), list(csv.DictReader(file))


def main() -> int:
    (first, first_series), (second, second_series) = read(sys.argv[1]), read(sys.argv[2])
    if first["particles"] != second["particles"] or len(first_series) != len(second_series) or not first_series:
        sys.exit(f"the runs differ: {first['particles']} particles in {len(first_series)} frames, "
                 f"{second['particles']} in {len(second_series)}")

    def difference(column: str, scale: float) -> float:
        return max(abs(float(a[column]) - float(b[column])) for a, b in zip(first_series, second_series)) / scale

    rows = [("watched particles, share of all", difference("watched", first["particles"]), WATCHED),
            ("mean speed, share of its peak", difference("mean_speed", max(float(row["mean_speed"]) for row in first_series) or 1), MEAN_SPEED),
            ("not finite", float(first["non_finite"] + second["non_finite"]), 0.0)]
    if first["outside_colliders"] is not None:
        rows.append(("outside colliders, share of all", abs(first["outside_colliders"] - second["outside_colliders"]) / first["particles"], WATCHED))
    faults = 0
    print(f"{first['backend']} and {second['backend']}: {first['particles']} particles, {len(first_series)} frames; the largest differences")
    for name, value, limit in rows:
        faults += value > limit
        print(f"  {name:34} {value:.4g} (limit {limit:g}){'  TOO LARGE' if value > limit else ''}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
