#!/usr/bin/python3
"""Other codes on the same settled boxes, where Debian's packages `yade` and `liggghts` are installed.

    tests/benchmarks/peers.py SHAPES_BENCHMARK [--grains 1000] [--threads 1] [--rounds 3]

SHAPES_BENCHMARK is the built program of that name. It settles a box of each shape, times Trackbed on
it and leaves the grains in a file; YADE (polyhedra, clumps, spheres) and LIGGGHTS (spheres) are given
those grains where they lie, are let come to rest under their own laws, and are timed: processor time
per step, everything included. LIGGGHTS takes clumps as templates only, so its multispheres, the same
clump as often, fall and settle anew in the same box.
Prints one table; the ratio is the peer's time per grain and step over Trackbed's in this run (the
boxes are the same, but LIGGGHTS does not count contacts with walls).
"""
import argparse
import csv
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
YOUNG, POISSON, FRICTION, RESTITUTION = 2e7, 0.25, 0.5, 0.3


def read_bed(file):
    """(box, [[(radius, [corner, ...]), ...] per grain])"""
    words = iter(file.read_text().split())
    box, grains = None, []
    for word in words:
        if word == "box":
            box = [float(next(words)) for _ in range(3)]
        elif word == "grain":
            next(words)  # density
            parts = []
            for _ in range(int(next(words))):
                assert next(words) == "part"
                radius, corners = float(next(words)), int(next(words))
                parts.append((radius, [[float(next(words)) for _ in range(3)] for _ in range(corners)]))
            grains.append(parts)
    return box, grains


def yade(bed, steps, threads):
    """Seconds per step, touching pairs; None if it failed."""
    command = ["yade", f"-j{threads}", "-n", "-x", str(HERE / "peer_yade.py"), str(bed), str(steps)]
    out = subprocess.run(command, capture_output=True, text=True, env={**os.environ, "PYTHONPATH": str(HERE)})
    found = re.search(r"RESULT (\S+) (\S+)", out.stdout)
    if not found:
        print(f"yade on {bed.name} ended with exit code {out.returncode}: "
              f"{(out.stderr or out.stdout).strip().splitlines()[-1:]}", file=sys.stderr)
        return None
    return float(found[1]), float(found[2])


def liggghts_input(bed, steps, dt, multisphere, folder):
    box, grains = read_bed(bed)
    spheres = [(parts[0][0], parts[0][1][0]) for parts in grains]
    kinds = sorted({radius for radius, _ in spheres}) if not multisphere else []
    lines = [
        "atom_style granular", "atom_modify map array", "boundary f f f", "newton off", "communicate single vel yes",
        "units si", "hard_particles yes" if multisphere else "",
        f"region box block {-.01} {box[0] + .01} {-.01} {box[1] + .01} {-.01} {box[2] + .3} units box",
        "create_box 1 box", f"neighbor {.1 * .045} bin", "neigh_modify delay 0",
        f"fix m1 all property/global youngsModulus peratomtype {YOUNG}",
        f"fix m2 all property/global poissonsRatio peratomtype {POISSON}",
        f"fix m3 all property/global coefficientRestitution peratomtypepair 1 {RESTITUTION}",
        f"fix m4 all property/global coefficientFriction peratomtypepair 1 {FRICTION}",
        "pair_style gran model hertz tangential history", "pair_coeff * *", f"timestep {dt}",
        "fix gravi all gravity 9.81 vector 0.0 0.0 -1.0",
    ]
    planes = [("xplane", 0.0), ("xplane", box[0]), ("yplane", 0.0), ("yplane", box[1]), ("zplane", 0.0)]
    for k, (axis, at) in enumerate(planes):
        lines.append(f"fix wall{k} all wall/gran model hertz tangential history primitive type 1 {axis} {at}")
    if multisphere:
        clump = grains[0]
        centre = [sum(c[1][0][d] for c in clump) / len(clump) for d in range(3)]
        (folder / "clump.txt").write_text("".join(
            " ".join(str(c[1][0][d] - centre[d]) for d in range(3)) + f" {c[0]}\n" for c in clump))
        lines += [
            "fix clump all particletemplate/multisphere 15485863 atom_type 1 density constant 2600 "
            f"nspheres {len(clump)} ntry 100000 spheres file clump.txt scale 1.0 type 1",
            "fix mix all particledistribution/discrete 32452843 1 clump 1.0",
            f"region fill block 0.005 {box[0] - .005} 0.005 {box[1] - .005} 0.005 {box[2] + .28} units box",
            "fix inserted all insert/pack seed 49979687 distributiontemplate mix insert_every once overlapcheck yes "
            f"all_in yes particles_in_region {len(grains)} region fill",
            "fix move all multisphere",
        ]
        settle = int(1.0 / dt)
    else:
        lines += [f"create_atoms 1 single {c[0]:.12g} {c[1]:.12g} {c[2]:.12g} units box" for _, c in spheres]
        assert len(kinds) == 1
        lines += [f"set group all density 2600 diameter {2 * kinds[0]}", "fix move all nve/sphere"]
        settle = int(0.2 / dt)
    lines += [
        "compute touch all contact/atom", "compute pairs all reduce sum c_touch",
        "compute_modify thermo_temp dynamic yes",
        "thermo_style custom step atoms ke c_pairs", f"thermo {max(1, settle // 4)}", "thermo_modify lost warn norm no",
        f"run {settle}", f"thermo {steps}", f"run {steps}",
    ]
    return "\n".join(lines) + "\n"


