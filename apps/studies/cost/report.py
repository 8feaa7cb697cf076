"""The table of README.md from DIR/cost.csv: report.py DIR. What is told from the scatter of the packings, the largest
first, and what is lost in it."""
import csv
import sys


def main(folder):
    with open(f"{folder}/cost.csv", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["verdict"]]
    told = [row for row in rows if row["verdict"] == "error" and row["quantity"] != "energy_drift"]
    told.sort(key=lambda row: -abs(float(row["error_percent"])))
    print("| knob | setting | time over the scene's own | quantity | error |\n|---|---|---|---|---|")
    for row in told:
        print(f"| {row['knob']} | {row['value']} | {float(row['time_over_own']):.2f} | {row['quantity']} "
              f"| {float(row['error_percent']):.3g} ± {float(row['error_ci95_percent']):.2g} % |")
    lost = sorted({row["knob"] for row in rows} - {row["knob"] for row in told} - {"own", "repeat"})
    print("\nLost in the scatter, below the noise floor or equal in every quantity: " + ", ".join(lost) + ".")


if __name__ == "__main__":
    main(sys.argv[1])
