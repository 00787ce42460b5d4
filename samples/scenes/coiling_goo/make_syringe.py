#!/usr/bin/env python3
"""Writes syringe.obj, a barrel that narrows to a nozzle, open above and below, whose mouth is at y = 0, and piston.obj, a disc that fits into
the barrel and lies on y = 0.

    python3 make_syringe.py [folder]
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import mesh_tools  # noqa: E402

NOZZLE, BARREL, WALL = 0.0055, 0.018, 0.0025  # inner radii, thickness
NOZZLE_TOP, SHOULDER, TOP = 0.012, 0.026, 0.110
PISTON, PISTON_HEIGHT = 0.0177, 0.012


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    inner = [(NOZZLE, 0.0), (NOZZLE, NOZZLE_TOP), (BARREL, SHOULDER), (BARREL, TOP)]
    outer = [(BARREL + WALL, TOP), (BARREL + WALL, SHOULDER - 0.001), (NOZZLE + WALL, NOZZLE_TOP - 0.001), (NOZZLE + WALL, 0.0)]
    mesh_tools.write_obj(folder / "syringe.obj", "syringe", "A syringe, written by make_syringe.py. Its mouth is at y = 0.",
                         mesh_tools.lathe(inner + outer, 64))
    piston = mesh_tools.revolve([(PISTON, 0.0), (PISTON, PISTON_HEIGHT)], 0.0, PISTON_HEIGHT, 64)
    mesh_tools.write_obj(folder / "piston.obj", "piston", "Its piston, written by make_syringe.py. It lies on y = 0.", piston)


if __name__ == "__main__":
    main()
