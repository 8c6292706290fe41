"""Tests of the package: recorded tables, finite differences, interrupts, pickling and threads."""

import copy
import csv
import doctest
import os
import pickle
import signal
import subprocess
import sys
import time
import warnings
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import check_grad, minimize

import squama
from squama import _manual

ROOT = Path(__file__).parents[4]
SMOKE = ROOT / "sweeps" / "smoke.toml"
GOAL = ROOT / "sweeps/goals/strong-and-covered.toml"
SKIN = squama.Skin(gap_over_t=0.1, length_over_t=0.3, slant_deg=60)


def same(one, other):
    """Asserts that two tables are equal to the last bit."""
    assert list(one) == list(other)
    for name in one:
        if one[name].dtype == float:
            np.testing.assert_array_equal(one[name], other[name], err_msg=name)
        else:
            assert list(one[name]) == list(other[name]), name


def designs(folder):
    with open(folder / "designs.csv", newline="") as file:
        return list(csv.DictReader(file))


def test_values_equal_the_output_of_the_command(tmp_path):
    if not os.environ.get("SQUAMA"):
        pytest.skip("SQUAMA names no command to compare with")
    guided = 'puncture.needle="guided"'
    for name, settings in (("plain", []), ("guided", ["--set", guided, "--set", "puncture.needle_friction=0.3"])):
        folder = tmp_path / name
        subprocess.run([os.environ["SQUAMA"], "run", SMOKE, "--quiet", "--out", folder, *settings])
        skins = squama.Skin.all_from_toml(folder / "run.toml")
        table, rows = squama.solve_many(skins), designs(folder)
        assert len(rows) == len(skins) > 5
        for k, row in enumerate(rows):
            for column, text in row.items():
                value = table[column][k]
                if text == "":
                    assert value is None or value != value, (column, value)
                else:
                    assert value == (text if isinstance(value, str) else float(text)), column


def test_the_paper_sweep_equals_the_recorded_tables():
    # The last bit may differ, because an earlier version recorded the tables.
    rows = designs(ROOT / "results/reference/paper")
    skins = squama.Skin.all_from_toml(ROOT / "sweeps/paper.toml")
    assert len(rows) == len(skins) == 720
    for k in (71, 100, 416, 719):
        result = skins[k].solve()
        for name in ("coverage", "critical_force", "penetration", "compliance", "puncture_status"):
            text, value = rows[k][name], result.values[name]
            assert value == text if isinstance(value, str) else value == pytest.approx(float(text), rel=1e-9)


def test_runs_tables_and_single_solutions_agree(tmp_path):
    run = squama.run(SMOKE, tmp_path / "smoke")
    skins = squama.Skin.all_from_toml(SMOKE)
    table = squama.solve_many(skins)
    same(run, table)
    same(squama.read(tmp_path / "smoke"), table)
    for k, skin in enumerate(skins):
        values = skin.solve().values
        for name, column in table.items():
            if name != "design":
                assert values[name] == column[k] if values[name] is not None else column[k] is None or np.isnan(column[k])
    best = run.rank(require="coverage >= 0.1")
    assert best["rank"][0] == 1 and (best["coverage"] >= 0.1).all()
    if os.environ.get("SQUAMA"):
        assert Path(run.report(tmp_path / "page.html")).read_text().startswith("<!")
        with pytest.raises(squama.Failed, match="nowhere"):
            run.report(tmp_path / "nowhere" / "page.html")
    assert run.units["critical_force"] == "E_s L t/(1-nu^2)" and run.units["slant_deg"] == "deg"


def test_results_do_not_depend_on_the_number_of_threads():
    skins = [SKIN.replace(slant_deg=slant, c2=c2) for slant in (0, 30, 60) for c2 in (0.23, 0.5)] * 5
    one = squama.solve_many(skins, threads=1)
    same(one, squama.solve_many(skins, threads=4))
    assert list(one["c2"][:2]) == [0.23, 0.5] and one.rows == 30
    with ThreadPoolExecutor(4) as pool:
        forces = [result["critical_force"] for result in pool.map(squama.Skin.solve, skins)]
    assert forces == list(one["critical_force"])


def test_skins_of_different_kinds_share_a_table():
    table = squama.solve_many([SKIN, SKIN.replace(thickness_mm=1, substrate_modulus_MPa=0.3)], "puncture")
    assert np.isnan(table["critical_force_N"][0]) and table["critical_force_N"][1] > 0
    assert list(squama.solve_many([])) == []


