#!/usr/bin/python3
"""Who may include whom: dem and fem know nothing of each other nor of what stands above them, HDF5
stays in coupling and apps, deal.II out of dem and base. Prints each offence, exit 1 if any."""
import pathlib
import re
import sys

FORBIDDEN = {
    "base": r"(dem|fem|coupling|apps)/|deal\.II/|hdf5|H5|CGAL/|Eigen/",
    "dem": r"(fem|coupling|apps)/|deal\.II/|hdf5|H5|petsc|mpi\.h",
    "fem": r"(dem|coupling|apps)/|hdf5|H5|CGAL/",
    "coupling": r"apps/",
}
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')


def offences(root):
    for folder, pattern in FORBIDDEN.items():
        for file in sorted((root / folder).rglob("*")):
            if file.suffix not in {".h", ".cc", ".hpp", ".cpp", ".inl"}:
                continue
            for number, line in enumerate(file.read_text().splitlines(), 1):
                include = INCLUDE.match(line)
                if include and re.match(pattern, include.group(1)):
                    yield f"{file.relative_to(root)}:{number}: {folder} must not include {include.group(1)}"


def main():
    found = list(offences(pathlib.Path(sys.argv[1])))
    print("\n".join(found) if found else "no forbidden include")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
