#!/usr/bin/python3
"""What elastic structures cost over rigid ones, and what their reduction changes.

    tests/benchmarks/elastic_over_rigid.py TRACKBED SCENE.prm [--set 'Section/Key=value']...

Packs the scene once. Then each kind of structures (all elements, the sleeper by modes, the subgrade condensed
besides) runs what follows the packing on that bed, beside the rigid one, a thread each at the same time: a machine whose
speed drifts slows both. Prints processor times over the rigid run's, and what the first load cycle gives: later ones part
by chaos.
"""
import argparse
import csv
import os
import subprocess
import tempfile

RIGID = ["Sleeper/Model=rigid", "Subgrade/Model=rigid"]
VARIANTS = {"all elements": ["Sleeper/Model=elastic", "Sleeper/Reduction=none", "Subgrade/Reduction=none"],
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
    parser.add_argument("--set", action="append", default=[])
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        def start(command, output, settings, threads):
            words = [f"--set={s}" for s in [*args.set, f"Packing/Folder={folder}/packings", *settings]]
            return subprocess.Popen([args.trackbed, command, args.scene, "--threads", str(threads), "--overwrite",
                                     "--output", f"{folder}/{output}", *words], stdout=subprocess.DEVNULL,
                                    stderr=subprocess.DEVNULL, env={**os.environ, "OMP_WAIT_POLICY": "passive"})

        def processor_time(process):
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            if process.returncode != 0:
                raise SystemExit(f"{' '.join(process.args)}: exit code {process.returncode}")
            return used.ru_utime + used.ru_stime

        packing = processor_time(start("pack", "packed", [], 2))
        print(f"packing: {packing:.0f} s of processor time\n")
        print("| structures | processor time s | over rigid | with the packing | u_max mm | settlement mm "
              "| loading, unloading kN/mm | largest, least moment N m | steps |")
        print("|---|---|---|---|---|---|---|---|---|")

        def line(output, times, rigid):
            cycle = {k: float(v) for k, v in rows(f"{folder}/{output}/cycles.csv")[0].items()}
            moment = [float(r["moment_Nm"]) for r in rows(f"{folder}/{output}/moment.csv")]
            steps = next(r for r in csv.reader(open(f"{folder}/{output}/summary.csv")) if r[0] == "steps")[1]
            print(f"| {output.replace('_', ' ')} | {times:.1f} | {times / rigid:.2f} "
                  f"| {(packing + times) / (packing + rigid):.2f} "
                  f"| {1e3 * cycle['u_max_m']:.4f} | {1e3 * cycle['settlement_m']:.4f} "
                  f"| {1e-6 * cycle['stiffness_loading_N_per_m']:.3f}, {1e-6 * cycle['stiffness_unloading_N_per_m']:.3f} "
                  f"| {max(moment):.1f}, {min(moment):.1f} | {steps} |", flush=True)

        for name, settings in VARIANTS.items():
            output = name.replace(" ", "_")
            beside = start("run", "rigid", RIGID, 1)
            times = processor_time(start("run", output, settings, 1))
            rigid = processor_time(beside)
            line(output, times, rigid)
        line("rigid", rigid, rigid)


if __name__ == "__main__":
    main()