def test_skins_are_immutable_values():
    other = squama.Skin(**SKIN.parameters)
    assert other == SKIN and hash(other) == hash(SKIN) and other is not SKIN and len({other, SKIN}) == 1
    assert SKIN.replace(slant_deg=59) != SKIN and SKIN != "skin"
    assert repr(SKIN) == "Skin(gap_over_t=0.1, length_over_t=0.3, slant_deg=60)"
    assert SKIN.slant_deg == 60 and SKIN.base == "L" and SKIN.thickness_mm is None and SKIN.scales == "auto"
    with pytest.raises(AttributeError):
        SKIN.slant_deg = 1
    with pytest.raises(AttributeError):
        SKIN.colour
    assert eval("squama." + repr(SKIN.replace(base="2L"))) == SKIN.replace(base="2L")
    tilts = SKIN.replace(critical_tilt_deg=(10, np.float64(15)))
    assert tilts.critical_tilt_deg == (10, 15) and tilts.replace(critical_tilt_deg=None) == SKIN
    assert SKIN.replace(needle_friction=0.2).replace(needle_friction=0.3).needle_friction == 0.3
    for skin in (SKIN, tilts, SKIN.replace(base="2L", scales=np.int64(9), gap_cv=0.1, samples=3)):
        assert squama.Skin.from_toml(skin.to_toml()) == skin
        assert pickle.loads(pickle.dumps(skin)) == skin == copy.deepcopy(skin)
    assert SKIN._repr_svg_().startswith("<svg")


def test_lengths_in_mm_equal_lengths_over_the_thickness():
    skin = squama.Skin(gap_mm=0.25, length_mm=1.25, slant_deg=60, thickness_mm=2.5, substrate_modulus_MPa=0.31)
    assert (skin.gap_over_t, skin.length_over_t, skin.gap_mm) == (0.1, 0.5, 0.25)
    assert skin.replace(gap_mm=0.5).gap_over_t == 0.2
    value, gradient = skin.value_and_gradient("critical_force_N", ["gap_mm"])
    assert value == skin.solve()["critical_force_N"]
    _, over_t = skin.value_and_gradient("critical_force_N", ["gap_over_t"])
    # Derivatives of the force in N are differences along the linearised dimensionless force.
    assert gradient[0] == pytest.approx(over_t[0] / 2.5, rel=1e-9)


def test_a_design_of_a_definition_is_selected_by_number():
    assert squama.Skin.from_toml(SMOKE, design=2) == squama.Skin.all_from_toml(str(SMOKE))[1]
    for design in (None, 0, 10_000):
        with pytest.raises(squama.InvalidParameter, match="the number of one of its"):
            squama.Skin.from_toml(SMOKE, design)
    with pytest.raises(squama.InvalidDefinition, match="cannot be read"):
        squama.Skin.from_toml("nowhere.toml")


@pytest.mark.parametrize(
    ("given", "key", "value", "expected"),
    [
        ({"gap_over_t": -1}, "gap_over_t", -1, "a length"),
        ({"gap_over_t": float("nan")}, "gap_over_t", None, "a length"),
        ({"slant_deg": "steep"}, "slant_deg", "steep", "an angle"),
        ({"slant_deg": [10, 20]}, "slant_deg", None, "one value"),
        ({"base": "3L"}, "base", "3L", '"L" or "2L"'),
        ({"scales": 2.5}, "scales", 2.5, "a whole number"),
        ({"scales": True}, "scales", True, "a whole number"),
        ({"gap": 1}, "gap", None, "did you mean gap_over_t"),
        ({"gap_mm": 1}, "gap_mm", 1, "thickness_mm"),
        ({"gap_over_t": None}, "gap_over_t", None, "a length"),
    ],
)
def test_errors_state_valid_values(given, key, value, expected):
    with pytest.raises(squama.InvalidParameter) as caught:
        SKIN.replace(**given)
    error = caught.value
    assert error.key == key and expected in error.expected and key in str(error)
    assert value is None or error.value == value


def test_all_problems_are_reported_at_once():
    with pytest.raises(squama.InvalidParameter) as caught:
        SKIN.replace(c2=0, gap_over_t=-1)
    assert "c2" in str(caught.value) and "gap_over_t" in str(caught.value)
    assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)


