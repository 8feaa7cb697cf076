#!/usr/bin/python3
"""What elastic structures cost over rigid ones, and what their reduction changes.

    tests/benchmarks/elastic_over_rigid.py TRACKBED SCENE.prm [--threads 2] [--set 'Section/Key=value']...

Packs the scene once, then runs its stages after the packing on that bed: rigid, all elements, the sleeper
by modes, the subgrade condensed besides. Prints times (of what follows the packing) over the rigid run's, and
what the run with all elements has against the reduced ones, in the first load cycle: later ones part by chaos.
"""
import argparse
import csv
import os
import resource
import subprocess
import tempfile
import time

VARIANTS = {"rigid": ["Sleeper/Model=rigid", "Subgrade/Model=rigid"],
            "all elements": ["Sleeper/Model=elastic", "Sleeper/Reduction=none", "Subgrade/Reduction=none"],
            "modal sleeper": ["Sleeper/Model=elastic", "Sleeper/Reduction=modal", "Subgrade/Reduction=none"],
            "and condensed subgrade": ["Sleeper/Model=elastic", "Sleeper/Reduction=modal",
                                       "Subgrade/Reduction=condensed"]}


def rows(file):
    with open(file) as lines:
        return list(csv.DictReader(lines))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("trackbed")
    parser.add_argument("scene")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--set", action="append", default=[])
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        def run(command, output, settings):
            words = [f"--set={s}" for s in [*args.set, f"Packing/Folder={folder}/packings", *settings]]
            before, wall = resource.getrusage(resource.RUSAGE_CHILDREN), time.time()
            subprocess.run([args.trackbed, command, args.scene, "--threads", str(args.threads),
                            "--output", f"{folder}/{output}", *words], check=True, stdout=subprocess.DEVNULL,
                           stderr=subprocess.DEVNULL, env={**os.environ, "OMP_WAIT_POLICY": "passive"})
            used = resource.getrusage(resource.RUSAGE_CHILDREN)
            return time.time() - wall, used.ru_utime - before.ru_utime

        packing = run("pack", "packed", [])[0]
        print(f"packing: {packing:.0f} s\n")
        print("| structures | wall s | over rigid | processor time over rigid | with the packing | u_max mm | "
              "settlement mm | loading, unloading kN/mm | largest, least moment N m | steps |")
        print("|---|---|---|---|---|---|---|---|---|---|")
        first = None
        for name, settings in VARIANTS.items():
            output = name.replace(" ", "_")
            wall, used = run("run", output, settings)
            first = first or (wall, used)
            cycle = {k: float(v) for k, v in rows(f"{folder}/{output}/cycles.csv")[0].items()}
            moment = [float(r["moment_Nm"]) for r in rows(f"{folder}/{output}/moment.csv")]
            steps = next(r for r in csv.reader(open(f"{folder}/{output}/summary.csv")) if r[0] == "steps")[1]
            print(f"| {name} | {wall:.1f} | {wall / first[0]:.2f} | {used / first[1]:.2f} "
                  f"| {(packing + wall) / (packing + first[0]):.2f} "
                  f"| {1e3 * cycle['u_max_m']:.4f} | {1e3 * cycle['settlement_m']:.4f} "
                  f"| {1e-6 * cycle['stiffness_loading_N_per_m']:.3f}, {1e-6 * cycle['stiffness_unloading_N_per_m']:.3f} "
                  f"| {max(moment):.1f}, {min(moment):.1f} | {steps} |", flush=True)


if __name__ == "__main__":
    main()