def run_liggghts(bed, steps, dt, threads, multisphere):
    """Wall time of the steps [s], processor time of the whole run [s], touching pairs; None if it failed."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "in.txt").write_text(liggghts_input(bed, steps, dt, multisphere, folder))
        command = ["liggghts", "-in", "in.txt"]
        if threads > 1:
            command = ["mpirun", "--oversubscribe", "-n", str(threads)] + command
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        out = subprocess.run(command, cwd=folder, capture_output=True, text=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        loops = re.findall(r"Loop time of (\S+) on", out.stdout)
        rows = re.findall(r"^\s*\d+\s+\d+\s+\S+\s+(\S+)\s*$", out.stdout, re.M)
        if out.returncode or len(loops) < 2 or not rows or float(rows[-1]) <= 0:
            print(f"liggghts on {bed.name} ended with exit code {out.returncode}: "
                  f"{(out.stderr + out.stdout).strip().splitlines()[-1:]}", file=sys.stderr)
            return None
        processor = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        return float(loops[-1]), processor, float(rows[-1]) / 2  # each pair is seen from both sides


def least(times):
    """Of (seconds, touching pairs) the one of least time; None if one failed."""
    return None if None in times else min(times)


def liggghts(bed, steps, dt, threads, multisphere, rounds):
    """Seconds per step, touching pairs. LIGGGHTS tells wall time, which other work on the machine adds to: on one
    thread, processor time of more steps less that of few, each the least of some rounds."""
    def run(many):
        answer = run_liggghts(bed, many, dt, threads, multisphere)
        return answer and (answer[0 if threads > 1 else 1], answer[2])

    few = least([run(steps) for _ in range(rounds)])
    if few is None or threads > 1:
        return few and (few[0] / steps, few[1])
    many = least([run(11 * steps) for _ in range(rounds)])
    return many and ((many[0] - few[0]) / (10 * steps), many[1])


def trackbed(args, shape, folder):
    """Seconds per touching pair, touching pairs, time step [s]."""
    answers = []
    for _ in range(args.rounds):
        subprocess.run([args.benchmark, str(args.grains), str(args.steps), str(folder), shape, str(args.threads)],
                       check=True, stdout=sys.stderr)
        with open(folder / "shapes.csv") as file:
            answers += [(float(row["seconds_per_touching_pair"]), int(row["touching_pairs"]), float(row["time_step_s"]))
                        for row in csv.DictReader(file) if int(row["threads"]) == args.threads]
    return min(answers)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("benchmark")
    parser.add_argument("--grains", type=int, default=1000)
    parser.add_argument("--steps", type=int, default=1000)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--only", default="", help="one shape")
    parser.add_argument("--rounds", type=int, default=3, help="of which the least time of each code counts")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        slow = max(20, args.steps // 50)  # steps of YADE's polyhedra

        def with_yade(bed, steps):
            return least([yade(bed, steps, args.threads) for _ in range(args.rounds)])

        def with_liggghts(bed, dt, multisphere):
            return liggghts(bed, args.steps, dt, args.threads, multisphere, args.rounds)

        runs = {"polyhedra": [("YADE", lambda bed, dt: with_yade(bed, slow))],
                "clumps of 8": [("YADE", lambda bed, dt: with_yade(bed, args.steps)),
                                ("LIGGGHTS", lambda bed, dt: with_liggghts(bed, dt, True))],
                "spheres": [("YADE", lambda bed, dt: with_yade(bed, args.steps)),
                            ("LIGGGHTS", lambda bed, dt: with_liggghts(bed, dt, False))]}
        print("| shape | code | touching pairs | us per touching pair | us per grain | Trackbed's pairs | us | us | ratio |")
        print("|---|---|---|---|---|---|---|---|---|")
        for shape, codes in runs.items():
            if args.only not in ("", shape):
                continue
            mine, pairs, dt = trackbed(args, shape, folder)
            for code, run in codes:
                if not shutil.which(code.lower()):
                    print(f"| {shape} | {code} | not installed | | | | | | |")
                    continue
                answer = run(folder / f"{shape}.txt", dt)
                if answer is None:
                    print(f"| {shape} | {code} | failed | | | | | | |")
                    continue
                step, touching = answer
                print(f"| {shape} | {code} | {touching:.0f} | {1e6 * step / touching:.3g} "
                      f"| {1e6 * step / args.grains:.3g} | {pairs} | {1e6 * mine:.3g} "
                      f"| {1e6 * mine * pairs / args.grains:.3g} | {step / (mine * pairs):.3g} |", flush=True)


if __name__ == "__main__":
    main()