def test_errors_name_keywords_and_missing_values(tmp_path):
    with pytest.raises(squama.InvalidParameter, match="^slant_deg: is missing, expected an angle"):
        squama.Skin(gap_over_t=0.1, length_over_t=1)
    with pytest.raises(squama.InvalidParameter, match="^gap: 'gap' is not accepted, expected the name of a parameter; did you"):
        SKIN.replace(gap=0.1)
    (tmp_path / "x.toml").write_text("name = 'x'\nmeasures = 'coverage'\n[designs]\nslant_deg = [0, 45]\n")
    squama.run(tmp_path / "x.toml", tmp_path / "x")
    with pytest.raises(squama.Failed, match="use resume=True to continue from them, or fresh=True to discard them"):
        squama.run(tmp_path / "x.toml", tmp_path / "x")
    with pytest.raises(KeyError, match="this skin has no measure critical_force_N: it needs thickness_mm and substrate_modulus_MPa"):
        SKIN.solve()["critical_force_N"]
    assert set(SKIN.solve().keys()) == set(SKIN.solve().values)
    assert (squama.solve_many(SKIN, "coverage")["coverage"] == [SKIN.solve("coverage")["coverage"]]).all()


def test_errors_and_results_can_be_pickled():
    kink = squama.KinkWarning("compliance", "gap_over_t", 1.0, 2.0, "touch")
    errors = [squama.InvalidParameter("c2", 0, "a number"), squama.Failed("puncture", "limit point"), kink]
    for error in [*errors, squama.InvalidDefinition("no")]:
        again = pickle.loads(pickle.dumps(error))
        assert type(again) is type(error) and str(again) == str(error) and again.args == error.args
    result, again = SKIN.solve(), pickle.loads(pickle.dumps(SKIN.solve()))
    assert again.values == result.values and again["coverage"] == result["coverage"] and again.skin == SKIN
    for name in ("path", "events", "scales", "flexure_path", "flexure_events", "flexure_scales"):
        same(getattr(again, name), getattr(result, name))
        assert getattr(result, name).rows > 0 or "events" in name
    same(pickle.loads(pickle.dumps(squama.solve_many([SKIN]))), squama.solve_many([SKIN]))


def test_unloading_paths_and_load_positions_are_tables():
    result = SKIN.replace(friction=0.1, unload="true", unbend="true", places=3).solve()
    for back, path, load, left in (
        ("way_back", "path", "force", result["remaining_displacement"]),
        ("flexure_way_back", "flexure_path", "moment", result["remaining_curvature"]),
    ):
        back, path = getattr(result, back), getattr(result, path)
        assert set(back) <= set(path) and abs(back[load][-1]) < 1e-9 * path[load][-1]
        assert back[load][0] == pytest.approx(path[load][-1], rel=1e-12)
        assert back[next(name for name in back if name in ("displacement", "curvature"))][-1] == pytest.approx(left)
    assert min(result.places["critical_force"]) == result["weakest_force"] and result.steps.rows > 0
    assert SKIN.solve().way_back.rows == 0


def test_answers_have_the_warnings_of_the_command(tmp_path):
    skin = squama.Skin(
        **dict(gap_over_t=0.1, length_over_t=0.2, slant_deg=60),
        **dict(thickness_mm=2, substrate_modulus_MPa=1, membrane_modulus_MPa=4.5),
    )
    result = skin.solve()
    answer = result.answer(["coverage >= 0.5", "critical_force_N >= 100"])
    first, second = answer["requirements"]
    assert first == dict(requirement="coverage >= 0.5", value=result["coverage"], limit=0.5, margin=first["margin"])
    assert first["margin"] > 0 > second["margin"] and second["value"] == result["critical_force_N"]
    words = " ".join(answer["warnings"])
    for topic in ("Sensitive to the gap", "less than a nozzle", "overhang", "on a finger"):
        assert topic in words, (topic, words)
    # Only ``answer`` solves other gaps, so only its warnings include the sensitivity to the gap.
    assert set(result.warnings) < set(answer["warnings"])
    assert pickle.loads(pickle.dumps(result)).answer("coverage >= 0.5")["requirements"] == [first]
    if not os.environ.get("SQUAMA"):
        pytest.skip("SQUAMA names no command to compare with")
    (tmp_path / "skin.toml").write_text(skin.to_toml())
    command = [os.environ["SQUAMA"], "design", tmp_path / "skin.toml", "--out", tmp_path / "out"]
    printed = subprocess.run(command, capture_output=True, text=True).stdout
    for warning in result.warnings:
        assert warning in printed, (warning, printed)


def stopped():
    """Returns a skin with a path that stops early."""
    return SKIN.replace(max_points=2)


