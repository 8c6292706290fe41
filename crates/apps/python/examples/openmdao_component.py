"""A skin as a component of OpenMDAO, with exact partial derivatives."""

import openmdao.api as om

import squama


class SkinComponent(om.ExplicitComponent):
    """A component with parameters of a skin as inputs and its measures as outputs."""

    def initialize(self):
        self.options.declare("skin", types=squama.Skin)
        self.options.declare("keys", types=list)
        self.options.declare("measures", types=list)

    def setup(self):
        skin, keys, measures = (self.options[name] for name in ("skin", "keys", "measures"))
        self.f, self.jac = squama.function(skin, keys, measures, at_kinks="mean")
        for key in keys:
            self.add_input(key, val=getattr(skin, key))
        for measure in measures:
            self.add_output(measure)
        self.declare_partials("*", "*")

    def point(self, inputs):
        return [inputs[key][0] for key in self.options["keys"]]

    def compute(self, inputs, outputs):
        for measure, value in zip(self.options["measures"], self.f(self.point(inputs))):
            outputs[measure] = value

    def compute_partials(self, inputs, partials):
        for measure, row in zip(self.options["measures"], self.jac(self.point(inputs))):
            for key, slope in zip(self.options["keys"], row):
                partials[measure, key] = slope


if __name__ == "__main__":
    skin = squama.Skin(gap_over_t=0.21, length_over_t=0.93, slant_deg=41)
    problem = om.Problem()
    part = SkinComponent(skin=skin, keys=["gap_over_t", "slant_deg"], measures=["critical_force", "coverage"])
    problem.model.add_subsystem("skin", part, promotes=["*"])
    problem.setup()
    problem.run_model()
    worst = max(
        abs(check["J_fwd"] - check["J_fd"]).max() / abs(check["J_fd"]).max()
        for check in problem.check_partials(out_stream=None, step=1e-6)["skin"].values()
    )
    print(f"partials agree with finite differences to {worst:.1e}")
    assert worst < 1e-3
