#!/usr/bin/python3
"""Times the project's estimators beside what numpy, scipy and statsmodels make of the same problems, one thread, and
prints the ratios as a table in Markdown; after it the table of bench/compare_bootstrap.py.

Usage: bench/compare_estimators.py [--built DIR] [--shooting-segments N] [--without-bootstrap]

Needs what compare_bootstrap.py needs and exits 77 where it is missing. Times are processor time, so that a machine that
is shared does not decide. The data are made up here, of the size, the structure and the noise of those that the
project's benchmarks make up: 80 segments of 40 s at 5 Hz, 35 coefficients. scipy shoots N of the 400 shooting segments (default 50),
and its time is scaled up to all of them, which the table says.

The rivals are what one would write with these libraries: arrays over all segments at once instead of loops.
- one-step: regressors of all three equations, least squares, covariance.
- weak form: test functions as one product, instruments simulated for all segments side by side, four rounds, covariance
  by clusters.
- output error: scipy.optimize.least_squares with the sparsity of the Jacobian, differences, and Huber's loss.
"""
import argparse
import json
import pathlib
import subprocess
import time

import compare_bootstrap  # first: it sets the threads of the BLAS
import numpy as np
import scipy
import scipy.optimize
import scipy.sparse
import statsmodels
import statsmodels.api as sm

SEGMENTS, SEGMENT_S, PERIOD_S = 80, 40.0, 0.2
ROWS = round(SEGMENT_S / PERIOD_S) + 1
SHOOTING_ROWS = 40
NOISE_M, NOISE_RAD = 0.02, np.deg2rad(0.3)
SIZES = (9, 13, 13)
BOAT = [np.array([-0.35, 0.9, 0.05, -0.25, 0.01, 0.45, 0.25, -0.3, 0.2]),
        np.array([-0.8, -0.2, 0.1, 0.05, -0.2, -0.6, -0.6, 0.05, 0.005, 0.02, 0.03, -0.02, 0.02]),
        np.array([0.05, 0.02, -0.1, -0.9, -0.15, -0.35, -0.1, -0.8, 0.005, 0.9, 0.5, -0.6, 0.4])]


def thrust(port, starboard):
    """The propeller regressors that surge adds up and those whose difference turns the boat."""
    ahead, astern = np.maximum, np.minimum
    terms = [(ahead(d, 0.0) ** 2, ahead(d, 0.0), astern(d, 0.0) ** 2, astern(d, 0.0)) for d in (port, starboard)]
    return np.stack([p + s for p, s in zip(*terms)], -1), np.stack([p - s for p, s in zip(*terms)], -1)


def regressors(nu, push):
    """One array per equation, columns last."""
    u, v, r = nu[..., 0], nu[..., 1], nu[..., 2]
    one = np.ones_like(u)
    surge = np.stack([u * abs(u), v * r, r * r, u, one], -1)
    turning = np.stack([v * abs(v), v * abs(r), r * abs(v), r * abs(r), u * v, u * r, v, r, one], -1)
    return [np.concatenate([surge, push[0]], -1), np.concatenate([turning, push[1]], -1),
            np.concatenate([turning, push[1]], -1)]


def acceleration(theta, nu, push):
    return np.stack([phi @ t for phi, t in zip(regressors(nu, push), theta)], -1)


def runge_kutta(derivative, state, step):
    a = derivative(state)
    b = derivative(state + 0.5 * step * a)
    c = derivative(state + 0.5 * step * b)
    return state + step / 6.0 * (a + 2.0 * b + 2.0 * c + derivative(state + step * c))


def pose_and_velocity(theta, push):
    def derivative(state):
        c, s = np.cos(state[..., 2]), np.sin(state[..., 2])
        u, v, r = state[..., 3], state[..., 4], state[..., 5]
        turned = np.stack([c * u - s * v, s * u + c * v, r], -1)
        return np.concatenate([turned, acceleration(theta, state[..., 3:], push)], -1)

    return derivative


def commands(rng):
    """Steps of 1.6 to 4 s, ahead and with either side astern: segments x rows x sides."""
    held = np.empty((SEGMENTS, ROWS, 2))
    for segment in held:
        row = 0
        while row < ROWS:
            length = rng.integers(8, 21)
            step = rng.uniform(0.1, 1.0, 2)
            side = rng.integers(0, 4)
            if side < 2:
                step[side] *= -0.7
            segment[row:row + length] = step
            row += length
    return held


def simulate_recording(rng):
    """True poses and velocities, and the propeller regressors of each row."""
    held = commands(rng)
    push = thrust(held[..., 0], held[..., 1])
    states = np.zeros((SEGMENTS, ROWS, 6))
    states[:, 0, 3] = 0.5
    for row in range(ROWS - 1):
        now = (push[0][:, row], push[1][:, row])
        state = states[:, row]
        for _ in range(10):
            state = runge_kutta(pose_and_velocity(BOAT, now), state, PERIOD_S / 10)
        states[:, row + 1] = state
    return states, push