def test_failures_raise_when_a_value_is_used():
    result = stopped().solve()
    assert result.status == "too many points" and "puncture" in result.warnings[0]
    assert result["coverage"] == SKIN.solve()["coverage"] and np.isnan(result.get("critical_force"))
    for failing in (result, pickle.loads(pickle.dumps(result))):
        with pytest.raises(squama.Failed, match="critical_force: too many points"):
            failing["critical_force"]
    with pytest.raises(squama.Failed) as caught:
        stopped().value_and_gradient("critical_force", ["gap_over_t"])
    assert caught.value.reason == "too many points"
    table = squama.solve_many([SKIN, stopped()])
    assert np.isnan(table["critical_force"][1]) and table["puncture_status"][1] == "too many points"
    with pytest.raises(KeyError, match="did you mean critical_force"):
        SKIN.solve()["critical_forc"]
    with pytest.raises(KeyError, match="did you mean coverage"):
        table["coverag"]
    with pytest.raises(KeyError, match="did you mean gap_over_t, times thickness_mm"):
        table["gap_mm"]


def test_a_single_column_can_be_solved():
    only = SKIN.solve("penetration")
    assert only["penetration"] == SKIN.solve()["penetration"] and np.isnan(only["compliance"])


def test_errors_are_passed_between_processes():
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        results = list(pool.map(squama.Skin.solve, [SKIN, SKIN.replace(slant_deg=30)]))
        assert results[0].values == SKIN.solve().values
        with pytest.raises(squama.InvalidParameter, match="measures"):
            pool.submit(SKIN.solve, "weight").result()


@pytest.mark.parametrize("measure", ["coverage", "critical_force", "penetration", "compliance", "areal_mass_kg_m2"])
def test_gradients_agree_with_finite_differences(measure):
    keys, x = ["gap_over_t", "length_over_t", "slant_deg"], np.array([0.21, 0.93, 41.0])
    skin = squama.Skin(gap_over_t=1, length_over_t=1, slant_deg=1, thickness_mm=2, scale_density_kg_m3=1200)
    f, jac = squama.function(skin, keys, measure)
    assert check_grad(f, jac, x, epsilon=1e-7) < 2e-4 * np.linalg.norm(jac(x))
    value, gradient = skin.replace(**dict(zip(keys, x))).value_and_gradient(measure, keys)
    assert value == f(x) and (gradient == jac(x)).all()


def test_the_jacobian_of_several_measures_has_a_row_for_each():
    f, jac = squama.function(SKIN, ["gap_over_t", "slant_deg"], ["critical_force", "coverage"])
    x = np.array([0.15, 50.0])
    assert f(x).shape == (2,) and jac(x).shape == (2, 2)
    one, by_one = squama.function(SKIN, ["gap_over_t", "slant_deg"], "coverage")
    assert one(x) == f(x)[1] and (by_one(x) == jac(x)[1]).all()
    with pytest.raises(squama.InvalidParameter):
        f([0.1, 95.0])
    for keys, measure in ((["gap"], "coverage"), (["base"], "coverage"), (["gap_over_t"], "contacts")):
        with pytest.raises(squama.InvalidParameter):
            SKIN.value_and_gradient(measure, keys)
    with pytest.raises(KeyError):
        SKIN.value_and_gradient("weight", ["gap_over_t"])


def test_slsqp_finds_the_optimum_with_exact_gradients():
    keys = ["gap_over_t", "slant_deg"]
    f, jac = squama.function(SKIN, keys, "compliance", at_kinks="mean")
    cover, by = squama.function(SKIN, keys, "coverage", at_kinks="mean")
    at_least = {"type": "ineq", "fun": lambda x: cover(x) - 0.6, "jac": by}
    bounds = [(0.05, 1.0), (10.0, 70.0)]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", squama.KinkWarning)
        found = minimize(lambda x: -f(x), [0.1, 60.0], jac=lambda x: -jac(x), method="SLSQP", bounds=bounds, constraints=at_least)
    assert found.success and -found.fun >= f([0.1, 60.0]) and cover(found.x) >= 0.6 - 1e-9


