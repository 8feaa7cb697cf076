"""What several grain steps per exchange cost in accuracy: subcycling.py TRACKBED FOLDER runs a small scene with 1 to 100
grain steps per exchange and writes FOLDER/subcycling.csv (runs stay in FOLDER/runs)."""
import csv
import pathlib
import re
import subprocess
import sys

SCENE = pathlib.Path(__file__).resolve().parents[3] / "tests" / "scenes" / "tiny.prm"
STEPS = 1, 2, 5, 10, 20, 30, 50, 100
# A short ramp and two quick cycles; grain steps a twentieth of the limit, so that many fit into one exchange.
CHANGES = {"Numerics/Margin": 0.05, "Loading/Ramp time": 0.002, "Loading/Frequency": 250, "Loading/Cycles": 2}


def rows(file):
    with open(file, newline="") as text:
        return list(csv.DictReader(text))


def run(program, folder, steps):
    """Steps per exchange, settlement after the last cycle, largest closure and gain, verdict."""
    changes = {**CHANGES, "Packing/Folder": folder / "packings", "Numerics/Exchange": "several_steps",
               "Numerics/Grain steps per exchange": steps}
    output = folder / f"steps_{steps}"
    words = [word for path, value in changes.items() for word in ("--set", f"{path}={value}")]
    done = subprocess.run([program, "run", SCENE, "--output", output, "--overwrite", *words], text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    result = {"grain_steps": steps}
    if done.returncode:
        would_do = re.search(r"(\d+) would do", done.stderr)
        verdict = f"refused, {would_do[1]} would do" if would_do else done.stderr.strip()
        return {**result, "verdict": verdict}
    summary = {row["quantity"]: float(row["value"]) for row in rows(output / "summary.csv")}
    return {**result, "settlement_m": float(rows(output / "cycles.csv")[-1]["settlement_m"]),
            "closure": summary["closure"], "exchange_gain": summary["exchange gain"], "verdict": "runs"}


def main(program, folder):
    folder = pathlib.Path(folder).resolve()
    results = [run(program, folder / "runs", steps) for steps in STEPS]
    reference = results[0]["settlement_m"]
    for result in results:
        if "settlement_m" in result:
            result["difference"] = result["settlement_m"] / reference - 1
    names = "grain_steps", "settlement_m", "difference", "closure", "exchange_gain", "verdict"
    with open(folder / "subcycling.csv", "w", newline="") as text:
        table = csv.DictWriter(text, names)
        table.writeheader()
        table.writerows(results)
    for result in results:
        print(*(f"{result[name]:.4g}" if isinstance(result.get(name), float) else result.get(name, "-")
                for name in names), sep=" | ")


if __name__ == "__main__":
    main(*sys.argv[1:])
