#!/usr/bin/python3
"""Times the jobs of bench/bootstrap_benchmark.cpp in numpy, scipy and statsmodels beside the project's own, one thread,
16,000 rows of 13 regressors, and prints the ratios as a table in Markdown.

Usage: bench/compare_bootstrap.py [--built DIR]

Needs Debian's python3-numpy, python3-scipy and python3-statsmodels, and telltale_bench built in build/release unless
--built names another build folder. Exits 77 where one of them is missing. The jobs of statsmodels are timed for some
replicates only and scaled up to 1000, which the table says.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import time

for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "BLIS_NUM_THREADS"):
    os.environ[threads] = "1"  # read when numpy loads its BLAS

SKIPPED = 77
ROWS, COLUMNS, REPLICATES, LENGTH = 16000, 13, 1000, 50


def skip(reason):
    print(f"compare_bootstrap: skipped, {reason}", file=sys.stderr)
    sys.exit(SKIPPED)


try:
    import numpy as np
    import scipy
    import scipy.linalg
    import scipy.signal
    import statsmodels
    import statsmodels.api as sm
except ImportError as missing:
    skip(f"{missing}; on Debian: apt-get install python3-numpy python3-scipy python3-statsmodels")


def coloured(rng, memory):
    return scipy.signal.lfilter([1.0], [1.0, -memory], rng.standard_normal(ROWS))


rng = np.random.default_rng(1)
X = np.column_stack([coloured(rng, 0.9) for _ in range(COLUMNS)])
y = X.sum(axis=1) + coloured(rng, 0.5)
theta = np.linalg.lstsq(X, y, rcond=None)[0]
e = y - X @ theta


def edges(slices):
    return np.arange(slices + 1) * ROWS // slices


def covariance_by_lstsq(solve):
    def job():
        estimate = solve(X, y)[0]
        residual = y - X @ estimate
        return residual @ residual / (ROWS - COLUMNS) * np.linalg.inv(X.T @ X)

    return job


def rows_of_segments(slices, draw):
    first = edges(slices)
    drawn = draw.integers(0, slices, slices)
    return np.concatenate([np.arange(first[s], first[s + 1]) for s in drawn])


def rows_of_blocks(draw):
    starts = draw.integers(0, ROWS, ROWS // LENGTH)
    return ((starts[:, None] + np.arange(LENGTH)) % ROWS).ravel()


def refits(rows, solve, replicates=REPLICATES):
    """Every replicate gathers the rows it drew and fits them."""

    def job():
        draw = np.random.default_rng(2)
        return np.array([solve(*(lambda i: (X[i], y[i]))(rows(draw))) for _ in range(replicates)])

    return job


def normal_equations(A, b):
    return np.linalg.solve(A.T @ A, A.T @ b)


def grams_of_segments(slices):
    """Gram matrices once, then one product with the multiplicities and one batched solve."""

    def job():
        first = edges(slices)
        grams = np.array([X[a:b].T @ X[a:b] for a, b in zip(first, first[1:])]).reshape(slices, -1)
        scores = np.array([X[a:b].T @ e[a:b] for a, b in zip(first, first[1:])])
        draw = np.random.default_rng(2)
        times = draw.multinomial(slices, np.full(slices, 1.0 / slices), REPLICATES).astype(float)
        A = (times @ grams).reshape(REPLICATES, COLUMNS, COLUMNS)
        return theta + np.linalg.solve(A, (times @ scores)[:, :, None])[:, :, 0]

    return job


def prefix_sums_of_blocks():
    """Prefix sums of the rows' products once, then differences gathered for the blocks drawn."""
    upper = np.triu_indices(COLUMNS)
    products = np.hstack([X[:, upper[0]] * X[:, upper[1]], X * e[:, None]])
    wrapped = np.vstack([products, products[:LENGTH]])
    prefix = np.vstack([np.zeros(products.shape[1]), np.cumsum(wrapped, axis=0)])
    draw = np.random.default_rng(2)
    sums = np.empty((REPLICATES, products.shape[1]))
    for i in range(REPLICATES):
        starts = draw.integers(0, ROWS, ROWS // LENGTH)
        sums[i] = (prefix[starts + LENGTH] - prefix[starts]).sum(axis=0)
    A = np.empty((REPLICATES, COLUMNS, COLUMNS))
    A[:, upper[0], upper[1]] = A[:, upper[1], upper[0]] = sums[:, : len(upper[0])]
    return theta + np.linalg.solve(A, sums[:, len(upper[0]) :, None])[:, :, 0]


def milliseconds(job, repetitions):
    times = []
    for _ in range(repetitions):
        start = time.perf_counter()
        job()
        times.append(1e3 * (time.perf_counter() - start))
    return sorted(times)[len(times) // 2]


def own_milliseconds(bench):
    """Median times of the project's benchmarks by name."""
    run = subprocess.run(
        [bench, "--benchmark_filter=^(LeastSquares|SliceReplicates/percentile|BlockReplicates/percentile)",
         "--benchmark_repetitions=7", "--benchmark_min_time=0.1", "--benchmark_format=json"],
        check=True, capture_output=True, text=True)
    return {b["run_name"]: b["real_time"] for b in json.loads(run.stdout)["benchmarks"]
            if b.get("aggregate_name") == "median"}


def blas_in_use():
    with open("/proc/self/maps") as maps:
        paths = {line.split()[-1] for line in maps if "blas" in line.lower() and "/" in line}
    return ", ".join(sorted(os.path.basename(p) for p in paths if "numpy" not in p and "scipy" not in p)) or "its own"


def short(number):
    return f"{number:.0f}" if number >= 100 else f"{number:.1f}" if number >= 10 else f"{number:.2f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    root = pathlib.Path(__file__).resolve().parent.parent
    parser.add_argument("--built", type=pathlib.Path, default=root / "build/release")
    bench = parser.parse_args().built / "bench/telltale_bench"
    if not bench.exists():
        skip(f"{bench} is not built; cmake --build --preset release --target telltale_bench")
    compare(bench)


def compare(bench):
    """Prints the table."""

    def loop_of_statsmodels(A, b):
        return sm.OLS(b, A).fit().params

    def lstsq(A, b):
        return np.linalg.lstsq(A, b, rcond=None)[0]

    least = "LeastSquaresWithCovariance"
    few, many = "SliceReplicates/percentile/slices:40", "SliceReplicates/percentile/slices:130"
    blocks = f"BlockReplicates/percentile/length:{LENGTH}"
    part = 50
    scaled = REPLICATES / part
    # What it is, the project's benchmark, the reference, its job, repetitions, and by how much its time is scaled up.
    jobs = [
        (least, "numpy lstsq", covariance_by_lstsq(lambda A, b: np.linalg.lstsq(A, b, rcond=None)), 9, 1),
        (least, "scipy lstsq", covariance_by_lstsq(scipy.linalg.lstsq), 9, 1),
        (least, "statsmodels OLS", lambda: sm.OLS(y, X).fit().cov_params(), 9, 1)]
    for name, slices in ((few, 40), (many, 130)):
        rows = lambda draw, slices=slices: rows_of_segments(slices, draw)
        jobs += [
            (name, "statsmodels OLS, refitted *", refits(rows, loop_of_statsmodels, part), 1, scaled),
            (name, "numpy lstsq, refitted *", refits(rows, lstsq, part), 1, scaled),
            (name, "numpy normal equations, refitted", refits(rows, normal_equations), 1, 1),
            (name, "numpy, Gram matrices of the slices", grams_of_segments(slices), 9, 1)]
    jobs += [
        (blocks, "statsmodels OLS, refitted *", refits(rows_of_blocks, loop_of_statsmodels, part), 1, scaled),
        (blocks, "numpy lstsq, refitted *", refits(rows_of_blocks, lstsq, part), 1, scaled),
        (blocks, "numpy normal equations, refitted", refits(rows_of_blocks, normal_equations), 1, 1),
        (blocks, "numpy, prefix sums of Gram matrices", prefix_sums_of_blocks, 3, 1)]

    own = own_milliseconds(bench)
    print(f"numpy {np.__version__}, scipy {scipy.__version__}, statsmodels {statsmodels.__version__}, "
          f"BLAS: {blas_in_use()}\n")
    print("| job | telltale, ms | with | ms | ratio |")
    print("|---|---|---|---|---|")
    for name, reference, job, repetitions, scale in jobs:
        theirs = scale * milliseconds(job, repetitions)
        print(f"| `{name}` | {short(own[name])} | {reference} | {short(theirs)} | {short(theirs / own[name])} |", flush=True)
    print(f"\n\\* timed for {part} replicates, scaled up to {REPLICATES}")


if __name__ == "__main__":
    main()