def test_kinks_report_both_sides_and_can_be_errors():
    # For smaller gaps the coverage line crosses one more scale.
    skin = squama.Skin(gap_over_t=0.1, length_over_t=0.025, slant_deg=45)
    with pytest.warns(squama.KinkWarning) as caught:
        _, gradient = skin.value_and_gradient("coverage", ["gap_over_t"])
    kink = caught[0].message
    assert (kink.measure, kink.key, kink.change) == ("coverage", "gap_over_t", "another scale under the line")
    assert (kink.left, kink.right) == pytest.approx((0, -8)) and np.isnan(gradient[0])
    assert caught[0].filename == __file__ and len(caught) == 1
    for at_kinks, slope in {"left": kink.left, "right": kink.right, "mean": (kink.left + kink.right) / 2}.items():
        with pytest.warns(squama.KinkWarning):
            assert skin.value_and_gradient("coverage", ["gap_over_t"], at_kinks)[1] == [slope]
        with pytest.warns(squama.KinkWarning):
            assert squama.function(skin, ["gap_over_t"], "coverage", at_kinks)[1]([0.1]) == [slope]
    with pytest.raises(squama.InvalidParameter, match="at_kinks"):
        skin.value_and_gradient("coverage", ["gap_over_t"], "both")
    f, jac = squama.function(skin, ["gap_over_t"], "coverage")
    with warnings.catch_warnings():
        warnings.simplefilter("error", squama.KinkWarning)
        with pytest.raises(squama.KinkWarning):
            skin.value_and_gradient("coverage", ["gap_over_t"])
        with pytest.raises(squama.KinkWarning):
            jac([0.1])
        assert f([0.11]) < 1


LONG = {
    "solve": "skin.replace(gap_cv=0.1, samples=1_000_000).solve()",
    "solve_many": "squama.solve_many(skins)",
    "run": "squama.run(skin.replace(gap_cv=0.1, samples=1_000_000), sys.argv[1])",
    "optimise": "squama.optimise(sys.argv[2], sys.argv[1], set={'goal.samples': 100_000})",
    "tolerance": "squama.tolerance(skin, set={'tolerance.gap_over_t': {'batch_sd': 0.01}}, samples=1_000_000, out=sys.argv[1])",
}


@pytest.mark.skipif(os.name == "nt", reason="needs signals")
@pytest.mark.parametrize("call", LONG)
def test_a_signal_ends_a_call_within_a_second(call, tmp_path):
    # The signal is handled like Ctrl-C. It is sent after half a second of processor time, summed
    # over all cores, because processor time does not depend on other programs.
    code = f"""
import signal, sys, time, squama
signal.signal(signal.SIGPROF, signal.default_int_handler)
skin = squama.Skin(gap_over_t=0.1, length_over_t=0.3, slant_deg=60)
skins = [skin.replace(slant_deg=k / 10) for k in range(600)] * 100
begun = time.process_time()
signal.setitimer(signal.ITIMER_PROF, 0.5)
try:
    {LONG[call]}
except KeyboardInterrupt:
    print("interrupted after", time.process_time() - begun - 0.5)
"""
    command = [sys.executable, "-c", code, tmp_path / "out", GOAL]
    called = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert called.stdout.startswith("interrupted after "), called
    assert float(called.stdout.split()[-1]) < 1.0 * os.cpu_count()


def test_interrupted_runs_can_be_resumed(tmp_path):
    seen = []

    def stop(share, words):
        seen.append((share, words))
        if 0 < share < 1:
            raise KeyboardInterrupt

    definition = "name = 'x'\n[designs]\ngap_over_t = { from = 0.1, to = 1, step = 0.1 }\nlength_over_t = 1"
    definition += "\nslant_deg = { from = 0, to = 80, step = 0.5 }\n"
    with pytest.raises(KeyboardInterrupt):
        squama.run(definition, tmp_path / "x", progress=stop)
    with pytest.raises(squama.Failed):
        squama.run(definition, tmp_path / "x")
    deadline = time.monotonic() + 20
    while True:
        try:
            run = squama.run(definition, tmp_path / "x", resume=True, set={"measures": ["coverage", "puncture", "flexure"]})
            break
        except squama.Failed:
            # The abandoned thread completes the designs in progress.
            assert time.monotonic() < deadline
            time.sleep(0.1)
    assert run.rows == 1610 and "designs" in seen[0][1]


def ended_early(begin, ending):
    """Starts a command, interrupts it when the file ``ending`` exists, and returns True if the command failed."""
    # Restore the handler: a shell that runs the tests in the background ignores the signal.
    heed = lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)  # noqa: E731
    process = subprocess.Popen(begin, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, preexec_fn=heed)
    while process.poll() is None and not ending.exists():
        time.sleep(0.01)
    time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    return process.wait() != 0


