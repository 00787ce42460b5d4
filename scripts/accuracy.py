#!/usr/bin/python3
"""Writes docs/accuracy.html, the page of the accuracy study, from the table that loam-accuracy wrote.

    accuracy.py TABLE [--out FILE] [--pictures DIR]

Every number on the page comes from the table; the page loads nothing from elsewhere.
"""

import argparse
import base64
import datetime
import html
import json
import pathlib
import re
import subprocess
import sys

try:
    import accuracy_plots as plots
except ImportError:
    sys.exit("error: matplotlib is missing: scripts/install_dependencies.sh docs")
from accuracy_data import DEFAULT, FORMS, SCALAR, cheapest, choose, cost_of_halving, digits, front, quantile, read

ROOT = pathlib.Path(__file__).resolve().parent.parent
STYLE = """
:root { color-scheme: light dark; }
body { font: 16px/1.55 system-ui, sans-serif; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; }
h1 { line-height: 1.2; } h2 { margin-top: 2.6rem; border-bottom: 1px solid #8886; padding-bottom: .2rem; }
svg { max-width: 100%; height: auto; display: block; margin: 1rem 0; }
table { border-collapse: collapse; font-size: .92rem; margin: 1rem 0; display: block; overflow-x: auto; }
th, td { padding: .3rem .7rem; text-align: right; border-bottom: 1px solid #8884; } th { font-weight: 600; }
th:first-child, td:first-child { text-align: left; } td:not(:last-child) { white-space: nowrap; }
.finding { border-left: 4px solid #3b82f6; padding: .2rem .9rem; background: #3b82f61a; }
.pictures { display: grid; grid-template-columns: repeat(auto-fit, minmax(20rem, 1fr)); gap: 1rem; margin: 1rem 0; } .pictures figure { margin: 0; }
.pictures img { width: 100%; height: auto; border-radius: 4px; display: block; }
.small { font-size: .88rem; opacity: .8; } code { font-size: .9em; }
"""

# effect: heading, its error (case, name of the error), the axis, how to read it
EFFECTS = {
    "beam": ("A beam under its weight", "E 1e5 Pa", "drop over the exact one", "error of the drop",
             "A soft beam is clamped at one end and bends under its own weight. The error is how much lower its end comes to rest than with the same particles "
             "solved exactly: too few iterations make bodies act softer than their material."),
    "sand": ("A collapsing slab of sand", "slab", "run-out over the finest setting", "error of the run-out",
             "Sand is let go beside a wall and runs out over the ground. The error is how far its edge ends from where it ends at the finest setting."),
    "snow": ("Thrown snow", "plasticity within the iterations", "shape over that of the finest setting", "difference of the shape",
             "A block of snow hits the ground at 6 m/s. The error is how much its crushed shape differs from the one at a twentieth of a millisecond."),
    "dam": ("A breaking dam", "n^2 = 2", "front over Martin and Moyce", "greatest error of the front",
            "A column of water is let go. The error is the greatest distance of its front from what Martin and Moyce measured in 1952."),
    "cloth": ("A very soft sheet", "soft sheet", "stretch over the closed form", "error of the stretch",
              "A sheet hangs by its upper edge; its weight stretches it by a length that has a formula. It is as soft as no garment is, so that the stretch can be seen, and "
              "it has no greatest stretch, which hides the error of stiffer cloth."),
    "penetration": ("Sand in a groove of triangles", "into a groove", "depth over the radius of a grain", "depth over the radius of a grain",
                    "Sand falls at 2 m/s into a groove of a triangle mesh. The error is how deep any grain is ever seen within the mesh."),
}
STEPS = [("coarse", 2e-3, 2), ("default", 1e-3, 5), ("fine", 5e-4, 10)]


def percent(value):
    return "under 0.001 %" if value < 1e-5 else f"{digits(100 * value)} %"


def times(value):
    return f"{digits(value)} times"


def milliseconds(row):
    return f"{digits(row.frame)} ms"


def table(head, lines):
    def cells(tag, values):
        return "<tr>" + "".join(f"<{tag}>{value}</{tag}>" for value in values) + "</tr>"
    return "<table>" + cells("th", head) + "".join(cells("td", line) for line in lines) + "</table>"


def finding(text):
    return f'<p class="finding">{text}</p>'


def of_effect(rows, effect, form=None, presets=False):
    _, case, name, _, _ = EFFECTS[effect]
    return choose(rows, effect, case, name, form, presets)


