#!/usr/bin/env python3
"""Cost of the settled bed of a scene: bed.py TRACKBED SCENE [--set ...]

Packs the scene once, then runs the same packing rigid and elastic, on one thread and on two, in turn so that a machine
whose speed drifts treats all alike. Prints a table: time per step, per touching pair and per grain, the ratio elastic to
rigid, the gain of the second thread, memory per grain. Times are wall-clock times of the step itself (timing.csv), not
of output and set-up.
"""
import argparse
import csv
import os
import resource
import subprocess
import sys
import tempfile


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def run(trackbed, scene, folder, options):
    """Runs a scene; returns (seconds a step by part, steps, touching pairs, grains, unknowns, peak memory in bytes)."""
    command = [trackbed, *options[:1], scene, "--output", folder, "--overwrite", *options[1:]]
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    memory = 1024 * max(before, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
    parts = {row["stage"]: (int(row["calls"]), float(row["seconds"])) for row in rows(f"{folder}/timing.csv")}
    steps = max(calls for calls, _ in parts.values())
    seconds = {name: s / steps for name, (calls, s) in parts.items() if calls == steps}
    history = [row for row in rows(f"{folder}/history.csv") if row["stage"] in ("seating", "loading")]
    pairs = sum(int(row["contacts"]) for row in history) / max(1, len(history))
    summary = {row["quantity"]: row["value"] for row in rows(f"{folder}/summary.csv")}
    unknowns = sum(int(value) for name, value in summary.items() if name.startswith("unknowns"))
    return seconds, steps, pairs, int(summary["grains"]), unknowns, memory


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("trackbed")
    parser.add_argument("scene")
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--repeats", type=int, default=1)
    arguments = parser.parse_args()
    settings = [word for item in arguments.set for word in ("--set", item)]
    # One quick load cycle is enough to time steps.
    short = ["--set", "Loading/Ramp time=0.01", "--set", "Loading/Frequency=50", "--set", "Loading/Cycles=1",
             "--set", "Output/Snapshot interval=0"]
    rigid = ["--set", "Sleeper/Model=rigid", "--set", "Subgrade/Model=rigid"]
    with tempfile.TemporaryDirectory() as folder:
        # Makes the packing if it is not kept yet; warms up.
        run(arguments.trackbed, arguments.scene, f"{folder}/first", ["run", *settings, *short, *rigid])
        results = {}
        for repeat in range(arguments.repeats):
            for name, more in (("rigid", rigid), ("elastic", [])):
                for threads in (1, 2):
                    options = ["run", *settings, *short, *more, "--threads", str(threads)]
                    got = run(arguments.trackbed, arguments.scene, f"{folder}/{name}{threads}", options)
                    best = results.get((name, threads))
                    if best is None or sum(got[0].values()) < sum(best[0].values()):
                        results[name, threads] = got
    print("| structures | threads | ms per step | us per touching pair and step | us per grain and step | unknowns |")
    print("|---|---|---|---|---|---|")
    for (name, threads), (seconds, steps, pairs, grains, unknowns, memory) in results.items():
        total = sum(seconds.values())
        print(f"| {name} | {threads} | {1e3 * total:.3f} | {1e6 * total / pairs:.2f} | {1e6 * total / grains:.2f} "
              f"| {unknowns} |")
    one = {key: sum(value[0].values()) for key, value in results.items()}
    print(f"\nelastic over rigid, one thread: {one['elastic', 1] / one['rigid', 1]:.3f}, "
          f"two threads: {one['elastic', 2] / one['rigid', 2]:.3f}")
    for name in ("rigid", "elastic"):
        print(f"two threads over one, {name}: {one[name, 1] / one[name, 2]:.2f} times as fast")
    seconds, _, pairs, grains, _, memory = results["elastic", 1]
    print("shares of a step, elastic, one thread: " +
          ", ".join(f"{part} {100 * s / sum(seconds.values()):.0f} %" for part, s in seconds.items()))
    print(f"grains {grains}, touching pairs {pairs:.0f}, peak memory of the largest process {memory / 1e6:.0f} MB "
          f"({memory / grains / 1e3:.0f} kB a grain, libraries included)")


if __name__ == "__main__":
    sys.exit(main())