@pytest.mark.skipif(not os.environ.get("SQUAMA") or os.name == "nt", reason="SQUAMA names no command to resume with")
def test_command_and_package_resume_each_others_runs(tmp_path):
    command, part, other = os.environ["SQUAMA"], tmp_path / "part", tmp_path / "other"
    definition = tmp_path / "long.toml"
    definition.write_text(SMOKE.read_text().replace("smoke", "long") + "\n")
    whole = {"designs.gap_over_t": {"from": 0.1, "to": 1, "step": 0.01}, "designs.slant_deg": {"from": 0, "to": 75, "step": 5}}
    settings = [f"--set={key}={{ from = {of['from']}, to = {of['to']}, step = {of['step']} }}" for key, of in whole.items()]
    assert ended_early([command, "run", definition, "--quiet", "--out", part, *settings], part / "journal.jsonl")
    run = squama.run(definition, part, set=whole, resume=True)
    assert run.rows > 1000

    def stop(share, words):
        if 0 < share < 1:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        squama.run(definition, other, set=whole, progress=stop)
    deadline = time.monotonic() + 20
    # The abandoned thread completes the designs in progress, and locks the folder until then.
    while subprocess.run([command, "run", definition, "--quiet", "--resume", "--out", other, *settings]).returncode == 2:
        assert time.monotonic() < deadline
        time.sleep(0.1)
    assert (part / "designs.csv").read_bytes() == (other / "designs.csv").read_bytes()


def test_a_progress_bar_is_shown(capsys):
    squama.solve_many([SKIN.replace(slant_deg=k / 10) for k in range(600)], progress=True)
    shown = capsys.readouterr().err
    assert "/600 designs" in shown and shown.endswith("\r")


def test_searches_and_tolerances_return_their_tables(tmp_path):
    goal = tmp_path / "goal.toml"
    goal.write_text(
        "name = 'covered'\nmeasures = 'coverage'\n[variables]\ngap_over_t = { from = 0.1, to = 1 }\n"
        "[designs]\nlength_over_t = 1\nslant_deg = 45\n[goal]\nmaximize = 'coverage'\nsamples = 8\n"
    )
    found = squama.optimise(goal, tmp_path / "found")
    assert found.skin.gap_over_t == pytest.approx(0.1, abs=1e-9) and found["coverage"][0] == pytest.approx(0.9)
    with pytest.raises(squama.Failed, match="no design meets"):
        squama.optimise(goal, tmp_path / "none", set={"goal.require": ["coverage >= 0.905"]})
    spread = {"tolerance.gap_over_t": {"batch_sd": 0.01}, "measures": "coverage"}
    skin = squama.Skin(gap_over_t=0.5, length_over_t=1, slant_deg=45)
    tables = squama.tolerance(skin, set=spread, require="coverage >= 0.5", samples=200)
    assert tables["tolerance"]["linear_spread"][0] == pytest.approx(0.01, rel=1e-5)
    assert tables["sources"]["source"][0] == "gap_over_t" and tables["yield"].rows > 0
    with pytest.raises(squama.InvalidParameter, match="tolerance"):
        squama.tolerance(skin)


def test_a_search_warns_of_a_failed_check(tmp_path):
    goal = tmp_path / "pinned.toml"
    goal.write_text(
        "name = 'pinned'\nmeasures = 'puncture'\nvariables.length_over_t = { from = 1, to = 2 }\n"
        "designs = { gap_over_t = 0.6, slant_deg = 60 }\n[puncture]\nneedle = 'guided'\nneedle_friction = 0.3\n"
        "load_inset_over_t = 0.4\nscale_strength_over_substrate = 30\n[goal]\nminimize = 'length_over_t'\n"
        "require = 'failure_force >= 0.1'\nsamples = 2\n"
    )
    with pytest.warns(squama.CheckWarning, match="At the right corner of the scale") as caught:
        found = squama.optimise(goal, tmp_path / "found")
    assert found.failed_checks == [str(caught[0].message)]


def test_materials_and_bodies_may_be_named():
    shape = dict(gap_over_t=0.1, length_over_t=0.3, slant_deg=60, thickness_mm=2, membrane_modulus_MPa=1)
    skin = squama.Skin(**shape, scale="PLA", tissue="silicone", body="finger")
    assert (skin.scale_modulus_MPa, skin.scale_strength_MPa, skin.bond_strength_MPa) == (3000, 50, 0.1)
    definition = """name = "named"
designs = { gap_over_t = 0.1, length_over_t = 0.3, slant_deg = 60 }
material = { thickness_mm = 2, membrane_modulus_MPa = 1, scale = "PLA", tissue = "silicone" }
body = "finger"
"""
    assert skin == squama.Skin.from_toml(definition) == pickle.loads(pickle.dumps(skin))
    # Explicit values take precedence, and another name replaces the values of the first.
    assert squama.Skin(**shape, scale="pla", tissue="silicone", scale_strength_MPa=40).scale_strength_MPa == 40
    assert skin.replace(scale="PETG").scale_modulus_MPa == 2000
    for keyword in ("scale", "tissue", "body"):
        with pytest.raises(squama.InvalidParameter, match="PLA|silicone|finger") as refused:
            squama.Skin(**shape, **{keyword: "unobtainium"})
        assert (refused.value.key, refused.value.value) == (keyword, "unobtainium")