def nearest(rows, substep, iterations):
    """Of the settings that were measured the one whose work is most like it."""
    import math
    return min(rows, key=lambda row: abs(math.log(row.substep / substep)) + abs(math.log(row.iterations / iterations)))


# ------------------------------------------------------------------------------------------------ what it costs and buys ---
def bought(row, rows, scatter):
    """What half of the error of a setting would cost."""
    if row.off < max(scatter, 1e-5):
        return "no error that could be told from chance" if scatter else "no error to speak of"
    better = cheapest(rows, row.off / 2)
    if better is None:
        return "no setting here has it"
    if better.seconds < 1.02 * row.seconds:
        return f"no more time, but other numbers: {better.setting}"
    return f"{times(better.seconds / row.seconds)} the time: {better.setting}"


def scatter_of_sand(rows):
    errors = [row.error for row in choose(rows, "sand", "other grains")]
    return max(errors) - min(errors) if errors else 0


def overview(rows):
    presets = sorted({row.preset for row in rows if row.preset}, key=["fast", "balanced", "accurate", "reference"].index)
    lines = []
    experiments = [(effect, heading, case, name) for effect, (heading, case, name, *_) in EFFECTS.items()]
    experiments.insert(-1, ("cloth", "A hanging strip of cloth", "strip", "sag over the catenary"))
    for effect, heading, case, name in experiments:
        own = choose(rows, effect, case, name, DEFAULT)
        if not own:
            continue
        chosen = {row.preset: row for row in choose(rows, effect, case, name, DEFAULT, True)}
        if not presets:
            chosen = {name: nearest(own, substep, iterations) for name, substep, iterations in STEPS}
        scatter = scatter_of_sand(rows) if effect == "sand" else 0
        for number, name in enumerate(name for name in presets or [step[0] for step in STEPS] if name in chosen):
            row = chosen[name]
            setting = f"{name}: {row.setting}"
            lines.append((heading if number == 0 else "", setting, percent(row.off), milliseconds(row), bought(row, own, scatter)))
    what = ("The presets choose substeps from what moves and how stiff it is." if presets else
            "Each line is a setting: the length of a substep, and its iterations.")
    return (f"<p>{what} The error says how far off the experiment ends; the time is that of one core for a frame of 1/60 s and 1000 particles (vertices, of cloth); the "
            "last column is what half of that error would cost, with the cheapest setting that reaches it.</p>" +
            table(("effect", "preset" if presets else "setting", "error", "time", "half the error"), lines))


# ------------------------------------------------------------------------------------------------------- each effect ---
def chance_finding(rows, effect, scatter):
    """Of an effect whose differences are mostly chance."""
    parts = [f"The same setting with its grains placed a little differently ends within {percent(scatter)}: less than that says nothing about a setting."]
    for form, name in FORMS.items():
        own = of_effect(rows, effect, form)
        if own:
            good = [row for row in own if row.off <= scatter]
            parts.append(f"{name}: {len(good)} of {len(own)} settings are within that" + (f", the cheapest with {min(good, key=lambda row: row.seconds).setting} at "
                         f"{milliseconds(min(good, key=lambda row: row.seconds))}." if good else "."))
    return finding(" ".join(parts))


def effect_finding(rows, effect):
    own = of_effect(rows, effect, DEFAULT)
    usable = [row for row in own if row.off < 0.1] or own
    factor = cost_of_halving(own)
    best, least = min(own, key=lambda row: row.off), min(usable, key=lambda row: row.seconds)
    parts = [f"The cheapest setting within 10 % ({least.setting}) is off by {percent(least.off)} at {milliseconds(least)}; the best one ({best.setting}) by "
             f"{percent(best.off)} at {milliseconds(best)}."]
    if factor is not None:
        parts.append(f"Along the cheapest settings, each halving of the error costs about {times(factor)} the time.")
    else:
        parts.append("Beyond that the error hardly depends on the setting.")
    target = quantile([row.off for row in front(usable)], 0.5)
    ours = cheapest(own, target)
    for form, name in FORMS.items():
        other = of_effect(rows, effect, form)
        if form == DEFAULT or not other:
            continue
        theirs = cheapest(other, target)
        if theirs is None:
            parts.append(f"{name} does not reach {percent(target)} with any setting here; its best is {percent(min(row.off for row in other))}.")
        else:
            parts.append(f"To {percent(target)}, {name} takes {times(theirs.seconds / ours.seconds)} the time of the default.")
    return finding(" ".join(parts))