rng = np.random.default_rng(1)
states, push = simulate_recording(rng)
nu = states[..., 3:] + rng.standard_normal((SEGMENTS, ROWS, 3)) * (0.02, 0.02, 0.01)


def one_step(solve):
    """Coefficients and standard errors of each equation, from rows."""
    rows = [phi[:, :-1].reshape(-1, phi.shape[-1]) for phi in regressors(nu, push)]
    changes = (np.diff(nu, axis=1) / PERIOD_S).reshape(-1, 3)
    return [solve(phi, changes[:, j]) for j, phi in enumerate(rows)]


def by_numpy(phi, y):
    theta, squares, _, singular = np.linalg.lstsq(phi, y, rcond=None)
    covariance = squares[0] / (len(y) - len(theta)) * np.linalg.inv(phi.T @ phi)
    return theta, covariance, singular[0] / singular[-1]


def by_statsmodels(phi, y):
    fit = sm.OLS(y, phi).fit()
    return fit.params, fit.cov_params(), fit.condition_number


def test_functions():
    """phi and -phi' of every window of a segment, as rows over its rows."""
    half = round(2.0 / PERIOD_S)
    t = np.arange(-half, half + 1) / half
    value = (1.0 - t * t) ** 6 * PERIOD_S
    slope = -12.0 * t * (1.0 - t * t) ** 5 / 2.0 * PERIOD_S
    starts = range(0, ROWS - 2 * half, round(1.0 / PERIOD_S))
    weights = np.zeros((2, len(starts), ROWS))
    for k, start in enumerate(starts):
        weights[0, k, start:start + 2 * half + 1] = value
        weights[1, k, start:start + 2 * half + 1] = -slope
    return weights


def simulated(theta, restart_rows=50):
    """Velocities that the model simulates, restarted from the measured ones every ten seconds."""
    out = np.empty_like(nu)
    for begin in range(0, ROWS, restart_rows):
        state = nu[:, begin]
        out[:, begin] = state
        for row in range(begin + 1, min(begin + restart_rows, ROWS)):
            now = (push[0][:, row - 1], push[1][:, row - 1])
            state = runge_kutta(lambda x: acceleration(theta, x, now), state, PERIOD_S)
            out[:, row] = state
    return out


def weak_form():
    """Coefficients by instruments and their covariance by clusters of 20 s."""
    value, slope = test_functions()
    project = lambda columns: np.einsum("kr,srp->skp", value, columns, optimize=True).reshape(-1, columns.shape[-1])
    held = [np.concatenate([p[:, :1], 0.5 * (p[:, 1:] + p[:, :-1])], axis=1) for p in push]  # changes between two rows
    G = [project(phi) for phi in regressors(nu, held)]
    b = np.einsum("kr,srj->skj", slope, nu, optimize=True).reshape(-1, 3)
    theta = [np.linalg.lstsq(g, b[:, j], rcond=None)[0] for j, g in enumerate(G)]
    for _ in range(4):
        Z = [project(phi) for phi in regressors(simulated(theta), held)]
        theta = [np.linalg.solve(z.T @ g, z.T @ b[:, j]) for j, (z, g) in enumerate(zip(Z, G))]
    covariance = []
    for j, (z, g) in enumerate(zip(Z, G)):
        scores = z * (b[:, j] - g @ theta[j])[:, None]
        clusters = scores.reshape(2 * SEGMENTS, -1, scores.shape[1]) if len(scores) % (2 * SEGMENTS) == 0 else (
            scores.reshape(SEGMENTS, -1, scores.shape[1]))
        sums = clusters.sum(axis=1)
        bread = np.linalg.inv(z.T @ g)
        covariance.append(bread @ (sums.T @ sums) @ bread.T * len(sums) / (len(sums) - 1))
    return theta, covariance