def test_unloading_paths_are_followed():
    skin = squama.Skin(gap_over_t=0.1, length_over_t=1, slant_deg=45, friction=0.2)
    assert skin.unload is False
    loop = skin.replace(unload=True, unbend=True)
    assert (loop.unload, loop.unbend) == (True, True)
    assert loop.solve("puncture")["loop_work"] > 1e-3


def test_help_and_stub_are_up_to_date():
    manual = squama.Skin.__doc__
    for key, _, _, meaning, expected, _ in squama._squama.parameters():
        assert key in manual and meaning in manual and expected in manual
        assert hasattr(SKIN, key)
    assert "critical_force (E_s L t/(1-nu^2))" in manual
    stub = Path(__file__).parents[1] / "python/squama/__init__.pyi"
    assert _manual.stub(stub.read_text()) == stub.read_text(), "python -m squama._manual crates/apps/python/python/squama/__init__.pyi"
    for name in squama.__all__:
        assert name in stub.read_text() and getattr(squama, name).__doc__
    assert "gap_over_t" in str(_manual.signature())


def test_the_example_of_the_package_runs():
    assert doctest.testmod(squama) == (0, 4)


def test_notebooks_show_results_and_tables_as_html():
    assert "critical_force" in SKIN.solve()._repr_html_() and repr(SKIN.solve()).count("\n") == 0
    table = squama.solve_many([SKIN] * 12)
    assert "12 rows" in table._repr_html_() and "12 rows" in repr(table) and table.row(3)["slant_deg"] == 60


def test_tables_convert_to_data_frames_and_results_are_plotted():
    frame = pytest.importorskip("pandas") and squama.solve_many([SKIN] * 2).to_pandas()
    assert frame["coverage"].tolist() == [SKIN.solve()["coverage"]] * 2
    pytest.importorskip("matplotlib").use("Agg")
    assert len(SKIN.solve().plot()) == 2


def test_tables_convert_to_arrow():
    arrow = pytest.importorskip("pyarrow")
    table = squama.solve_many([SKIN, stopped()])
    read = arrow.table(table)
    assert read.column_names == list(table) and read.column("coverage").to_pylist() == table["coverage"].tolist()
    assert read.column("critical_force").to_pylist() == [table["critical_force"][0], None]
    assert read.column("puncture_status").to_pylist() == ["complete", "too many points"]
    assert arrow.table(squama.solve_many([])).num_columns == 0
    # A stream that is not consumed releases its memory.
    table.__arrow_c_stream__()
    frame = pytest.importorskip("polars").from_arrow(table).struct.unnest()
    assert frame["critical_force"].to_list() == read.column("critical_force").to_pylist()


@pytest.mark.parametrize("file", sorted((Path(__file__).parents[1] / "examples").glob("*.py")), ids=lambda file: file.stem)
def test_the_examples_run(file, tmp_path):
    module = {"scipy_slsqp": "scipy", "openmdao_component": "openmdao", "pymoo_front": "pymoo", "jax_function": "jax"}
    pytest.importorskip(module[file.stem])
    # Some examples write reports to the working directory.
    subprocess.run([sys.executable, file], check=True, capture_output=True, cwd=tmp_path)


def test_the_notebook_runs():
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    pytest.importorskip("matplotlib")
    file = Path(__file__).parents[1] / "examples" / "paper.ipynb"
    notebook = nbformat.read(file, as_version=4)
    nbclient.NotebookClient(notebook, timeout=120, resources={"metadata": {"path": file.parent}}).execute()


def test_values_that_contain_themselves_or_are_nested_deeply_are_refused(tmp_path):
    own, deep, table = [], [], {}
    own.append(own)
    table["a"] = table
    for _ in range(100_000):
        deep = [deep]
    for value in (own, deep, table):
        with pytest.raises(squama.InvalidParameter, match="gap_over_t: .* is not accepted"):
            squama.Skin(gap_over_t=value, length_over_t=0.3, slant_deg=60)
        with pytest.raises(squama.InvalidParameter, match="is not accepted"):
            squama.run(SKIN, out=tmp_path / "out", set={"tolerance.gap_over_t": value})


@pytest.mark.parametrize("value", [b"\x01", {0.1, 0.2}, range(3), (gap for gap in [0.1]), object()], ids=lambda value: type(value).__name__)
def test_only_lists_tuples_and_arrays_are_lists(value):
    with pytest.raises(squama.InvalidParameter, match="gap_over_t: .* is not accepted"):
        squama.Skin(gap_over_t=value, length_over_t=0.3, slant_deg=60)


