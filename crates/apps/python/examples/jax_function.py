"""A measure as a function of JAX with its exact gradient, computed on the CPU by a callback."""

import jax
import jax.numpy as jnp
import numpy as np

import squama

jax.config.update("jax_enable_x64", True)


def jax_function(skin, keys, measure):
    """Returns the measure as a function of an array of values of ``keys``, for ``jax.grad`` and ``jax.jit``."""
    f, jac = squama.function(skin, keys, measure, at_kinks="mean")
    number, row = jax.ShapeDtypeStruct((), jnp.float64), jax.ShapeDtypeStruct((len(keys),), jnp.float64)

    @jax.custom_vjp
    def of(x):
        return jax.pure_callback(lambda x: np.float64(f(x)), number, x, vmap_method="sequential")

    def forward(x):
        return of(x), jax.pure_callback(lambda x: np.asarray(jac(x)), row, x, vmap_method="sequential")

    of.defvjp(forward, lambda slopes, cotangent: (cotangent * slopes,))
    return of


if __name__ == "__main__":
    skin = squama.Skin(gap_over_t=0.21, length_over_t=0.93, slant_deg=41)
    force = jax_function(skin, ["gap_over_t", "slant_deg"], "critical_force")
    x = jnp.array([0.21, 41.0])
    exact = skin.value_and_gradient("critical_force", ["gap_over_t", "slant_deg"])[1]
    slopes = jax.jit(jax.grad(lambda x: jnp.log(force(x))))(x)
    print(force(x), slopes)
    np.testing.assert_allclose(slopes, exact / force(x), rtol=1e-12)