def sand_notes(rows):
    experiment = choose(rows, "sand", "slab", "run-out over the experiment")
    ours = [row for row in experiment if row.form == DEFAULT]
    text = (f"<p>Against the run-out that Lube et al. measured in 2005, the default solver's settings are off by {percent(quantile([r.off for r in ours], 0.5))} in the middle. ")
    points = [row for row in experiment if row.form[0] == "material points"]
    for row in points:
        rival = cheapest(ours, row.off)
        text += (f"Explicit material points with {row.form[1]} (plain scalar code in double precision, no rival in speed) are off by {percent(row.off)} at {milliseconds(row)}"
                 + (f"; the default solver is as close at {milliseconds(rival)}. " if rival else ". "))
    return text + "</p>"


def effect_section(rows, effect):
    heading, _, _, axis, text = EFFECTS[effect]
    own = of_effect(rows, effect)
    if not own:
        return ""
    parts = [f"<h2>{heading}</h2><p>{text} Lower and further left is better.</p>",
             plots.error_over_time(own, axis, of_effect(rows, effect, DEFAULT, True)),
             chance_finding(rows, effect, scatter_of_sand(rows)) if effect == "sand" else effect_finding(rows, effect)]
    if effect == "sand":
        parts.append(sand_notes(rows))
    if effect == "beam":
        parts.append(beam_notes(rows))
    if effect == "snow":
        control = choose(rows, "snow", "plasticity after the substep")
        worst = max(control, key=lambda row: row.off)
        same = [row for row in own if row.form == DEFAULT and row.setting == worst.setting]
        if same:
            parts.append(f"<p>With plasticity taken once, after the substep, the shape at {worst.setting} iterations differs by {percent(worst.off)} from its own finest one; with plasticity within the "
                         f"iterations by {percent(same[0].off)}.</p>")
    if effect == "cloth":
        strip = choose(rows, "cloth", "strip")
        if strip:
            best = cheapest(strip, 0.02)
            parts.append(f"<p>Cloth that does not stretch converges far sooner: a strip that hangs between two points has the sag of a catenary within 2 % from {best.setting} iterations on, at "
                         f"{milliseconds(best)}.</p>")
    return "".join(parts)


def beam_notes(rows):
    def notes(effect):
        return "; ".join(f"{FORMS[row.form]}, {row.setting} iterations: {percent(row.off)}{' (it fell off)' if row.off > 1 else ''}" for row in choose(rows, effect))
    layers = "; ".join(f"{row.case}: {percent(row.off)}" for row in choose(rows, "layers"))
    counted = choose(rows, "iterations")
    text = ""
    if counted:
        most = max(counted, key=lambda row: row.iterations)
        text += f"<p>From 10 to {most.iterations} iterations in substeps of {1e3 * most.substep:g} ms the drop changes by {percent(most.off)}.</p>"
    if layers:
        text += (f"<p>Iterations cannot mend what the particles do not resolve. Over the continuous body, by finite elements, a beam four times as long as thick is off by: {layers}. "
                 "More layers of particles are what helps there.</p>")
    if choose(rows, "far bent"):
        text += f"<p>A slender beam that bends far, qL³/EI = 5, over the elastica: {notes('far bent')}.</p>"
    return text


# ------------------------------------------------------------------------------------------------------- comparisons ---
def equal_error(rows):
    lines, ratios = [], {}
    for effect, name, what in (("beam", "drop over the exact one", "drop at rest"), ("one step", "velocity", "velocity after a substep"),
                               ("beam", "drop over finite elements", "drop of the continuous body")):
        for case in sorted({row.case for row in choose(rows, effect)}):
            for error in (0.05, 0.01) if "finite" not in name else (0.4,):
                ours, theirs = (cheapest(choose(rows, effect, case, name, form), error) for form in (DEFAULT, SCALAR))
                best = min(row.off for row in choose(rows, effect, case, name, SCALAR))
                if ours and theirs:
                    ratios.setdefault(what, []).append(theirs.seconds / ours.seconds)
                lines.append((f"{what}, {case.replace('1e', '10<sup>').replace(' Pa', '</sup> Pa')}", percent(error),
                              f"{ours.setting}: {milliseconds(ours)}" if ours else "not reached",
                              f"{theirs.setting}: {milliseconds(theirs)}" if theirs else f"not reached, best {percent(best)}",
                              digits(theirs.seconds / ours.seconds) if ours and theirs else "-"))
    if not lines:
        return ""
    costs = " and ".join(f"{digits(min(r))} to {digits(max(r))} times for the {what}" for what, r in ratios.items())
    continuous = {form: min(row.off for row in choose(rows, "beam", "E 1e5 Pa", "drop over finite elements", form)) for form in (DEFAULT, SCALAR)}
    return ("<h2>The default against the paper's scalar multiplier</h2><p>The cheapest setting of each with Gauss-Seidel that reaches an error, and the ratio of their costs: over 1 "
            "the default is cheaper. Each is held against the exact solution of its own equations, for only the default resists zig-zag motions that no velocity gradient "
            "shows; the scalar form's exact solution is that of a softer beam.</p>" +
            table(("measure", "error", "default (tensor)", "scalar", "scalar over default"), lines) +
            finding(f"Where both reach an error, the scalar form costs {costs} what the default does. But its equations are those of another body: against the continuous beam, by finite "
                    f"elements, its drop is off by {percent(continuous[SCALAR])} at best, the default's by {percent(continuous[DEFAULT])}, with the same layers of particles. "
                    + motion_sentence(rows)))