def test_lists_of_too_many_skins_are_rejected():
    definition = """name = "b"
    [designs]
    gap_over_t = { from = 0.001, to = 1, step = 0.001 }
    length_over_t = { from = 0.001, to = 1, step = 0.001 }
    slant_deg = { from = 0, to = 79.92, step = 0.08 }"""
    with pytest.raises(squama.InvalidDefinition, match="has 1000000000 designs, expected at most 1000000"):
        squama.Skin.all_from_toml(definition)
    assert squama.Skin.from_toml(definition, 10**9).slant_deg == pytest.approx(79.92)


@pytest.mark.parametrize("threads", [0, -1, 1025, 10**9, 10**30, 1.5, "2", True])
def test_numbers_of_threads_out_of_range_are_refused(threads, tmp_path):
    for call in (
        lambda: squama.solve_many([SKIN], threads=threads),
        lambda: squama.run(SMOKE, out=tmp_path / "out", threads=threads),
        lambda: squama.tolerance(SKIN, set={"tolerance.gap_over_t": {"batch_sd": 0.02}}, samples=0, threads=threads),
    ):
        with pytest.raises(squama.InvalidParameter, match="threads: .* is not accepted, expected a whole number from 1 to 1024"):
            call()
    assert not (tmp_path / "out").exists()


def test_functions_reject_points_of_another_length():
    f, jac = squama.function(SKIN, ["gap_over_t", "slant_deg"], "coverage")
    texts = ("ab", [0.2, b"6"], [0.2, "6"], [0.2, [60]], [None, 1], {0.2: 60, 3: 4}, {0.2, 60.0}, (v for v in (0.2, 60)))
    for point in ([], [0.2], [0.2, 60, 99], [[0.2, 60]], *texts):
        for call in (f, jac):
            with pytest.raises(squama.InvalidParameter, match="x: .* expected 2 numbers: gap_over_t, slant_deg"):
                call(point)


def test_other_threads_run_while_definitions_and_results_are_read(tmp_path):
    definition = """name = "big"
    measures = ["coverage"]
    [designs]
    gap_over_t = { from = 0.01, to = 1, step = 0.01 }
    length_over_t = { from = 0.01, to = 1, step = 0.01 }
    slant_deg = { from = 1, to = 4, step = 1 }"""
    squama.run(definition, out=tmp_path / "big")
    ticks, stop = [], False

    def tick():
        while not stop:
            time.sleep(0.001)
            ticks.append(None)

    with ThreadPoolExecutor(1) as executor:
        ticking = executor.submit(tick)
        try:
            # Other threads run during a call of the extension only if the call releases the lock.
            for call, argument in ((squama._squama.read, tmp_path / "big"), (lambda text: squama.Skin._designs(text, None), definition)):
                before = len(ticks)
                call(argument)
                assert len(ticks) > before + 1
        finally:
            stop = True
        ticking.result()


def test_gradients_of_folded_designs_warn_once():
    folded = squama.Skin(gap_over_t=0.1, length_over_t=0.1, slant_deg=75)
    fold = folded.solve()["fold_force"]
    assert fold < folded.solve()["critical_force"]
    with pytest.warns(squama.FoldWarning, match="use sound_force") as caught:
        folded.value_and_gradient("critical_force", ["length_over_t"])
    assert caught[0].message.fold_force == fold
    f, jac = squama.function(folded, ["length_over_t"], "critical_force")
    with pytest.warns(squama.FoldWarning) as caught:
        f([0.1]), jac([0.1]), f([0.11])
    assert len([w for w in caught if w.category is squama.FoldWarning]) == 1
    assert pickle.loads(pickle.dumps(caught[0].message)).fold_force > 0
    with warnings.catch_warnings():
        warnings.simplefilter("error", squama.FoldWarning)
        folded.value_and_gradient("sound_force", ["length_over_t"], "mean")
        folded.value_and_gradient("coverage", ["length_over_t"], "mean")


def test_missing_materials_are_reported_by_their_keys():
    with_thickness = squama.Skin(gap_over_t=0.1, length_over_t=0.3, slant_deg=60, thickness_mm=2)
    with pytest.raises(KeyError, match="needs substrate_modulus_MPa'"):
        with_thickness.solve()["critical_force_N"]
    with pytest.raises(KeyError, match="needs thickness_mm and substrate_modulus_MPa"):
        SKIN.solve()["critical_force_N"]
