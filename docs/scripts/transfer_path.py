"""Numbers of docs/design/transfer_path.md: levels and noise of healthy channels, and how sensors of one gearbox differ."""

import numpy as np
from siggen.loading import load_config
from siggen.simulation import simulate
from siggen.measured_response import INPUTS
from siggen.sensing.modal_path import modal_accelerance
from siggen.specimen_housing import specimen_housing

c = load_config("configs/transfer_path.yaml", ["specimens=6"])
rows = []
for sp in range(5):
    r = simulate(c, [sp * 12 + 1])[0]
    for k, x in r.channels.items():
        x = x.astype(float)
        n = x.size
        w = np.hanning(n)
        X = np.abs(np.fft.rfft(x * w)) * 2 / (n * 0.5)
        f1 = r.labels["pinion_shaft_hz"]
        fm = r.labels["mesh_hz"]
        lev = lambda f: X[int(f) - 2 : int(f) + 4].max()
        m = lev(fm)
        P = np.abs(np.fft.rfft(x * w)) ** 2 * 2 / (51200 * (w**2).sum())

        def nd(h):
            lo, hi = int(h * fm - 8 * f1), int(h * fm + 8 * f1)
            idx = np.arange(lo, hi)
            keep = np.array([abs((i - h * fm) / f1 - round((i - h * fm) / f1)) > 0.2 for i in idx])
            return 10 * np.log10(P[idx[keep]].mean() / (lev(h * fm) ** 2 / 2))

        rows.append(
            [20 * np.log10(lev(h * fm) / m) for h in (2, 3, 4, 5)]
            + [
                nd(1),
                nd(2),
                20 * np.log10(np.median(X) / max(lev(h * fm) for h in range(1, 11))),
                np.mean((x - x.mean()) ** 4) / x.var() ** 2,
                np.abs(x).max() / x.std(),
                x.std(),
                r.labels["force_noise_n_per_sqrt_hz"],
            ]
        )
rows = np.array(rows)
np.set_printoptions(precision=2, suppress=True, linewidth=160)
print("h2 h3 h4 h5 nd1 nd2 medianbin kurt crest rms fnoise")
print(np.percentile(rows, [5, 50, 95], axis=0))

force = np.random.default_rng(1).standard_normal(4)  # one fixed pattern over the four bearing forces
for mesh in (270.0, 540.0):
    lines, spread = np.array([mesh - 30, mesh, mesh + 30, *(mesh * np.arange(2, 6))]), []
    for specimen in range(150):
        housing = specimen_housing(c, specimen)
        bearings, shapes = housing.at_bearings(INPUTS), [housing.shape_at(f"sensor {i}") for i in range(12)]
        level = np.array([np.abs(force @ modal_accelerance(housing.modes, bearings, s, lines)) for s in shapes])
        ratios = [0.5 * (level[:, 0] + level[:, 2]) / level[:, 1], *(level[:, 3:] / level[:, 1:2]).T]
        spread.append([np.std(20 * np.log10(r), ddof=1) for r in ratios])
    print(mesh, "Hz: standard deviation over sensors of SB1, h2-h5, median over gearboxes", np.median(spread, axis=0))
