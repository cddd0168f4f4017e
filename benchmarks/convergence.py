#!/usr/bin/env python3
"""convergence.py LUCERNA PLOT.svg   true error against time, for scenes whose truth is known without the engine.

Runs `LUCERNA validate` with each method and several numbers of phases, prints the root mean square of the relative errors
of all checks of a case over the seeds, with the time of a run on one thread, and draws them on logarithmic axes."""
import json
import math
import subprocess
import sys
import tempfile

CASES = ["closed_box/grey", "integrating_sphere/0.95", "ball_lens/beyond-focus"]
METHODS = {"combined": "#0b5394", "forward": "#38761d", "backward": "#b45f06", "path": "#741b47"}
PHASES = [4, 16, 64, 256]
SEEDS = 4


def measure(lucerna, case, method, phases):
    """(seconds of a run, root mean square of the relative errors)"""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([lucerna, "validate", case, "--method", method, "--phases", str(phases), "--seeds", str(SEEDS),
                        "--threads", "1", "-o", folder], stdout=subprocess.DEVNULL, check=False)  # 1: TOO WEAK checks
        with open(folder + "/validation.json") as file:
            own = json.load(file)["cases"][0]
    errors = [(reading["value"] - check["truth"]) / check["truth"] for check in own["checks"] for reading in check["readings"]]
    return (sum(run["wall_s"] for run in own["runs"]) / len(own["runs"]),
            math.sqrt(sum(error * error for error in errors) / len(errors)))


def slope(points):
    """Of the logarithms, by least squares."""
    x = [math.log(seconds) for seconds, _ in points]
    y = [math.log(error) for _, error in points]
    mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x) ** 2 for a in x)


def panel(left, title, curves):
    """SVG of one case: decades of time across, of error upward."""
    all_points = [point for points in curves.values() for point in points]
    x0, x1 = (f(math.log10(seconds) for seconds, _ in all_points) for f in (min, max))
    y0, y1 = (f(math.log10(error) for _, error in all_points) for f in (min, max))
    x0, x1, y0, y1 = math.floor(x0), math.ceil(x1), math.floor(y0), math.ceil(y1)
    width, height, top = 260, 260, 40

    def at(seconds, error):
        return (left + width * (math.log10(seconds) - x0) / (x1 - x0),
                top + height * (y1 - math.log10(error)) / (y1 - y0))

    parts = [f'<text x="{left}" y="24" font-weight="bold">{title}</text>']
    for decade in range(x0, x1 + 1):
        x, _ = at(10.0 ** decade, 10.0 ** y0)
        parts.append(f'<path d="M{x:.1f} {top}v{height}" stroke="#ddd"/>'
                     f'<text x="{x:.1f}" y="{top + height + 16}" text-anchor="middle">{10.0 ** decade:g} s</text>')
    for decade in range(y0, y1 + 1):
        _, y = at(10.0 ** x0, 10.0 ** decade)
        parts.append(f'<path d="M{left} {y:.1f}h{width}" stroke="#ddd"/>'
                     f'<text x="{left - 6}" y="{y + 4:.1f}" text-anchor="end">{100.0 * 10.0 ** decade:g} %</text>')
    for row, (method, points) in enumerate(curves.items()):
        places = [at(*point) for point in points]
        line = " ".join(f"{x:.1f},{y:.1f}" for x, y in places)
        parts.append(f'<polyline points="{line}" fill="none" stroke="{METHODS[method]}" stroke-width="2"/>')
        parts += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{METHODS[method]}"/>' for x, y in places]
        parts.append(f'<text x="{left}" y="{top + height + 36 + 16 * row}" fill="{METHODS[method]}">{method}, '
                     f'slope {slope(points):.2f}</text>')
    return "\n".join(parts)


def main():
    lucerna, plot = sys.argv[1:]
    panels = []
    for number, case in enumerate(CASES):
        curves = {method: [measure(lucerna, case, method, phases) for phases in PHASES] for method in METHODS}
        print(f"{case}: error after {', '.join(map(str, PHASES))} phases (seconds)")
        for method, points in curves.items():
            row = "   ".join(f"{100.0 * error:6.3f} % ({seconds:.2f})" for seconds, error in points)
            print(f"  {method:9} {row}   slope {slope(points):.2f}")
        panels.append(panel(70 + 340 * number, case, curves))
    with open(plot, "w") as file:
        file.write('<svg xmlns="http://www.w3.org/2000/svg" width="1040" height="410" font-family="sans-serif" '
                   'font-size="12">\n<rect width="1040" height="410" fill="white"/>\n' + "\n".join(panels) + "\n</svg>\n")


if __name__ == "__main__":
    main()