def shooting(shooting_segments):
    """scipy's own solver on `shooting_segments` shooting_segments of eight seconds, from the coefficients of the weak form."""
    cut = states[:, :-1].reshape(-1, SHOOTING_ROWS, 6)[:shooting_segments]
    fixes = cut[..., :2] + NOISE_M * rng.standard_normal(cut.shape[:2] + (2,))
    headings = cut[..., 2] + NOISE_RAD * rng.standard_normal(cut.shape[:2])
    shooting_thrust = [p[:, :-1].reshape(-1, SHOOTING_ROWS, 4)[:shooting_segments] for p in push]
    first = np.concatenate([cut[:, 0, :3], nu[:, :-1].reshape(-1, SHOOTING_ROWS, 3)[:shooting_segments, 0]], -1)
    begin = np.concatenate([np.concatenate(weak_form()[0]), first.ravel()])
    split = np.cumsum(SIZES)

    def residuals(unknowns):
        theta = np.split(unknowns[:split[-1]], split[:-1])
        state = unknowns[split[-1]:].reshape(shooting_segments, 6)
        residual = np.empty((shooting_segments, SHOOTING_ROWS, 3))
        for row in range(SHOOTING_ROWS):
            residual[:, row, :2] = (state[:, :2] - fixes[:, row]) / NOISE_M
            residual[:, row, 2] = (state[:, 2] - headings[:, row]) / NOISE_RAD
            now = (shooting_thrust[0][:, row], shooting_thrust[1][:, row])
            state = runge_kutta(pose_and_velocity(theta, now), state, PERIOD_S)
        return residual.ravel()

    own = scipy.sparse.kron(scipy.sparse.eye(shooting_segments), np.ones((3 * SHOOTING_ROWS, 6)))
    sparsity = scipy.sparse.hstack([np.ones((3 * SHOOTING_ROWS * shooting_segments, split[-1])), own]).tocsr()
    scale = np.concatenate([np.maximum(abs(np.concatenate(BOAT)), 0.05), np.tile([1.0, 1.0, 0.1, 1.0, 0.3, 0.5], shooting_segments)])

    def job():
        fit = scipy.optimize.least_squares(residuals, begin, jac_sparsity=sparsity, x_scale=scale, loss="huber", f_scale=3.0, max_nfev=40,
                                           ftol=1e-7)
        off = fit.x[:split[-1]] - np.concatenate(BOAT)
        print(f"scipy: {fit.message} {fit.nfev} sums, {fit.njev} Jacobians, largest error {abs(off).max():.3f}",
              file=compare_bootstrap.sys.stderr)
        return fit

    return job


def milliseconds(job, repetitions):
    times = []
    for _ in range(repetitions):
        start = time.process_time()
        job()
        times.append(1e3 * (time.process_time() - start))
    return sorted(times)[len(times) // 2]


def own_milliseconds(bench):
    """Median processor times of the project's benchmarks by name."""
    run = subprocess.run(
        [bench, "--benchmark_filter=^(IdentifyOneStep/with_covariance|WeakIv/all|OutputError/all)$", "--benchmark_repetitions=5",
         "--benchmark_min_time=0.2", "--benchmark_format=json"], check=True, capture_output=True, text=True)
    return {b["run_name"]: b["cpu_time"] for b in json.loads(run.stdout)["benchmarks"]
            if b.get("aggregate_name") == "median"}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    root = pathlib.Path(__file__).resolve().parent.parent
    parser.add_argument("--built", type=pathlib.Path, default=root / "build/release")
    parser.add_argument("--shooting-segments", type=int, default=50)
    parser.add_argument("--without-bootstrap", action="store_true")
    arguments = parser.parse_args()
    bench = arguments.built / "bench/telltale_bench"
    if not bench.exists():
        compare_bootstrap.skip(f"{bench} is not built; cmake --build --preset release --target telltale_bench")
    own = own_milliseconds(bench)
    scaled = SEGMENTS * (ROWS - 1) / SHOOTING_ROWS / arguments.shooting_segments
    jobs = [("IdentifyOneStep/with_covariance", "numpy lstsq, three equations with covariance", lambda: one_step(by_numpy), 9, 1.0),
            ("IdentifyOneStep/with_covariance", "statsmodels OLS, three equations with covariance",
             lambda: one_step(by_statsmodels), 9, 1.0),
            ("WeakIv/all", "numpy, all segments side by side", weak_form, 5, 1.0),
            ("OutputError/all", f"scipy least_squares, {arguments.shooting_segments} shooting segments scaled up *",
             shooting(arguments.shooting_segments), 1, scaled)]
    print(f"numpy {np.__version__}, scipy {scipy.__version__}, statsmodels {statsmodels.__version__}, "
          f"BLAS: {compare_bootstrap.blas_in_use()}\n")
    print("| job | telltale, ms | with | ms | ratio |")
    print("|---|---|---|---|---|")
    for name, reference, job, repetitions, scale in jobs:
        theirs = scale * milliseconds(job, repetitions)
        print(f"| `{name}` | {compare_bootstrap.short(own[name])} | {reference} | {compare_bootstrap.short(theirs)} | "
              f"{compare_bootstrap.short(theirs / own[name])} |", flush=True)
    print(f"\n\\* timed for {arguments.shooting_segments} of {round(arguments.shooting_segments * scaled)} shooting segments, forty sums at most; without the covariance by clusters")
    if not arguments.without_bootstrap:
        print()
        compare_bootstrap.compare(bench)


if __name__ == "__main__":
    main()
