"""The most compliant skin that covers at least 0.6: SciPy's SLSQP with exact gradients."""

import warnings

from scipy.optimize import minimize

import squama

warnings.simplefilter("ignore", squama.KinkWarning)  # SLSQP cannot handle kinks, even with mean slopes; squama.optimise can.

keys = ["gap_over_t", "slant_deg"]
skin = squama.Skin(gap_over_t=0.1, length_over_t=0.3, slant_deg=60)
compliance, slope = squama.function(skin, keys, "compliance", at_kinks="mean")
coverage, by = squama.function(skin, keys, "coverage", at_kinks="mean")

found = minimize(
    lambda x: -compliance(x),
    x0=[skin.gap_over_t, skin.slant_deg],
    jac=lambda x: -slope(x),
    bounds=[(0.05, 1.0), (10.0, 70.0)],
    constraints={"type": "ineq", "fun": lambda x: coverage(x) - 0.6, "jac": by},
    method="SLSQP",
)
best = skin.replace(**dict(zip(keys, found.x.tolist())))
print(found.message)
print(best.solve())
