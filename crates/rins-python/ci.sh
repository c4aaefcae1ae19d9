#!/usr/bin/env bash
# What CI does with the Python package: build it with pip in a new environment, test it, check its types, execute the notebooks.
#
# PYTHON is the interpreter (3.11 or later, with venv), PROFILE the profile of cargo: by default that of the tests.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
package=crates/rins-python
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

"${PYTHON:-python3}" -m venv "$folder/venv"
bin="$folder/venv/bin"
pip() { "$bin/python" -m pip --disable-pip-version-check --quiet "$@"; }

step() { echo "-- $1 (${SECONDS} s)"; }

# Features of dependencies are those of the packages that are built together: with those of the tests nothing is built twice. maturin
# runs `cargo rustc ... --manifest-path FILE --lib` of one package; this builds the same library with all others.
cat >"$folder/cargo" <<'EOF'
#!/usr/bin/env bash
[[ "${1:-}" == rustc ]] || exec cargo "$@"
shift
arguments=()
while (($#)); do
  if [[ "$1" == --manifest-path ]]; then shift; else arguments+=("$1"); fi
  shift
done
exec cargo build ${CARGO_SCOPE:---workspace --examples} "${arguments[@]}"
EOF
chmod +x "$folder/cargo"

step "pip install ."
CARGO="$folder/cargo" MATURIN_PEP517_ARGS="--profile ${PROFILE:-dev}" pip install ".[plot,progress,ros,mcap,px4,hdf5,dask]"
pip install -r "$package/tests/requirements.txt"

step "pytest"
"$bin/python" -m pytest "$package/tests"

step "mypy, stubtest, page of the book"
"$bin/python" "$package/api_page.py" --check
"$bin/python" -m mypy "$package/python/rins"
MYPYPATH="$package/tests" "$bin/python" -m mypy "$package/tests"
# Outside the sources, so that the installed package is compared.
(cd "$folder" && "$bin/python" -m mypy.stubtest rins --concise --mypy-config-file "$OLDPWD/pyproject.toml")

step "notebooks"
cp -r docs/notebooks "$folder/notebooks"
for notebook in "$folder"/notebooks/*.ipynb; do
  RINS_ROOT="$PWD" "$bin/python" -m nbconvert --log-level ERROR --to notebook --execute --inplace "$notebook"
  echo "   $(basename "$notebook") executed"
done
step "done"
