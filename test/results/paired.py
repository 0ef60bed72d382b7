#!/usr/bin/env python3
"""Compares two versions of a table of drives, pair by pair of the same scenario, level and seed.

Usage: test/results/paired.py COMMIT_A COMMIT_B TABLE    e.g. 7fdcfb3 e1a4af9 seed.md

Prints B - A of driven / planned length of the pairs that both reached the goal, and of the hazard stops per 100 m of all
pairs: mean and its 95 % bootstrap interval (10,000 samples, seeded).
"""
import random
import re
import statistics
import subprocess
import sys


def drives(commit, name):
    """(scenario, level, seed) -> (reached, ratio, stops per 100 m)."""
    text = subprocess.run(["git", "show", f"{commit}:test/results/{name}"], check=True, capture_output=True,
                          text=True).stdout
    columns, found = None, {}
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if "seed" in cells and "outcome" in cells:
            columns = cells
        elif columns and len(cells) == len(columns) and cells[columns.index("seed")].isdigit():
            row = dict(zip(columns, cells))
            if "driven / planned [m]" in row:
                driven, planned = (float(v) for v in row["driven / planned [m]"].split(" / "))
            else:
                driven, planned = float(row["driven [m]"]), float(row["planned [m]"])
            key = (row.get("scenario", "default"), row.get("level", ""), int(row["seed"]))
            stops = float(re.match(r"\d+", row["hazard stops"]).group())
            found[key] = (row["outcome"] == "goal_reached", driven / planned, 100.0 * stops / max(driven, 1.0))
        else:
            columns = columns if line.startswith("|") else None
    return found


def difference(pairs):
    """Mean of B - A with its interval."""
    values = [b - a for a, b in pairs]
    if not values:
        return "-"
    source = random.Random(1)
    means = sorted(sum(source.choices(values, k=len(values))) / len(values) for _ in range(10000))
    return f"{sum(values) / len(values):+.3f} ({means[250]:+.3f} to {means[9749]:+.3f})"


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__.split("\n\n")[1])
    commit_a, commit_b, name = sys.argv[1:]
    a, b = drives(commit_a, name), drives(commit_b, name)
    print(f"`test/results/paired.py {commit_a} {commit_b} {name}`\n")
    print("| drives | pairs | goals A, B | median ratio A, B | ratio, B - A | hazard stops per 100 m, B - A |")
    print("|---|---|---|---|---|---|")
    for group in sorted({key[:2] for key in a.keys() & b.keys()}):
        keys = [key for key in sorted(a.keys() & b.keys()) if key[:2] == group]
        both = [key for key in keys if a[key][0] and b[key][0]]
        medians = [f"{statistics.median(t[k][1] for k in both):.3f}" if both else "-" for t in (a, b)]
        print(f"| {' '.join(group).strip()} | {len(keys)} | {sum(a[k][0] for k in keys)}, {sum(b[k][0] for k in keys)} "
              f"| {', '.join(medians)} | {difference([(a[k][1], b[k][1]) for k in both])} "
              f"| {difference([(a[k][2], b[k][2]) for k in keys])} |")


if __name__ == "__main__":
    main()
