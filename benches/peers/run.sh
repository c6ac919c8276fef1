#!/usr/bin/env bash
# Auxetica's step beside those of PyElastica 1.0.0 and HSA-PyElastica 0.0.1, in one run on this machine: the same
# elements, time step, forces and damping, and the end states compared. Prints a markdown table of medians.
# Needs Python 3.10 to 3.12 (PYTHON names another than python3) and the Python package index for the first run.
set -euo pipefail
cd "$(dirname "$0")/../.."
here=benches/peers
target=$(cargo metadata --format-version 1 --no-deps | sed 's/.*"target_directory":"\([^"]*\)".*/\1/')
peers=$target/peers
mkdir -p "$peers"

# A virtual environment counts once all of it is installed.
environment() {
    [ -e "$peers/$1/whole" ] || { "${PYTHON:-python3}" -m venv --clear "$peers/$1" && install_"$1" && touch "$peers/$1/whole"; }
}
install_pyelastica() {
    "$peers/pyelastica/bin/pip" install --quiet pyelastica==1.0.0
}
# Its metadata ask for a Python that has passed away and for dependencies that the simulator doesn't use.
install_hsa() {
    "$peers/hsa/bin/pip" install --quiet numpy==1.26.4 numba==0.60.0 scipy==1.13.1 tqdm PyYAML
    "$peers/hsa/bin/pip" install --quiet --ignore-requires-python --no-deps pyelastica==0.3.0 hsa-pyelastica==0.0.1
}

echo "installing the peers and building Auxetica" >&2
environment pyelastica
environment hsa
cargo bench --quiet --bench peers --no-run
echo "measuring" >&2
cargo bench --quiet --bench peers >"$peers/auxetica.jsonl"
"$peers/pyelastica/bin/python" $here/rods.py $here/cases.csv >"$peers/pyelastica.jsonl"
"$peers/hsa/bin/python" $here/hsa.py >"$peers/hsa.jsonl"
"$peers/pyelastica/bin/python" $here/table.py "$peers"/{auxetica,pyelastica,hsa}.jsonl
