"""The rows of the accuracy study, and what is asked of them: the cheapest settings, what half the error costs, who is cheaper at an equal error."""

import csv
import math
import pathlib

FORMS = {("gauss_seidel", "tensor"): "Gauss-Seidel, tensor (the default)", ("gauss_seidel", "scalar"): "Gauss-Seidel, scalar (as in the paper)",
         ("jacobi", "tensor"): "Jacobi, tensor", ("jacobi", "scalar"): "Jacobi, scalar"}
DEFAULT, SCALAR = ("gauss_seidel", "tensor"), ("gauss_seidel", "scalar")


class Row:
    def __init__(self, fields):
        self.effect, self.case, self.preset = fields["effect"], fields["case"], fields.get("preset", "")
        self.form = (fields["solver"], fields["multiplier"])
        self.error_name = fields["error_name"]
        self.substep, self.error, self.seconds, self.residual = (float(fields[k]) for k in ("substep_s", "error", "seconds_per_second", "residual"))
        self.iterations, self.particles = int(fields["iterations"]), int(fields["particles"])

        self.seen = max(abs(self.error), 1e-6)  # how far off it was, without the sign; what single precision cannot tell from nothing is one thing
        self.off = self.seen  # how far off it is: see `settle`

    @property
    def frame(self):
        """Milliseconds that 1000 particles take in a frame of a sixtieth of a second."""
        return 1e3 * self.seconds / 60 * 1000 / max(self.particles, 1)

    @property
    def setting(self):
        return f"{1e3 * self.substep:.3g} ms, {self.iterations}"


def settle(rows):
    """An error that changes its sign on its way vanishes for a setting by luck. So a setting is taken to be no better than those with more iterations in the same substep."""
    groups = {}
    for row in rows:
        groups.setdefault((row.effect, row.case, row.error_name, row.form, row.substep, row.preset), []).append(row)
    for group in groups.values():
        worst = 0.0
        for row in sorted(group, key=lambda row: -row.iterations):
            worst = row.off = max(worst, row.seen)
    return rows


def read(path):
    with pathlib.Path(path).open(encoding="utf-8") as file:
        return settle([Row(fields) for fields in csv.DictReader(file)])


def choose(rows, effect, case=None, error_name=None, form=None, presets=False):
    return [row for row in rows if row.effect == effect and case in (None, row.case) and error_name in (None, row.error_name)
            and form in (None, row.form) and bool(row.preset) == presets]


def front(rows):
    """Those than which nothing is both cheaper and more accurate, cheapest first."""
    best, kept = math.inf, []
    for row in sorted(rows, key=lambda row: (row.seconds, row.off)):
        if row.off < best:
            best = row.off
            kept.append(row)
    return kept


def cheapest(rows, error):
    good = [row for row in rows if row.off <= error]
    return min(good, key=lambda row: row.seconds) if good else None


def digits(value, count=2):
    """With so many significant digits, never as a power of ten."""
    if value == 0 or not math.isfinite(value):
        return f"{value:g}"
    places = count - 1 - math.floor(math.log10(abs(value)))
    return f"{round(value, places):.{max(0, places)}f}"


def cost_of_halving(rows, most=0.5, least=2e-6):
    """By what the cheapest cost rises for every halving of the error, over the settings that are usable at all: a straight line through the logarithms. None where
    the error hardly depends on the setting."""
    points = [(math.log2(row.off), math.log2(row.seconds)) for row in front(rows) if least < row.off < most]
    if len(points) < 3 or points[0][0] - points[-1][0] < 1:
        return None
    mean = [sum(p[k] for p in points) / len(points) for k in (0, 1)]
    slope = sum((x - mean[0]) * (y - mean[1]) for x, y in points) / sum((x - mean[0]) ** 2 for x, _ in points)
    return 2 ** -slope


def quantile(values, share):
    values = sorted(values)
    return values[min(len(values) - 1, int(share * len(values)))]
