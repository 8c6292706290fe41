"""A Pareto front of coverage and compliance by NSGA-II of pymoo; a generation is solved on all cores."""

import numpy as np
from pymoo.algorithms.moo.nsga2 import NSGA2
from pymoo.core.problem import Problem
from pymoo.optimize import minimize

import squama


class SkinProblem(Problem):
    """The problem to maximize two measures over three parameters."""

    keys, measures = ("gap_over_t", "length_over_t", "slant_deg"), ("coverage", "compliance")

    def __init__(self):
        super().__init__(n_var=3, n_obj=2, xl=[0.05, 0.1, 0.0], xu=[1.0, 2.0, 75.0])

    def _evaluate(self, points, out, *args, **kwargs):
        skins = [squama.Skin(**dict(zip(self.keys, point))) for point in points.tolist()]
        table = squama.solve_many(skins, ["coverage", "flexure"])
        # A skin that could not be solved gets an objective that is worse than any other.
        out["F"] = np.column_stack([np.nan_to_num(-table[measure], nan=1e3) for measure in self.measures])


if __name__ == "__main__":
    found = minimize(SkinProblem(), NSGA2(pop_size=40), ("n_gen", 10), seed=1)
    print(f"{len(found.F)} skins on the front, coverage up to {-found.F[:, 0].min():.3f}")
    assert len(found.F) > 5