def motion_sentence(rows):
    def floor(form):
        converged = [row for row in choose(rows, "one step", "E 1e5 Pa", "velocity", form) if row.substep == 1e-3]
        return min(row.off for row in converged) if converged else None
    ours, theirs = floor(DEFAULT), floor(SCALAR)
    if ours is None or theirs is None:
        return ""
    return (f"And in motion more iterations do not help it: the velocity after a substep of 1 ms stays {percent(theirs)} off however many there are, "
            f"where the default comes to {percent(ours)}.")


def estimates(rows):
    own = [row for row in choose(rows, "estimate") if row.residual > 0]
    if not own:
        return ""
    forms = [form for form in FORMS if any(row.form == form for row in own)]
    parts = []
    for form in forms:
        ratios = [row.seen / row.residual for row in own if row.form == form and 1e-3 < row.residual < 0.3]
        if ratios:
            parts.append(f"with {FORMS[form]} the true error is {digits(quantile(ratios, 0.5))} times the estimate in the middle, and between {digits(quantile(ratios, 0.1))} and "
                         f"{digits(quantile(ratios, 0.9))} times in eight of ten cases")
    return ("<h3>How good the library's own estimate is</h3><p>A world that keeps to a tolerance estimates the error of each substep as it iterates; the line is where the estimate "
            "is the error.</p>" + plots.calibration(own, "solution_error in loam_statistics", forms, True) +
            finding("Where the estimate is between 0.1 % and 30 %, " + "; ".join(parts) + "."))


def calibration(rows):
    steps = choose(rows, "one step")
    if not steps:
        return ""
    tensor = [row for row in steps if row.form == DEFAULT and row.residual > 1e-5 and row.off < 1]
    ratios = [row.off / row.residual for row in tensor]
    scalar = [row for row in steps if row.form == SCALAR and row.residual < 1e-5]
    text = (f"For the default, the true error of a substep is {quantile(ratios, 0.5):.0f} times the residual in the middle, and between {quantile(ratios, 0.1):.0f} and "
            f"{quantile(ratios, 0.9):.0f} times in eight of ten cases: a residual of 10<sup>-4</sup> stands for an error of about {percent(1e-4 * quantile(ratios, 0.5))}. ")
    if scalar:
        text += (f"For the scalar form it says nothing of the kind: where it is under 10<sup>-5</sup>, the true error is {percent(quantile([row.off for row in scalar], 0.5))} in the middle and up to "
                 f"{percent(max(row.off for row in scalar))}.")
    return ("<h2>What the residual says</h2><p>A bent beam is let go for one substep, and its velocities are compared with the exact solution of that substep. It is a hard "
            "measure: stresses that nearly balance leave a small motion, and all of their error. What the statistics report after the last iteration stands on the other axis.</p>" +
            plots.calibration(steps, "residual in loam_statistics after the last iteration") + finding(text) + estimates(rows) +
            "<h3>How the error falls with the iterations</h3><p>E = 10<sup>5</sup> Pa. Left, each line keeps falling, the later the longer the substep; right, it stops where the form's own "
            "error begins.</p>" + plots.error_over_iterations([row for row in steps if row.case == "E 1e5 Pa"]))


def smallness(rows, large):
    """How much more a particle of the beam takes, of which there are few."""
    few = [row for row in choose(rows, "beam", "E 1e5 Pa", form=DEFAULT) if row.iterations == large.iterations and row.substep == 1e-3]
    if not few:
        return ""
    ratio = few[0].seconds * few[0].substep / few[0].particles / large.error
    return (f"The beam above has {few[0].particles} particles, which fill neither vectors nor cells: one of them takes {times(ratio)} that. In large worlds its "
            "settings are cheaper by about as much.")


def costs(rows):
    of_each = {name: choose(rows, f"stages of {name}") for name in ("sand", "rubber", "water")}
    of_each = {name: own for name, own in of_each.items() if own}
    counts = choose(rows, "scaling")
    if not of_each or not counts:
        return ""
    default = sorted((row for row in counts if row.form == DEFAULT), key=lambda row: row.particles)
    low, high = min(default, key=lambda row: row.error), max(default, key=lambda row: row.error)
    largest = {name: max(own, key=lambda row: row.error) for name, own in of_each.items()}
    return ("<h2>What a step is made of</h2>" + plots.breakdown(of_each) +
            finding("The largest part is " + ", ".join(f"<i>{row.case}</i> for {name} ({percent(row.error)})" for name, row in largest.items()) +
                    f", with {largest['sand'].iterations} iterations and {largest['sand'].particles} particles.") +
            "<h2>Larger worlds</h2>" + plots.scaling(counts) +
            finding(f"A particle and substep takes {1e9 * low.error:.0f} ns at the least, with {low.particles} particles, and {1e9 * high.error:.0f} ns at the most, with {high.particles}, "
                    f"on one thread with {low.iterations} iterations of the default solver. " + smallness(rows, low)))


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return line.partition(":")[2].strip()
    return "unknown processor"


def pictures(directory):
    """The same scene with each preset, from what loam-run left of it in the directory."""
    if directory is None:
        return ""
    figures, cheapest_frame = [], None
    for preset in ("fast", "balanced", "accurate", "reference"):
        run = json.loads((directory / preset / "stats.json").read_text(encoding="utf-8"))
        cheapest_frame = cheapest_frame or run["seconds_per_frame"]
        image = base64.b64encode((directory / f"{preset}.png").read_bytes()).decode("ascii")
        caption = (f"<b>{preset}</b>: {digits(run['substeps_per_frame'])} substeps of {digits(run['iterations_per_substep'])} iterations a frame, "
                   f"{times(run['seconds_per_frame'] / cheapest_frame)} the time of the first")
        figures.append(f'<figure><img alt="A rubber bridge, {preset}" src="data:image/png;base64,{image}"><figcaption class="small">{caption}</figcaption></figure>')
    return ("<h2>What it looks like</h2><p>A bridge of rubber, two seconds after it was let go on its piers. Coarse settings act softer than the material is, so it sags further; more than "
            "is needed buys nothing that could be seen.</p><div class=\"pictures\">" + "".join(figures) + "</div>")


def page(rows, directory):
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True, check=False).stdout.strip()
    body = ["<h1>How accurate a setting is, and what it costs</h1>",
            "<p>A world is given substeps and iterations. Substeps cut a frame into shorter ones; iterations work on the equations of each. This page shows, for each effect, how far from a "
            "reference a setting ends and what it costs, so that you can pay for what you need: each effect stands for a look or a measure that a player or a designer would notice.</p>",
            f'<p class="small">{html.escape(processor())}, one thread, {datetime.date.today():%d %B %Y}{", commit " + commit if commit else ""}. Times are seconds of the processor, the median of '
            "the frames; the scenes have 240 to 1440 particles.</p>",
            "<h2>What settings cost and buy</h2>", overview(rows), pictures(directory)]
    body += [effect_section(rows, effect) for effect in EFFECTS]
    body += [equal_error(rows), calibration(rows), costs(rows),
             "<h2>To do it again</h2><p><code>scripts/accuracy.sh</code> builds, measures (about ten minutes) and writes this page; <code>scripts/accuracy.sh --quick</code> "
             "does a small part of it in half a minute. The numbers are in <code>benchmarks/results/</code>.</p>"]
    text = re.sub(r"\n\s*\n", "\n", "\n".join(body))
    return ('<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">'
            f"<title>Loam: accuracy and its cost</title><style>{STYLE}</style></head><body>\n{text}\n</body></html>\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("table", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs" / "accuracy.html")
    parser.add_argument("--pictures", type=pathlib.Path, help="the folder that accuracy.sh puts pictures of the presets into")
    arguments = parser.parse_args()
    rows = read(arguments.table)
    arguments.out.write_text(page(rows, arguments.pictures), encoding="utf-8")
    print(f"{len(rows)} rows made {arguments.out}")


if __name__ == "__main__":
    main()
